#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "formats/surface_file.hpp"
#include "formats/templates.hpp"

namespace bernal {
namespace {

namespace fs = std::filesystem;

/// Cells across the largest sphere's radius far from all surfaces, and their refinement on spheres: two
/// levels make at least four cells across every radius.
constexpr double cells_per_radius = 1;
constexpr int level_on_spheres = 2, levels_in_gaps = 1, most_levels = 8;

/// Spheres with radii of the same level: above half the largest, above a quarter, and so on.
struct Octave {
  int level;  ///< of refinement
  std::string name;
  Spheres<dynamic> spheres{3};
};

/// Every whole ball that reaches into the domain, in all its images.
std::vector<Octave> octaves_of(const Exported& file) {
  Spheres<dynamic> wrapped = file.spheres;
  wrap(wrapped, file.domain);
  const double largest = file.largest_radius();
  std::vector<Octave> all;
  for (const Piece& piece : pieces_of(wrapped, file.domain)) {
    const int octave =
        std::min(static_cast<int>(std::log2(largest / piece.radius)), most_levels - level_on_spheres);
    const auto found = std::ranges::find(all, octave + level_on_spheres, &Octave::level);
    Octave& to =
        found != all.end()
            ? *found
            : all.emplace_back(Octave{octave + level_on_spheres, fmt::format("spheres_{}", octave + 1)});
    for (int k = 0; k < 3; ++k) to.spheres.x[static_cast<std::size_t>(k)].push_back(piece.center[k]);
    to.spheres.r.push_back(piece.radius);
  }
  std::ranges::sort(all, {}, &Octave::level);
  return all;
}

/// The length scale of cells: the largest radius, or a tenth of the domain if there is none.
double length_of(const Exported& file) {
  const double radius = file.largest_radius();
  return radius > 0 ? radius : 0.1 * bounds_of(file.domain).size().maxCoeff();
}

std::string point(const Vector<3>& p) { return fmt::format("({})", row_of(p)); }

/// The block that cells are made from: a period, or a box around the walls.
struct Block {
  Bounds<3> bounds;
  std::array<bool, 3> periodic{};
  bool is_container = false;  ///< its faces are the walls
  std::array<int, 3> cells{};
};

Block block_of(const Exported& file, const WallSurface& walls) {
  Block block{bounds_of(file.domain), file.periods(), std::holds_alternative<Box>(file.domain), {}};
  const double edge = length_of(file) / cells_per_radius;
  if (!block.is_container)
    for (const FloatPoint& p : walls.walls.vertices)
      for (int k = 0; k < 3; ++k) {
        if (block.periodic[static_cast<std::size_t>(k)]) continue;
        block.bounds.lower[k] = std::min(block.bounds.lower[k], p[static_cast<std::size_t>(k)] - 0.7 * edge);
        block.bounds.upper[k] = std::max(block.bounds.upper[k], p[static_cast<std::size_t>(k)] + 0.7 * edge);
      }
  for (int k = 0; k < 3; ++k)
    block.cells[static_cast<std::size_t>(k)] =
        std::clamp(static_cast<int>(std::ceil(block.bounds.size()[k] / edge)), 1, 2000);
  return block;
}

std::string block_mesh(const Exported& file, const Block& block) {
  const Vector<3>&lower = block.bounds.lower, &upper = block.bounds.upper;
  std::string corners, patches;
  for (int corner = 0; corner < 8; ++corner) {
    // In the order of hexahedra: around the bottom, then around the top.
    const bool x = (corner & 3) == 1 || (corner & 3) == 2, y = (corner & 2) != 0, z = (corner & 4) != 0;
    corners +=
        "    " + point({x ? upper[0] : lower[0], y ? upper[1] : lower[1], z ? upper[2] : lower[2]}) + "\n";
  }
  constexpr std::array<std::string_view, 6> faces = {"(0 4 7 3)", "(1 2 6 5)", "(0 1 5 4)",
                                                     "(3 7 6 2)", "(0 3 2 1)", "(4 5 6 7)"};
  for (std::size_t face = 0; face < 6; ++face) {
    const auto name = [](std::size_t of) {
      return fmt::format("{}_{}", "xyz"[of / 2], of % 2 == 0 ? "min" : "max");
    };
    const bool cyclic = block.periodic[face / 2];
    patches +=
        fmt::format("    {}\n    {{\n        type {};\n{}        faces ({});\n    }}\n", name(face),
                    cyclic ? "cyclic" : "wall",
                    cyclic ? fmt::format("        neighbourPatch {};\n", name(face ^ 1U)) : "", faces[face]);
  }
  return filled(snappy_blockMeshDict, {{"TITLE", file.title()},
                                       {"CORNERS", corners},
                                       {"CELLS", fmt::format("{}", fmt::join(block.cells, " "))},
                                       {"PATCHES", patches}});
}

std::string snappy_dict(const std::vector<Octave>& octaves, bool has_container, const PorePoint& inside,
                        bool is_proven) {
  std::string surfaces, levels;
  // gapLevel: additional levels where opposite surfaces leave fewer than three cells.
  const auto add = [&](std::string_view name, const std::string& how) {
    surfaces +=
        fmt::format("    {0}.stl\n    {{\n        type triSurfaceMesh;\n        name {0};\n    }}\n", name);
    levels += fmt::format(
        "        {}\n        {{\n            level {};\n            patchInfo {{ type wall; }}\n        }}\n",
        name, how);
  };
  for (const Octave& octave : octaves)
    add(octave.name, fmt::format("({0} {0});\n            gapLevel (3 {0} {1})", octave.level,
                                 octave.level + levels_in_gaps));
  if (has_container) add("container", "(1 2)");
  return filled(snappy_snappyHexMeshDict,
                {{"SURFACES", surfaces},
                 {"FEATURES", has_container ? "        { file \"container.eMesh\"; level 1; }\n" : ""},
                 {"LEVELS", levels},
                 {"CLEARANCE", fmt::format("{:.6g}", inside.clearance)},
                 {"PROVEN", is_proven ? " (proven)" : ""},
                 {"INSIDE", point(inside.place)}});
}

std::string script(const Exported& file, bool has_container) {
  return filled(snappy_Allmesh,
                {{"TITLE", file.title()}, {"FEATURES", has_container ? "surfaceFeatureExtract\n" : ""}});
}

void write_surface(const Exported& file, const Surfaces& surfaces, const fs::path& to) {
  OutputFile out(to);
  write_stl(out, file, surfaces);
  out.close();
}

/// Whole spheres, ignoring periods.
std::string write_spheres(const Exported& file, const Octave& octave, const fs::path& to) {
  const Bounds<3> bounds = bounds_of(file.domain);
  const Surfaces surfaces(octave.spheres, Box{bounds.lower, bounds.size()}, file.output.deflection,
                          SurfaceChoice::spheres, file.monitor);
  write_surface(file, surfaces, to);
  return surfaces.note();
}

/// The walls, continued beyond the ends of periods.
void write_container(const Exported& file, const WallSurface& walls, const fs::path& to) {
  write_surface(file,
                Surfaces(Spheres<dynamic>(3), walls.extended(boundary_of<3>(file.domain)),
                         file.output.deflection, SurfaceChoice::container, file.monitor),
                to);
}

std::string write_case(const Exported& file, StagedFolder& staged) {
  const std::string name = file.output.file.string();
  const WallSurface walls = wall_surface(file.domain, file.output.deflection * length_of(file));
  const std::optional<PorePoint> inside = point_in_pores(file.spheres, file.domain, walls);
  if (!inside)
    throw Error(ErrorCode::bad_argument, "no point was found that lies in the pores; is everything filled?",
                file.output.locations.whole);
  const Block block = block_of(file, walls);
  const bool has_container = !block.is_container;
  const std::vector<Octave> octaves = octaves_of(file);
  const bool is_proven = file.protruding == 0;  // otherwise a point outside the walls is no pore
  std::string notes;
  for (const Octave& octave : octaves)
    notes += fmt::format(
        "{}{}: {}", notes.empty() ? "" : "; ", octave.name,
        write_spheres(file, octave, staged.add(name + "/constant/triSurface/" + octave.name + ".stl")));
  if (has_container) {
    write_container(file, walls, staged.add(name + "/constant/triSurface/container.stl"));
    staged.write(name + "/system/surfaceFeatureExtractDict", snappy_surfaceFeatureExtractDict);
  }
  staged.write(name + "/system/blockMeshDict", block_mesh(file, block));
  staged.write(name + "/system/snappyHexMeshDict", snappy_dict(octaves, has_container, *inside, is_proven));
  staged.write(name + "/system/controlDict", snappy_controlDict);
  staged.write(name + "/system/fvSchemes", snappy_fvSchemes);
  staged.write(name + "/system/fvSolution", snappy_fvSolution);
  staged.write(name + "/Allmesh", script(file, has_container));
  std::error_code ignored;  // the file system may not support permissions
  fs::permissions(staged.written(name + "/Allmesh"), fs::perms::owner_exec | fs::perms::group_exec,
                  fs::perm_options::add, ignored);
  return fmt::format("{}; locationInMesh {} m, no sphere and no wall nearer than {:.4g} m{}; run {}/Allmesh",
                     notes, point(inside->place), inside->clearance, is_proven ? " (proven)" : "",
                     file.name());
}

}  // namespace

Format snappy_format() {
  return {.name = "snappy",
          .writes = "folder with a case for snappyHexMesh of OpenFOAM: a mesh of the pores",
          .keys = {"deflection"},
          .file = "snappy",
          .unit = Unit::m,
          .sizes = "triangles",
          .is_folder = true,
          .write_with_note = write_case};
}

}  // namespace bernal
