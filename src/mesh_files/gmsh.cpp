#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "formats/text_file.hpp"
#include "mesh_files/mesh_file.hpp"

namespace bernal {
namespace {

/// The order in which Gmsh has the edges of a tetrahedron, in that of `edges_of_tetrahedron`.
constexpr std::array<std::size_t, 6> middles_in_gmsh = {0, 1, 2, 3, 5, 4};

struct Extent {
  Vector<3> lower = Vector<3>::Constant(0), upper = Vector<3>::Constant(0);
  bool is_empty = true;
  void add(const Vector<3>& p) {
    lower = is_empty ? p : Vector<3>(lower.cwiseMin(p));
    upper = is_empty ? p : Vector<3>(upper.cwiseMax(p));
    is_empty = false;
  }
};

void add_extent(TextFile& out, std::size_t tag, const Extent& extent) {
  out.add(tag);
  for (const Vector<3>* p : {&extent.lower, &extent.upper})
    for (int k = 0; k < 3; ++k) out.add(' ', (*p)[k]);
  out.add(" 1 ", tag);
}

/// One entity a group, of the same number as its physical group.
void add_entities(const MeshToWrite& file, TextFile& out) {
  const VolumeMesh& mesh = file.mesh;
  const MeshGroups& groups = file.groups;
  std::vector<Extent> surfaces(groups.surfaces.size()), volumes(groups.volumes.size());
  // Which surfaces bound a volume.
  std::vector<std::vector<std::uint32_t>> around(groups.volumes.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t vertex : mesh.triangles[t])
      surfaces[groups.surface_of(mesh, t)].add(mesh.vertices[vertex]);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (const std::uint32_t vertex : mesh.tetrahedra[t])
      volumes[groups.volume_of(mesh, t)].add(mesh.vertices[vertex]);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    for (const std::int32_t region : mesh.patches[p].regions)
      if (region != SurfacePatch::nothing) {
        auto& of = around[groups.volume_of_region[static_cast<std::size_t>(region)]];
        if (std::ranges::find(of, groups.surface_of_patch[p]) == of.end())
          of.push_back(groups.surface_of_patch[p]);
      }
  out.add("$PhysicalNames\n", surfaces.size() + volumes.size(), "\n");
  for (std::size_t s = 0; s < surfaces.size(); ++s) out.add("2 ", s + 1, " \"", groups.surfaces[s], "\"\n");
  for (std::size_t v = 0; v < volumes.size(); ++v) out.add("3 ", v + 1, " \"", groups.volumes[v], "\"\n");
  out.add("$EndPhysicalNames\n$Entities\n0 0 ", surfaces.size(), ' ', volumes.size(), "\n");
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    add_extent(out, s + 1, surfaces[s]);
    out.add(" 0\n");
  }
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    add_extent(out, v + 1, volumes[v]);
    out.add(' ', around[v].size());
    for (const std::uint32_t surface : around[v]) out.add(' ', surface + 1);
    out.add("\n");
  }
  out.add("$EndEntities\n");
}

void add_nodes(const VolumeMesh& mesh, TextFile& out) {
  const std::size_t count = mesh.node_count();
  out.add("$Nodes\n1 ", count, " 1 ", count, "\n3 1 0 ", count, "\n");
  for (std::size_t i = 1; i <= count; ++i) out.add(i, "\n");
  for (std::size_t i = 0; i < count; ++i) {
    const Vector<3>& p = mesh.node(i);
    out.add(p[0], ' ', p[1], ' ', p[2], "\n");
  }
  out.add("$EndNodes\n");
}

