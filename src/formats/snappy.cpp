#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "formats/snappy_case.hpp"
#include "formats/surface_file.hpp"
#include "geometry/edges.hpp"

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

/// The block that cells are made from: a period, or a box around the walls.
SnappyCase::Block block_of(const Exported& file, const WallSurface& walls) {
  SnappyCase::Block block{
      bounds_of(file.domain), file.periods(), std::holds_alternative<Box>(file.domain), {}};
  const double edge = length_of(file) / cells_per_radius;
  if (!block.is_container)
    for (const FloatPoint& p : walls.walls.vertices)
      for (int k = 0; k < 3; ++k) {
        if (block.periodic[static_cast<std::size_t>(k)]) continue;
        block.bounds.lower[k] = std::min(block.bounds.lower[k], p[static_cast<std::size_t>(k)] - 0.7 * edge);
        block.bounds.upper[k] = std::max(block.bounds.upper[k], p[static_cast<std::size_t>(k)] + 0.7 * edge);
      }
  block.divide(edge);
  return block;
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

/// The walls, continued beyond the ends of periods, and their edges.
void write_container(const Exported& file, const WallSurface& walls, SnappyCase& to, StagedFolder& staged) {
  const Mesh whole = walls.extended(boundary_of<3>(file.domain));
  to.surfaces.push_back(
      {"container.stl", "container", {{.name = "container", .level = 1, .level_in_curves = 2}}});
  write_surface(
      file,
      Surfaces(Spheres<dynamic>(3), whole, file.output.deflection, SurfaceChoice::container, file.monitor),
      staged.add("constant/triSurface/container.stl"));
  const SharpEdges edges = sharp_edges(whole, whole.triangles.size() * 3);
  if (edges.empty()) return;
  to.edges.push_back({"container_edges.obj", 1});
  write_edges_as_obj(whole.vertices, edges, 1, staged.add("constant/triSurface/container_edges.obj"));
}

std::string write_case(const Exported& file, StagedFolder& staged) {
  const StagedFolder::Below below(staged, file.output.file.string());
  const WallSurface walls = wall_surface(file.domain, file.output.deflection * length_of(file));
  const std::optional<PorePoint> inside = point_in_pores(file.spheres, file.domain, walls);
  if (!inside)
    throw Error(ErrorCode::bad_argument, "no point was found that lies in the pores; is everything filled?",
                file.output.locations.whole);
  SnappyCase made;
  made.title = file.title();
  made.block = block_of(file, walls);
  made.inside = inside->place;
  made.clearance = inside->clearance;
  made.is_proven = file.protruding == 0;  // otherwise a point outside the walls is no pore
  std::string notes;
  for (const Octave& octave : octaves_of(file)) {
    made.surfaces.push_back({octave.name + ".stl",
                             octave.name,
                             {{.name = octave.name,
                               .level = octave.level,
                               .level_in_curves = octave.level,
                               .level_in_gaps = octave.level + levels_in_gaps}}});
    notes +=
        fmt::format("{}{}: {}", notes.empty() ? "" : "; ", octave.name,
                    write_spheres(file, octave, staged.add("constant/triSurface/" + octave.name + ".stl")));
  }
  if (!made.block.is_container) write_container(file, walls, made, staged);
  write_snappy_case(made, staged);
  for (const auto& [name, text] : system_files_of_openfoam()) staged.write(std::string(name), text);
  return fmt::format("{}; locationInMesh {} m, no sphere and no wall nearer than {:.4g} m{}; run {}/Allmesh",
                     notes, point_for_openfoam(inside->place), inside->clearance,
                     made.is_proven ? " (proven)" : "", file.name());
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
