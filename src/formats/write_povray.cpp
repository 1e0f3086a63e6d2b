#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "formats/format.hpp"
#include "formats/text_file.hpp"
#include "io/legend.hpp"
#include "io/palette.hpp"

namespace bernal {
namespace {

/// POV-Ray's frame is left-handed and its y points up: y and z change places.
std::string vector_of(const Vector<3>& v) { return fmt::format("<{}, {}, {}>", v[0], v[2], v[1]); }

constexpr std::string_view glass = "pigment { srgbt <0.62, 0.70, 0.80, 0.82> } no_shadow";

/// POV-Ray takes what is smaller than some 1e-6 for a point, and sees no farther than 1e7: a picture of a
/// domain of another size is made in lengths of its own, so many of the file's unit each. A power of ten.
double length_in_picture(const Domain& domain) {
  constexpr double smallest = 0.1, largest = 1e4;
  const double diagonal = bounds_of(domain).diagonal();
  if (!(diagonal > 0) || (diagonal >= smallest && diagonal <= largest)) return 1;
  return std::pow(10, std::floor(std::log10(diagonal)));
}

/// In those lengths: divided, and from the middle of the domain.
struct InPicture {
  double length;
  Vector<3> middle;

  Vector<3> operator()(const Vector<3>& p) const { return (p - middle) / length; }
  Domain operator()(Box box) const {
    box.corner = (*this)(Vector<3>(box.corner));
    box.size /= length;
    return box;
  }
  Domain operator()(Cylinder cylinder) const {
    cylinder.base = (*this)(cylinder.base);
    cylinder.radius /= length;
    cylinder.height /= length;
    return cylinder;
  }
  Domain operator()(Sphere sphere) const {
    return Sphere{.center = (*this)(sphere.center), .radius = sphere.radius / length};
  }
  Domain operator()(Mesh mesh) const {
    for (Vector<3>& vertex : mesh.vertices) vertex = (*this)(vertex);
    return mesh;
  }
  Domain operator()(const Polygon& polygon) const { return polygon; }
};

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

std::string note_of_picture(const Exported& file) {
  const double length = length_in_picture(file.domain);
  if (length == 1) return "radii";
  return fmt::format("radii; in the picture a length of 1 is {} {}", length, name_of(file.unit()));
}

void write_picture(const Exported& file, double length, StagedFolder& staged) {
  const SizeScale sizes(file.spheres.r);
  TextFile out(staged.add(file.output.file.string()));
  out.add("// ", file.title(), "; lengths in ");
  if (length != 1) out.add(fmt::format("{} ", length));
  out.add(name_of(file.unit()), length != 1 ? ", from the middle" : "",
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

void write_povray(const Exported& file, StagedFolder& staged) {
  const double length = length_in_picture(file.domain);
  if (length == 1) return write_picture(file, length, staged);
  const Bounds<3> bounds = bounds_of(file.domain);
  const InPicture in_picture{length, 0.5 * (bounds.lower + bounds.upper)};
  Exported picture = file;
  for (std::size_t k = 0; k < 3; ++k)
    for (double& x : picture.spheres.x[k]) x = (x - in_picture.middle[static_cast<int>(k)]) / length;
  for (double& r : picture.spheres.r) r /= length;
  picture.domain = std::visit(in_picture, file.domain);
  write_picture(picture, length, staged);
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
      .write = write_povray,
      .note = note_of_picture};
  return format;
}

}  // namespace bernal
