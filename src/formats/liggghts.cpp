#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "files/seal.hpp"
#include "formats/lammps.hpp"
#include "formats/templates.hpp"
#include "scene/toml_text.hpp"
#include "surfaces/wall_surface.hpp"

namespace bernal {
namespace {

constexpr std::string_view script_ending = ".in", walls_ending = ".stl";

/// A soft glass, as in tutorials; Pa.
constexpr double youngs_modulus = 5e6, poissons_ratio = 0.25, restitution = 0.7, friction = 0.3;

/// A fifth of the time in which a Rayleigh wave crosses the smallest sphere.
double time_step(const Exported& file) {
  double smallest = 1;
  for (const double r : file.spheres.r) smallest = std::min(smallest, r);
  const double shear_modulus = youngs_modulus / (2 * (1 + poissons_ratio));
  return 0.2 * std::numbers::pi * smallest * std::sqrt(file.density() / shear_modulus) /
         (0.1631 * poissons_ratio + 0.8766);
}

/// "0.7 0.7 0.7": one number a type, or a pair of types.
std::string repeated_number(double value, std::uint32_t count) {
  std::string text;
  for (std::uint32_t k = 0; k < count; ++k) text += fmt::format(" {}", value);
  return text;
}

constexpr std::string_view wall = "all wall/gran model hertz tangential history";

std::string plane_wall(int axis, std::string_view name, double position) {
  return fmt::format("fix {} {} primitive type 1 {}plane {}\n", name, wall, "xyz"[axis], position);
}

/// A word of a script: inside quotation marks only those marks are special.
std::string word_of_script(const std::string& name) {
  const char mark = name.find('"') == name.npos ? '"' : '\'';
  return is_plain_word(name) ? name : mark + name + mark;
}

void require_script_word(const void* options, const schema::Section& section) {
  const std::string name = static_cast<const Output*>(options)->file.filename().string();
  if (name.find('"') != name.npos && name.find('\'') != name.npos)
    section.fail("file",
                 fmt::format("{} has both kinds of quotation marks, and a script for LIGGGHTS can hold "
                             "one of them; give it another name",
                             toml_string(name)));
}

/// Distance of triangles from a round wall, over the largest radius.
constexpr double wall_deflection_of_spheres = 0.01;

/// The walls as triangles, if LIGGGHTS has no primitive for them: those of a part, or of a polyhedron around
/// a sphere, an oblique cylinder or a solid of revolution.
std::optional<Mesh> walls_as_triangles(const Exported& file) {
  if (const auto* mesh = std::get_if<Mesh>(&file.domain)) return *mesh;
  const auto* cylinder = std::get_if<Cylinder>(&file.domain);
  const bool is_oblique = cylinder && cylinder->coordinate_axis() < 0;
  if (!is_oblique && !std::holds_alternative<Sphere>(file.domain) &&
      !std::holds_alternative<Revolved>(file.domain))
    return std::nullopt;
  const FloatSurface surface =
      wall_surface(file.domain, wall_deflection_of_spheres * file.largest_radius()).closed();
  Mesh walls{.vertices = {}, .triangles = surface.triangles};
  for (const FloatPoint& p : surface.vertices) walls.vertices.emplace_back(p[0], p[1], p[2]);
  return walls;
}

/// The lines that make the walls of the domain, or a comment why there are none.
struct WallLines {
  const Exported& file;
  std::string walls_file;

