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

/// A node at upper ends of periods, the one that it is an image of, and the axes between them.
struct ImageNode {
  std::uint32_t image = 0, first = 0;
  std::array<bool, 3> along = {};
};

/// Every upper node of a period once.
std::vector<ImageNode> images_of(const VolumeMesh& mesh) {
  struct Lower {
    std::uint32_t node;
    std::size_t axis = 3;
  };
  std::vector<Lower> lower_of(mesh.node_count());
  for (std::uint32_t v = 0; v < lower_of.size(); ++v) lower_of[v] = {v};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const auto& [lower, upper] : mesh.periodic[axis]) lower_of[upper] = {lower, axis};
  std::vector<ImageNode> images;
  for (std::uint32_t v = 0; v < lower_of.size(); ++v) {
    ImageNode made{.image = v, .first = v};
    while (lower_of[made.first].node != made.first) {
      made.along[lower_of[made.first].axis] = true;
      made.first = lower_of[made.first].node;
    }
    if (made.first != v) images.push_back(made);
  }
  return images;
}

constexpr std::string_view equations_ending = "_periodic.inc";

/// Its number in the file, after those of the mesh.
std::size_t node_of_period(const VolumeMesh& mesh, std::size_t axis) { return mesh.node_count() + 1 + axis; }

/// Equations for what a user includes. A node of its own for each period holds the difference across it.
void write_equations(const MeshToWrite& file, StagedFolder& staged) {
  constexpr int temperature = 11;
  const VolumeMesh& mesh = file.mesh;
  TextFile out(staged.add(file.name.stem().string() + std::string(equations_ending)));
  out.add(
      "** ", file.title,
      "\n** Temperatures at opposite ends of a period along x differ by that of the node x_period: 0 for a "
      "field that\n** repeats itself, the period's length times the mean gradient for one that rises. Give "
      "it "
      "by *BOUNDARY.\n** For displacements take 1, 2 and 3 in place of 11.\n");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (mesh.periodic[axis].empty()) continue;
    const auto& [low, high] = mesh.periodic[axis].front();
    const Vector<3> period = mesh.node(high) - mesh.node(low);
    out.add("*NODE, NSET=", std::string_view("xyz").substr(axis, 1), "_period\n", node_of_period(mesh, axis),
            ", ", period[0], ", ", period[1], ", ", period[2], "\n");
  }
  for (const ImageNode& node : images_of(mesh)) {
    out.add("*EQUATION\n", 2 + std::ranges::count(node.along, true), "\n", node.image + 1, ", ", temperature,
            ", 1., ", node.first + 1, ", ", temperature, ", -1.");
    int terms = 2;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (node.along[axis])
        out.add(terms++ == 4 ? "\n" : ", ", node_of_period(mesh, axis), ", ", temperature, ", -1.");
    out.add("\n");
  }
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
