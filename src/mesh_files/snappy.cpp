#include "formats/snappy_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "formats/text_file.hpp"
#include "mesh_files/mesh_file.hpp"
#include "mesh_files/periodic_copies.hpp"
#include "surfaces/surfaces.hpp"

namespace bernal {
namespace {

constexpr std::string_view surface_file = "bed.obj", edges_file = "edges.obj";
/// Cells have the length of edges that is asked for on the largest spheres at this level.
constexpr int level_on_spheres = 2, most_levels = 8;
/// Cells at bridges are half as long as edges there: a circle is a polygon of edges, but of cells a staircase
/// before it is snapped. Gaps may be finer than spheres by this.
constexpr int levels_in_gaps = 2;

double length_of_cells_on_spheres(const MeshToWrite& file) {
  return file.options.sphere_edge * std::ranges::max(file.solids.spheres.r);
}

/// The level of cells that are about this long, not above `most_levels`.
int level_of(double block_edge, double length) {
  return std::clamp(static_cast<int>(std::lround(std::log2(block_edge / length))), 0, most_levels);
}

/// The parts of the surface: of each of its groups, and for spheres of each level.
struct PartsOfSurface {
  std::vector<SnappyCase::Part> parts;
  std::vector<std::uint32_t> of_patch;
};
PartsOfSurface parts_of(const MeshToWrite& file, double block_edge) {
  using Kind = SurfacePatch::Kind;
  const auto& patches = file.mesh.patches;
  const Boundary<3> boundary = boundary_of<3>(file.solids.domain);
  const int on_necks =
      level_of(block_edge, 0.5 * file.options.neck_edge * std::ranges::min(file.solids.spheres.r));
  std::vector<int> level(patches.size(), level_on_spheres);
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> known;
  std::map<std::uint32_t, int> count;  // of levels of a group
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const SurfacePatch& patch = patches[p];
    if (is_end_of_period(patch, boundary)) continue;
    if (patch.kind == Kind::sphere)
      level[p] = level_of(block_edge, file.options.sphere_edge * patch.shape.radius);
    if (patch.kind == Kind::neck) level[p] = on_necks;
    if (patch.kind == Kind::cut_face) level[p] = level_on_spheres + 1;
    if (known.try_emplace({file.groups.surface_of_patch[p], level[p]}, 0).second)
      ++count[file.groups.surface_of_patch[p]];
  }
  PartsOfSurface made;
  for (auto& [key, number] : known) {
    const auto& [group, least] = key;
    const std::string& name = file.groups.surfaces[group];
    number = static_cast<std::uint32_t>(made.parts.size());
    SnappyCase::Part& part = made.parts.emplace_back();
    part.name = count[group] == 1 ? name : fmt::format("{}_{}", name, least - level_on_spheres + 1);
    if (part.name != name) part.group = name;
    part.type = type_of_patch(file.groups, group);
    if (part.type == "wall" && name != "necks" && name != "caps") part.layers = file.options.prisms;
    part.level = least;
    part.level_in_curves = least;
    if (name != "necks") part.level_in_gaps = least + levels_in_gaps;
  }
  for (std::size_t p = 0; p < patches.size(); ++p)
    made.of_patch.push_back(
        is_end_of_period(patches[p], boundary) ? 0 : known[{file.groups.surface_of_patch[p], level[p]}]);
  return made;
}

/// Edges between patches that bend by more than 30 degrees: rims of bridges and caps, edges of walls.
SharpEdges edges_between(const OpenSurface& surface, const std::vector<std::uint32_t>& patch_of) {
  const double least_bend = std::cos(30 * std::numbers::pi / 180);
  const auto normal = [&](std::uint32_t t) {
    const auto& [a, b, c] = surface.triangles[t];
    const Vector<3>& from = surface.vertices[a];
    return Vector<3>((surface.vertices[b] - from).cross(surface.vertices[c] - from).normalized());
  };
  SharpEdges edges;
  MeshEdges(surface.triangles).for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() != 2) return;
    const std::uint32_t one = uses[0].triangle, other = uses[1].triangle;
    if (patch_of[surface.triangle[one]] == patch_of[surface.triangle[other]]) return;
    if (normal(one).dot(normal(other)) < least_bend) edges.push_back({uses[0].low, uses[0].high});
  });
  return edges;
}

void write_surface_as_obj(const MeshToWrite& file, const OpenSurface& surface, const PartsOfSurface& parts,
                          const std::filesystem::path& to) {
  TextFile out(to);
  out.add("# ", file.title, "; lengths in m\n");
  for (const Vector<3>& v : surface.vertices)
    out.add("v ", file.metres * v[0], ' ', file.metres * v[1], ' ', file.metres * v[2], "\n");
  const auto triangles = by_group(surface.triangles.size(), parts.parts.size(), [&](std::size_t t) {
    return parts.of_patch[file.mesh.patch[surface.triangle[t]]];
  });
  for (std::size_t part = 0; part < triangles.size(); ++part) {
    out.add("g ", parts.parts[part].name, "\n");
    for (const std::uint32_t t : triangles[part]) {
      const auto& [a, b, c] = surface.triangles[t];
      out.add("f ", a + 1, ' ', b + 1, ' ', c + 1, "\n");
    }
  }
  out.close();
}

