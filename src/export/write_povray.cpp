#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "export/format.hpp"
#include "export/text_file.hpp"
#include "io/legend.hpp"
#include "io/palette.hpp"

namespace bernal {
namespace {

/// POV-Ray's frame is left-handed and its y points up: y and z change places.
std::string vector_of(const Vector<3>& v) { return fmt::format("<{}, {}, {}>", v[0], v[2], v[1]); }

constexpr std::string_view glass = "pigment { srgbt <0.62, 0.70, 0.80, 0.82> } no_shadow";

/// The lines that show the domain, for the spheres in it to be seen.
struct OutlineLines {
  std::string edge(const Vector<3>& from, const Vector<3>& to) const {
    return fmt::format("cylinder {{ {}, {}, Thickness }}\n", vector_of(from), vector_of(to));
  }
  std::string operator()(const Box& box) const {
    const Vector<3> corner = box.corner, size = box.size;
    std::string lines = "union {\n";
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 4; ++side) {
        Vector<3> from = corner;
        if (side & 1) from[(axis + 1) % 3] += size[(axis + 1) % 3];
        if (side & 2) from[(axis + 2) % 3] += size[(axis + 2) % 3];
        Vector<3> to = from;
        to[axis] += size[axis];
        lines += edge(from, to);
      }
    return lines + "pigment { srgb <0.35, 0.40, 0.48> }\n}\n";
  }
  std::string operator()(const Cylinder& cylinder) const {
    const Vector<3> top = cylinder.base + cylinder.height * cylinder.axis.normalized();
    return fmt::format("cylinder {{ {}, {}, {} open {} }}\n", vector_of(cylinder.base), vector_of(top),
                       cylinder.radius, glass);
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("sphere {{ {}, {} {} }}\n", vector_of(sphere.center), sphere.radius, glass);
  }
  std::string operator()(const Mesh& mesh) const {
    std::string lines = fmt::format("mesh2 {{\nvertex_vectors {{ {}", mesh.vertices.size());
    for (const Vector<3>& vertex : mesh.vertices) lines += ",\n" + vector_of(vertex);
    lines += fmt::format(" }}\nface_indices {{ {}", mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) lines += fmt::format(",\n<{}, {}, {}>", a, b, c);
    return lines + fmt::format(" }}\n{}\n}}\n", glass);
  }
  std::string operator()(const Polygon&) const { return {}; }
};

/// A camera far enough away to see all of the domain, and of spheres that stick out of it, in pictures that
/// are at least as wide as high.
std::string camera_of(const Exported& file) {
  constexpr double half_angle = 13 * std::numbers::pi / 180;
  const Bounds<3> bounds = bounds_of(file.domain);
  const Vector<3> middle = 0.5 * (bounds.lower + bounds.upper);
  const double radius = 0.5 * bounds.size().norm() + file.largest_radius();
  const Vector<3> towards_camera = Vector<3>(0.45, -1, 0.42).normalized();
  const double distance = radius / std::sin(half_angle);
  const auto at = [&](const Vector<3>& from) { return vector_of(middle + distance * from); };
  return fmt::format(
      "camera {{ location {0} direction {5} * z up y right x * image_width / image_height sky y look_at {1} "
      "}}\n"
      "light_source {{ {2} srgb <1, 1, 1> parallel point_at {1} }}\n"
      "light_source {{ {3} srgb <0.25, 0.27, 0.30> parallel point_at {1} shadowless }}\n"
      "#declare Thickness = {4};\n",
      at(towards_camera), vector_of(middle), at({-0.6, -0.8, 1.2}), at({1, -0.6, 0.1}),
      0.002 * bounds.size().norm(), 0.5 / std::tan(half_angle));
}

void write_povray(const Exported& file, StagedFolder& staged) {
  const SizeScale sizes(file.spheres.r);
  TextFile out(staged.add(file.output.file.string()));
  out.add("// ", file.title(), "; lengths in ", name_of(file.unit()),
          "; y and z have changed places.\n// povray +A +W1200 +H900 ", file.name(),
          "\n#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\nbackground { srgb <1, 1, 1> }\n",
          camera_of(file));
  for (int c = 0; c < colour_classes; ++c) {
    const Colour colour = size_colour((c + 0.5) / colour_classes);
    out.add(
        fmt::format("#declare Size{} = texture {{ pigment {{ srgb <{}, {}, {}> }} finish {{ ambient 0.18 "
                    "diffuse 0.75 specular 0.15 roughness 0.03 }} }}\n",
                    c, colour.red, colour.green, colour.blue));
  }
  out.add(std::visit(OutlineLines(), file.domain));
  for (std::size_t i = 0; i < file.size(); ++i)
    out.add("sphere{<", file.coordinate(0, i), ',', file.coordinate(2, i), ',', file.coordinate(1, i), ">,",
            file.spheres.r[i], " texture{Size", sizes.colour_class(file.spheres.r[i]), "}}\n");
  out.close();
}

}  // namespace

const Format& povray_format() {
  static const Format format{
      .table = {.keys =
                    output_entry("povray",
                                 "POV-Ray scene with camera and light, spheres coloured by size, the outline "
                                 "of the domain",
                                 {"unit"}),
                .file = "povray.pov"},
      .write = write_povray};
  return format;
}

}  // namespace bernal
