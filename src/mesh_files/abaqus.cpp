#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "formats/text_file.hpp"
#include "mesh_files/mesh_file.hpp"

namespace bernal {
namespace {

/// Both programs read twenty characters of a number.
constexpr int digits = 13;
/// The number of a face in Abaqus, by the corner opposite.
constexpr std::array<int, 4> face_in_abaqus = {3, 4, 2, 1};

/// Numbers of a set, sixteen a line.
void add_set(TextFile& out, const std::vector<std::uint32_t>& numbers) {
  constexpr std::size_t in_line = 16;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out.add(numbers[i] + 1, i % in_line == in_line - 1 || i + 1 == numbers.size() ? "\n" : ", ");
}

void add_volumes(const MeshToWrite& file, TextFile& out) {
  const VolumeMesh& mesh = file.mesh;
  const auto tetrahedra = by_group(mesh.tetrahedra.size(), file.groups.volumes.size(),
                                   [&](std::size_t t) { return file.groups.volume_of(mesh, t); });
  for (std::size_t v = 0; v < tetrahedra.size(); ++v) {
    out.add("*ELEMENT, TYPE=", mesh.is_curved() ? "C3D10" : "C3D4", ", ELSET=", file.groups.volumes[v], "\n");
    for (const std::uint32_t t : tetrahedra[v]) {
      out.add(t + 1);
      for (const std::uint32_t vertex : mesh.tetrahedra[t]) out.add(", ", vertex + 1);
      if (mesh.is_curved())
        for (const std::uint32_t middle : mesh.middles_of_tetrahedron[t]) out.add(", ", middle + 1);
      out.add("\n");
    }
  }
}

void add_surfaces(const MeshToWrite& file, TextFile& out) {
  const VolumeMesh& mesh = file.mesh;
  const auto sides = sides_of_triangles(mesh);
  const auto triangles = by_group(mesh.triangles.size(), file.groups.surfaces.size(),
                                  [&](std::size_t t) { return file.groups.surface_of(mesh, t); });
  for (std::size_t s = 0; s < triangles.size(); ++s) {
    std::vector<std::uint32_t> nodes;
    for (const std::uint32_t t : triangles[s]) {
      nodes.insert(nodes.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
      if (mesh.is_curved())
        nodes.insert(nodes.end(), mesh.middles_of_triangle[t].begin(), mesh.middles_of_triangle[t].end());
    }
    std::ranges::sort(nodes);
    nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
    out.add("*NSET, NSET=", file.groups.surfaces[s], "\n");
    add_set(out, nodes);
    // Seen from the fluid where that is on one side, which is the first region.
    out.add("*SURFACE, NAME=on_", file.groups.surfaces[s], ", TYPE=ELEMENT\n");
    for (const std::uint32_t t : triangles[s]) {
      const auto& [behind, before] = sides[t];
      const bool from_behind =
          behind.is_there() && (!before.is_there() || mesh.region[behind.tetrahedron] == 0);
      const TriangleSide& seen = from_behind ? behind : before;
      out.add(seen.tetrahedron + 1, ", S", face_in_abaqus[seen.face], "\n");
    }
  }
}

/// Every upper node of a period once, with the one that it is an image of along all axes.
std::vector<std::array<std::uint32_t, 2>> images_of(const VolumeMesh& mesh) {
  std::vector<std::uint32_t> lower_of(mesh.node_count());
  for (std::uint32_t v = 0; v < lower_of.size(); ++v) lower_of[v] = v;
  for (const auto& pairs : mesh.periodic)
    for (const auto& [lower, upper] : pairs) lower_of[upper] = lower;
  std::vector<std::array<std::uint32_t, 2>> images;
  for (std::uint32_t v = 0; v < lower_of.size(); ++v) {
    std::uint32_t first = v;
    while (lower_of[first] != first) first = lower_of[first];
    if (first != v) images.push_back({v, first});
  }
  return images;
}

constexpr std::string_view equations_ending = "_periodic.inc";

/// Equations for what a user includes: equal temperatures at opposite ends.
void write_equations(const MeshToWrite& file, StagedFolder& staged) {
  constexpr int temperature = 11;
  const auto images = images_of(file.mesh);
  TextFile out(staged.add(file.name.stem().string() + std::string(equations_ending)));
  out.add("** ", file.title,
          "\n** Equal temperatures at opposite ends of periods; for displacements take 1, 2 "
          "and 3 in place of 11.\n");
  for (const auto& [image, first] : images)
    out.add("*EQUATION\n2\n", image + 1, ", ", temperature, ", 1., ", first + 1, ", ", temperature,
            ", -1.\n");
  out.close();
}

std::string write_mesh_for_abaqus(const MeshToWrite& file, StagedFolder& staged) {
  const VolumeMesh& mesh = file.mesh;
  TextFile out(staged.add(file.name.string()));
  out.add("*HEADING\n", file.title, "; lengths in ", file.unit, "\n*NODE, NSET=all\n");
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    const Vector<3>& p = mesh.node(i);
    out.add(i + 1, fmt::format(", {:.{}g}, {:.{}g}, {:.{}g}\n", p[0], digits, p[1], digits, p[2], digits));
  }
  add_volumes(file, out);
  add_surfaces(file, out);
  out.close();
  const std::string note =
      fmt::format("{}: ELSET a region, NSET and SURFACE a patch", mesh.is_curved() ? "C3D10" : "C3D4");
  const bool is_periodic =
      std::ranges::any_of(mesh.periodic, [](const auto& pairs) { return !pairs.empty(); });
  if (!is_periodic) return note;
  write_equations(file, staged);
  return note + "; equations of periods in a file of their own, for *INCLUDE";
}

}  // namespace

MeshWriter abaqus_of_mesh() {
  return {.format = {"abaqus", "Abaqus and CalculiX: C3D4 or C3D10, sets and surfaces, equations of periods",
                     ".inp"},
          .beside = equations_ending,
          .write = write_mesh_for_abaqus};
}

}  // namespace bernal