/// The spheres, and for each bridge a ball around it.
Spheres<dynamic> spheres_and_bridges(const MeshToWrite& file) {
  const VolumeMesh& mesh = file.mesh;
  std::vector<Bounds<3>> around(mesh.patches.size(),
                                {Vector<3>::Constant(std::numeric_limits<double>::infinity()),
                                 Vector<3>::Constant(-std::numeric_limits<double>::infinity())});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) {
      Bounds<3>& of = around[mesh.patch[t]];
      of.lower = of.lower.cwiseMin(mesh.vertices[v]);
      of.upper = of.upper.cwiseMax(mesh.vertices[v]);
    }
  Spheres<dynamic> all = file.solids.spheres;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    if (mesh.patches[p].kind != SurfacePatch::Kind::neck || !(around[p].lower[0] <= around[p].upper[0]))
      continue;
    // A bridge, or the part of it in the domain, lies in the hull of its side, and that in this box.
    for (int k = 0; k < 3; ++k) all.x[static_cast<std::size_t>(k)].push_back(around[p].center()[k]);
    all.r.push_back(0.5 * around[p].size().norm());
  }
  wrap(all, file.solids.domain);
  return all;
}

/// A box around the surface, whose faces are ends of periods along the axes of these.
SnappyCase::Block block_around(const MeshToWrite& file, double edge) {
  // Faces of cells in no plane of symmetry of the surface.
  constexpr double below = 0.37, above = 0.41;
  SnappyCase::Block block{bounds_of(file.solids.domain), {}, false, {}};
  const Boundary<3> boundary = boundary_of<3>(file.solids.domain);
  Bounds<3> bounds = block.bounds;
  for (const Vector<3>& v : file.mesh.vertices) {
    bounds.lower = bounds.lower.cwiseMin(v);
    bounds.upper = bounds.upper.cwiseMax(v);
  }
  for (int k = 0; k < 3; ++k) {
    block.periodic[static_cast<std::size_t>(k)] = boundary.repeats(k);
    if (boundary.repeats(k)) {
      block.bounds.lower[k] = boundary.origin[k];
      block.bounds.upper[k] = boundary.origin[k] + boundary.edges[k];
    } else {
      const double cells = std::ceil((bounds.size()[k] + (below + above) * edge) / edge);
      block.bounds.lower[k] = bounds.lower[k] - below * edge;
      block.bounds.upper[k] = block.bounds.lower[k] + cells * edge;
    }
  }
  block.divide(edge * (1 + 1e-9));
  block.bounds.lower *= file.metres;
  block.bounds.upper *= file.metres;
  return block;
}

std::string write_case_for_snappy(const MeshToWrite& file, StagedFolder& staged) {
  const double block_edge = (1 << level_on_spheres) * length_of_cells_on_spheres(file);
  const std::optional<PorePoint> inside =
      point_in_pores(spheres_and_bridges(file), file.solids.domain,
                     wall_surface(file.solids.domain, 1e-3 * length_of_cells_on_spheres(file)));
  if (!inside)
    throw Error(ErrorCode::bad_argument, "no point was found that lies in the fluid; is everything filled?");
  const PartsOfSurface parts = parts_of(file, block_edge);
  const OpenSurface surface = with_periodic_copies(file.mesh, boundary_of<3>(file.solids.domain), block_edge);
  const SharpEdges edges = edges_between(surface, file.mesh.patch);
  const std::string folder = "constant/triSurface/";
  write_surface_as_obj(file, surface, parts, staged.add(folder + std::string(surface_file)));
  write_edges_as_obj(surface.vertices, edges, file.metres, staged.add(folder + std::string(edges_file)));
  SnappyCase made;
  made.title = file.title;
  made.block = block_around(file, block_edge);
  made.surfaces.push_back({std::string(surface_file), "bed", parts.parts});
  int finest = 0;
  for (const SnappyCase::Part& part : parts.parts) finest = std::max(finest, part.level);
  if (!edges.empty()) made.edges.push_back({std::string(edges_file), finest});
  // Over the length of the cells there, so that it is less where cells are smaller.
  made.layers_height = file.options.prism_height / file.options.sphere_edge;
  made.layers_growth = file.options.prism_growth;
  made.inside = file.metres * inside->place;
  made.clearance = file.metres * inside->clearance;
  write_snappy_case(made, staged);
  write_system_of_openfoam(file, staged);
  staged.write(file.name.string(), "");
  return fmt::format(
      "{} triangles in {} parts, {} edges to keep, in m; a block of {} x {} x {} cells; "
      "locationInMesh {}, no sphere, wall or bridge nearer than {:.4g} m (proven); run Allmesh",
      surface.triangles.size(), parts.parts.size(), edges.size(), made.block.cells[0], made.block.cells[1],
      made.block.cells[2], point_for_openfoam(made.inside), made.clearance);
}

}  // namespace

MeshWriter snappy_of_mesh() {
  return {
      .format = {.name = "snappy",
                 .what = "OpenFOAM's snappyHexMesh: the surface with bridges and walls, its edges, and the "
                         "case, in m; the script Allmesh beside the file makes the mesh",
                 .ending = ".foam",
                 .largest_order = 1,
                 .has_prisms = true,
                 .is_surface = true},
      .others = {"constant/triSurface/bed.obj", "constant/triSurface/edges.obj", "system/blockMeshDict",
                 "system/snappyHexMeshDict", "Allmesh"},
      .write = write_case_for_snappy};
}

}  // namespace bernal