void add_elements(const MeshToWrite& file, TextFile& out) {
  constexpr int triangle = 2, tetrahedron = 4, prism = 6, pyramid = 7, triangle6 = 9, tetrahedron10 = 11;
  const VolumeMesh& mesh = file.mesh;
  const auto triangles = by_group(mesh.triangles.size(), file.groups.surfaces.size(),
                                  [&](std::size_t t) { return file.groups.surface_of(mesh, t); });
  const auto tetrahedra = by_group(mesh.tetrahedra.size(), file.groups.volumes.size(),
                                   [&](std::size_t t) { return file.groups.volume_of(mesh, t); });
  // Prisms by how many corners they have: four, five, six.
  const auto prisms = by_group(mesh.stacks.prisms.size(), 7,
                               [&](std::size_t p) { return distinct_corners(mesh.stacks.prisms[p]).size(); });
  const std::size_t count = mesh.triangles.size() + mesh.tetrahedra.size() + mesh.stacks.prisms.size();
  const auto kinds = static_cast<std::size_t>(
      std::ranges::count_if(prisms, [](const auto& of_kind) { return !of_kind.empty(); }));
  out.add("$Elements\n", triangles.size() + tetrahedra.size() + kinds, ' ', count, " 1 ", count, "\n");
  std::size_t number = 0;
  for (std::size_t s = 0; s < triangles.size(); ++s) {
    out.add("2 ", s + 1, ' ', mesh.is_curved() ? triangle6 : triangle, ' ', triangles[s].size(), "\n");
    for (const std::uint32_t t : triangles[s]) {
      out.add(++number);
      for (const std::uint32_t vertex : mesh.triangles[t]) out.add(' ', vertex + 1);
      if (mesh.is_curved())
        for (const std::uint32_t middle : mesh.middles_of_triangle[t]) out.add(' ', middle + 1);
      out.add("\n");
    }
  }
  for (std::size_t v = 0; v < tetrahedra.size(); ++v) {
    out.add("3 ", v + 1, ' ', mesh.is_curved() ? tetrahedron10 : tetrahedron, ' ', tetrahedra[v].size(),
            "\n");
    for (const std::uint32_t t : tetrahedra[v]) {
      out.add(++number);
      for (const std::uint32_t vertex : mesh.tetrahedra[t]) out.add(' ', vertex + 1);
      if (mesh.is_curved())
        for (const std::size_t e : middles_in_gmsh) out.add(' ', mesh.middles_of_tetrahedron[t][e] + 1);
      out.add("\n");
    }
  }
  for (std::size_t corners = 0; corners < prisms.size(); ++corners) {
    if (prisms[corners].empty()) continue;
    out.add("3 ", file.groups.volume_of_region[0] + 1, ' ',
            corners == 6   ? prism
            : corners == 5 ? pyramid
                           : tetrahedron,
            ' ', prisms[corners].size(), "\n");
    for (const std::uint32_t p : prisms[corners]) {
      out.add(++number);
      for (const std::uint32_t vertex : distinct_corners(mesh.stacks.prisms[p])) out.add(' ', vertex + 1);
      out.add("\n");
    }
  }
  out.add("$EndElements\n");
}

void add_periodic(const MeshToWrite& file, TextFile& out) {
  const VolumeMesh& mesh = file.mesh;
  std::vector<std::size_t> axes;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!mesh.periodic[axis].empty()) axes.push_back(axis);
  if (axes.empty()) return;
  out.add("$Periodic\n", axes.size(), "\n");
  for (const std::size_t axis : axes) {
    const auto& pairs = mesh.periodic[axis];
    const auto end = static_cast<std::uint32_t>(2 * axis);
    const double period = (mesh.vertices[pairs[0][1]] - mesh.vertices[pairs[0][0]])[static_cast<int>(axis)];
    out.add("2 ", file.groups.surface_named(name_of_end(end + 1)) + 1, ' ',
            file.groups.surface_named(name_of_end(end)) + 1, "\n16");
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t column = 0; column < 4; ++column)
        out.add(' ', row == column ? 1.0 : row == axis && column == 3 ? period : 0.0);
    out.add("\n", pairs.size(), "\n");
    for (const auto& [lower, upper] : pairs) out.add(upper + 1, ' ', lower + 1, "\n");
  }
  out.add("$EndPeriodic\n");
}

std::string write_mesh_for_gmsh(const MeshToWrite& file, StagedFolder& staged) {
  TextFile out(staged.add(file.name.string()));
  out.add("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\n", file.title, "; lengths in ", file.unit,
          "\n$EndComments\n");
  add_entities(file, out);
  add_nodes(file.mesh, out);
  add_elements(file, out);
  add_periodic(file, out);
  out.close();
  return fmt::format("{} physical surfaces, {} physical volumes", file.groups.surfaces.size(),
                     file.groups.volumes.size());
}

}  // namespace

MeshWriter gmsh_of_mesh() {
  return {.format = {"gmsh", "Gmsh, meshio, FEniCS: physical groups, and pairs of nodes at ends of periods",
                     ".msh", 2, true},
          .write = write_mesh_for_gmsh};
}

}  // namespace bernal
