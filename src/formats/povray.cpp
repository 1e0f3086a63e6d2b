#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "domain/revolved_surface.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/layered.hpp"
#include "formats/templates.hpp"
#include "formats/text_file.hpp"
#include "report/legend.hpp"
#include "viewer/palette.hpp"

namespace bernal {
namespace {

/// The start of a packing's sphere, and the remark about the frame, for writer and reader.
constexpr std::string_view ball_mark = "sphere{<", swap_mark = "y and z have changed places";

/// POV-Ray's frame is left-handed with y up, so y and z are swapped.
std::string vector_of(const Vector<3>& v) { return fmt::format("<{}, {}, {}>", v[0], v[2], v[1]); }

constexpr std::string_view glass = "pigment { srgbt <0.62, 0.70, 0.80, 0.82> } no_shadow";

/// POV-Ray treats lengths below about 1e-6 as zero and sees no farther than 1e7: a domain of another size is
/// drawn in another unit of length, a power of ten.
double length_in_picture(const Domain& domain) {
  constexpr double smallest = 0.1, largest = 1e4;
  const double diagonal = bounds_of(domain).diagonal();
  if (!(diagonal > 0) || (diagonal >= smallest && diagonal <= largest)) return 1;
  return std::pow(10, std::floor(std::log10(diagonal)));
}

/// The lines that show the domain with the spheres in it.
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
  std::string operator()(const Revolved& revolved) const {
    constexpr int sides = 180;
    return (*this)(surface_of(revolved, sides));
  }
  std::string operator()(const Polygon&) const { return {}; }
};

std::string note_of_picture(const Exported& file) {
  const double length = length_in_picture(file.domain);
  const std::string what = shows_layers(file)
                               ? "radii of layers; what is in front of the middle is cut away, unless Cut = 0"
                               : "radii";
  if (length == 1) return what;
  return fmt::format("{}; in the picture a length of 1 is {} {}", what, length, name_of(file.unit()));
}

std::string texture(std::string_view name, std::size_t k, const Colour& colour) {
  return fmt::format(
      "#declare {}{} = texture {{ pigment {{ srgb <{}, {}, {}> }} finish {{ ambient 0.18 "
      "diffuse 0.75 specular 0.15 roughness 0.03 }} }}\n",
      name, k, colour.red, colour.green, colour.blue);
}

/// One line a sphere, which a reader takes for the packing; `texture_of` says how each looks.
template <class TextureOf>
void write_spheres(const Exported& file, TextFile& out, const TextureOf& texture_of) {
  for (std::size_t i = 0; i < file.size(); ++i)
    out.add(ball_mark, file.coordinate(0, i), ',', file.coordinate(2, i), ',', file.coordinate(1, i), ">,",
            file.spheres.r[i], texture_of(i), "}\n");
}

/// Whole spheres, or their shells, of which what is in front of a plane is cut away, so that they are seen.
void write_layers(const Exported& file, const LayeredSpheres& layers, const Vector<3>& middle,
                  TextFile& out) {
  const auto material_of = [&](std::size_t k) { return layers.kinds[layers.kind[k]].material; };
  out.add("#declare Cut = 1;  // 0: whole spheres\n#declare CutAt = ", middle[1],
          ";  // what is nearer than this is cut away\n#if (Cut = 0)\n");
  write_spheres(file, out, [&](std::size_t i) {
    return fmt::format(" texture{{Material{}}}", material_of(layers.first[i + 1] - 1));
  });
  out.add(
      "#else\n#macro Shell(Center, Outer, Inner, Look)\n"
      "#if (Center.z + Outer > CutAt)\ndifference { sphere { Center, Outer }\n"
      "#if (Inner > 0) sphere { Center, Inner } #end\n#if (Center.z - Outer < CutAt) plane { z, CutAt } "
      "#end\n"
      "texture { Look } }\n#end\n#end\n");
  for (std::size_t i = 0; i < file.size(); ++i)
    for (std::size_t k = layers.first[i]; k < layers.first[i + 1]; ++k)
      out.add("Shell(<", file.coordinate(0, i), ',', file.coordinate(2, i), ',', file.coordinate(1, i), ">,",
              layers.outer[k], ',', k == layers.first[i] ? 0.0 : layers.outer[k - 1], ",Material",
              material_of(k), ")\n");
  out.add("#end\n");
}

/// The camera is far enough away to see all of the domain and protruding spheres, in pictures at least as
/// wide as high.
void write_picture(const Exported& file, double length, TextFile& out) {
  constexpr double half_angle = 13 * std::numbers::pi / 180;
  const Bounds<3> bounds = bounds_of(file.domain);
  const Vector<3> middle = 0.5 * (bounds.lower + bounds.upper);
  const double distance = (0.5 * bounds.size().norm() + file.largest_radius()) / std::sin(half_angle);
  const auto at = [&](const Vector<3>& from) { return vector_of(middle + distance * from); };
  std::string textures;
  const LayeredSpheres layers = shows_layers(file) ? layered(file) : LayeredSpheres();
  for (std::size_t k = 0; k < layers.materials.size(); ++k)
    textures += fmt::format("// {}\n{}", layers.materials[k], texture("Material", k, kind_colour(k)));
  for (std::size_t c = 0; layers.materials.empty() && c < colour_classes; ++c)
    textures += texture("Size", c, size_colour((static_cast<double>(c) + 0.5) / colour_classes));
  const std::string_view unit = name_of(file.unit());
  out.add(filled(povray_pov, {{"TITLE", file.title()},
                              {"UNIT", length == 1 ? std::string(unit)
                                                   : fmt::format("{} {}, from the middle", length, unit)},
                              {"SWAPPED", std::string(swap_mark)},
                              {"NAME", file.name()},
                              {"LOCATION", at(Vector<3>(0.45, -1, 0.42).normalized())},
                              {"DIRECTION", fmt::format("{}", 0.5 / std::tan(half_angle))},
                              {"MIDDLE", vector_of(middle)},
                              {"LIGHT", at({-0.6, -0.8, 1.2})},
                              {"FILL_LIGHT", at({1, -0.6, 0.1})},
                              {"THICKNESS", fmt::format("{}", 0.002 * bounds.size().norm())},
                              {"SIZES", textures},
                              {"OUTLINE", std::visit(OutlineLines(), file.domain)}}));
  if (!layers.materials.empty()) return write_layers(file, layers, middle, out);
  const SizeScale sizes(file.spheres.r);
  write_spheres(file, out, [&](std::size_t i) {
    return fmt::format(" texture{{Size{}}}", sizes.colour_class(file.spheres.r[i]));
  });
}

void write_povray(const Exported& file, TextFile& out) {
  const double length = length_in_picture(file.domain);
  if (length == 1) return write_picture(file, length, out);
  const Bounds<3> bounds = bounds_of(file.domain);
  const Vector<3> middle = 0.5 * (bounds.lower + bounds.upper);
  const Mapping mapping{[&](double x, int axis) { return (x - middle[axis]) / length; },
                        [&](double l) { return l / length; }};
  Exported picture = file;
  mapping.map(picture.spheres);
  picture.domain = mapping.of(file.domain);
  write_picture(picture, length, out);
}

/// Reads scenes that bernal wrote: each sphere of the packing has a line, without a blank after the keyword.
FileContents read_povray(const Reading& reading) {
  ForeignLines lines(reading);
  FileContents contents;
  bool is_swapped = false;
  const SphereColumns columns = columns_xyzr();
  std::vector<std::string_view> parts;
  while (lines.next()) {
    const std::string_view line = lines.line();
    if (line.starts_with("//")) {
      is_swapped = is_swapped || line.find(swap_mark) != line.npos;
      lines.take_unit_remark(contents.unit);
    }
    if (!line.starts_with(ball_mark)) continue;
    split_at(line.substr(ball_mark.size()), "<,> ", parts);
    add_row(lines, columns, parts, contents.spheres);
  }
  if (contents.size() == 0)
    lines.fail("there is no sphere of a packing in it; only scenes that bernal wrote are read");
  if (is_swapped) std::swap(contents.spheres.x[1], contents.spheres.x[2]);
  return contents;
}

}  // namespace

Format povray_format() {
  return {.name = "povray",
          .writes =
              "POV-Ray scene with camera and light, spheres coloured by size, the outline of the domain; or "
              "their "
              "layers, by material, cut open",
          .keys = {"unit", "layers"},
          .file = "povray.pov",
          .write_text = write_povray,
          .note = note_of_picture,
          .reads = "POV-Ray scenes that bernal wrote",
          .unit_from = "\"lengths in mm\" in its first line",
          .recognises =
              [](const FileBeginning& file) { return file.begins("// bernal ") && file.has(swap_mark); },
          .read = read_povray};
}

}  // namespace bernal