  std::string operator()(const Box& box) const {
    std::string lines;
    for (int k = 0; k < box.dimension(); ++k) {
      if (box.repeats(k)) continue;
      lines += plane_wall(k, fmt::format("lower_{}", "xyz"[k]), box.corner[k]);
      lines += plane_wall(k, fmt::format("upper_{}", "xyz"[k]), box.corner[k] + box.size[k]);
    }
    return lines;
  }
  std::string operator()(const Cylinder& cylinder) const {
    const int axis = cylinder.coordinate_axis();
    if (axis < 0) return surface();
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;  // they follow the axis cyclically
    std::string lines = fmt::format("fix side {} primitive type 1 {}cylinder {} {} {}\n", wall, "xyz"[axis],
                                    cylinder.radius, cylinder.base[u], cylinder.base[v]);
    if (cylinder.periodic) return lines;
    const Bounds<3> bounds = bounds_of(file.domain);
    lines += plane_wall(axis, "base", bounds.lower[axis]);
    return lines + plane_wall(axis, "top", bounds.upper[axis]);
  }
  std::string operator()(const Sphere&) const { return surface(); }
  std::string operator()(const Mesh&) const { return surface(); }
  std::string operator()(const Revolved&) const { return surface(); }
  std::string surface() const {
    return fmt::format(
        "fix surface all mesh/surface file {} type 1\n"
        "fix walls {} mesh n_meshes 1 meshes surface\n",
        word_of_script(walls_file), wall);
  }
  std::string operator()(const Polygon&) const {
    return "# the walls are the edges of a polygon; give them by fix mesh/surface\n";
  }
};

/// A mesh as ASCII STL with exact doubles; LIGGGHTS computes the normals from the corners.
void write_walls(const Mesh& mesh, const std::filesystem::path& path) {
  TextFile out(path);
  out.add("solid walls\n");
  for (const auto& triangle : mesh.triangles) {
    out.add("facet normal 0 0 0\n outer loop\n");
    for (const std::uint32_t corner : triangle) {
      const Vector<3>& p = mesh.vertices[corner];
      out.add("  vertex ", p[0], ' ', p[1], ' ', p[2], '\n');
    }
    out.add(" endloop\nendfacet\n");
  }
  out.add("endsolid walls\n");
  out.close();
}

std::string script_of(const Exported& file, const std::string& walls_file) {
  const std::uint32_t n = file.type_count;
  return filled(liggghts_in,
                {{"TITLE", file.title()},
                 {"UNIT", std::string(name_of(file.unit()))},
                 {"NAME", file.name()},
                 {"SCRIPT", plain_text(word_of_script(file_beside(file.output.file, script_ending)))},
                 {"DIMENSION", std::to_string(file.dimension())},
                 {"BOUNDARY", lammps_boundary(file)},
                 {"DATA", word_of_script(file.output.file.string())},
                 {"NEIGHBOR", fmt::format("{}", 0.5 * file.largest_radius())},
                 {"YOUNG", repeated_number(youngs_modulus, n)},
                 {"POISSON", repeated_number(poissons_ratio, n)},
                 {"TYPES", std::to_string(n)},
                 {"RESTITUTION", repeated_number(restitution, n * n)},
                 {"FRICTION", repeated_number(friction, n * n)},
                 {"WALLS", std::visit(WallLines{file, walls_file}, file.domain)},
                 {"HELD", has_walls(file.domain) ? "" : "# "},
                 {"DOWN", file.dimension() == 2 ? "-1 0" : "0 -1"},
                 {"STEP", fmt::format("{:.3g}", time_step(file))}});
}

void write_liggghts(const Exported& file, StagedFolder& staged) {
  const std::string walls_file = file_beside(file.output.file, walls_ending);
  TextFile out(staged.add(file.output.file.string()));
  out.add("# ", file.title(), "; lengths in ", name_of(file.unit()), ", density in kg/m3; run by ",
          plain_text(file_beside(file.output.file, script_ending)), "\n");
  write_atoms(out, file, 1, "Atoms");
  out.close();
  std::vector<std::filesystem::path> with;
  if (file.size() > 0)
    if (const std::optional<Mesh> walls = walls_as_triangles(file))
      write_walls(*walls, with.emplace_back(staged.add(walls_file)));
  staged.write(file_beside(file.output.file, script_ending),
               sealed_script(script_of(file, walls_file), with));
}

std::string remark_on_script(const Exported& file) {
  if (file.size() == 0) return "; LIGGGHTS runs no script without spheres";
  if (!std::holds_alternative<Polygon>(file.domain)) return {};
  return "; the script has no walls, for LIGGGHTS knows none of a polygon: give them by fix mesh/surface, or "
         "all fall";
}

}  // namespace

Format liggghts_format() {
  return {.name = "liggghts",
          .writes = "LIGGGHTS data file, atom_style granular, with a script that runs it and CAD walls",
          .keys = {"material_density", "density", "types"},
          .file = "liggghts.data",
          .endings = {script_ending, walls_ending},
          .least_dimension = 2,
          .unit = Unit::m,
          .sizes = "diameter",
          .rule = require_script_word,
          .write = write_liggghts,
          .remark = remark_on_script};
}

}  // namespace bernal
