#include <cmath>

#include <fmt/format.h>

#include "cells/cell_file.hpp"
#include "cells/placed_cells.hpp"
#include "formats/text_file.hpp"

// Source: the Gmsh Reference Manual, "Gmsh scripting language".

namespace bernal {
namespace {

/// Of a cell of mean volume: how long the edges of tetrahedra are at first, over its diameter.
constexpr double size_over_diameter = 0.35;

void write_points(const CellFile& file, const PlacedCells& placed, TextFile& out) {
  double volume = 0;
  for (const CellShape& shape : file.shapes) volume += shape.volume;
  const double size = size_over_diameter * std::cbrt(volume / file.full());
  out.add("SetFactory(\"Built-in\");\nDefineConstant[ size = {", size,
          ", Name \"Parameters/Edge of tetrahedra\"} ];\n"
          "Mesh.MeshSizeExtendFromBoundary = 1;\n");
  for (std::size_t n = 0; n < placed.nodes.size(); ++n) {
    const Vector<3>& p = placed.nodes[n];
    out.add("Point(", n + 1, ") = {", p[0], ", ", p[1], ", ", p[2], ", size};\n");
  }
}

template <class List>
void add_list(TextFile& out, const List& numbers) {
  out.add("{");
  bool is_first = true;
  for (const auto number : numbers) {
    out.add(is_first ? "" : ", ", number);
    is_first = false;
  }
  out.add("}");
}

void write_solids(const CellFile& file, const PlacedCells& placed, TextFile& out) {
  for (std::size_t e = 0; e < placed.edges.size(); ++e)
    out.add("Line(", e + 1, ") = {", placed.edges[e].from + 1, ", ", placed.edges[e].to + 1, "};\n");
  for (std::size_t f = 0; f < placed.faces.size(); ++f) {
    out.add("Curve Loop(", f + 1, ") = ");
    add_list(out, placed.faces[f].edges);
    out.add("; Plane Surface(", f + 1, ") = {", f + 1, "};\n");
  }
  for (std::size_t f = 0; f < placed.faces.size(); ++f) {
    const PlacedCells::Origin& origin = placed.faces[f].origin;
    if (origin.first == f) continue;
    out.add("Periodic Surface {", f + 1, "} = {", origin.first + 1, "} Translate {");
    for (int k = 0; k < 3; ++k)
      out.add(k == 0 ? "" : ", ", origin.image[static_cast<std::size_t>(k)] * file.cells.periods[k]);
    out.add("};\n");
  }
  for (std::size_t i = 0; i < file.cells.size(); ++i) {
    if (placed.faces_of_cell[i].empty()) continue;
    out.add("Surface Loop(", i + 1, ") = ");
    add_list(out, placed.faces_of_cell[i]);
    out.add("; Volume(", i + 1, ") = {", i + 1, "};\nPhysical Volume(\"cell_", i, "\", ", i + 1, ") = {",
            i + 1, "};\n");
  }
}

/// The walls by their names, the faces between cells, and the ends of the period.
void write_surfaces(const CellFile& file, const PlacedCells& placed, TextFile& out) {
  std::vector<std::vector<std::size_t>> of_wall(file.cells.walls.size());
  std::vector<std::size_t> between, ends;
  for (std::size_t f = 0; f < placed.faces.size(); ++f) {
    const PlacedCells::Face& face = placed.faces[f];
    const std::uint32_t wall = file.cells.faces[face.face].wall;
    (wall != Cells::none ? of_wall[wall] : face.other == Cells::none ? ends : between).push_back(f + 1);
  }
  const auto add = [&](const std::string& name, std::size_t number, const std::vector<std::size_t>& faces) {
    if (faces.empty()) return;
    out.add("Physical Surface(\"", name, "\", ", number, ") = ");
    add_list(out, faces);
    out.add(";\n");
  };
  const std::size_t first = file.cells.size() + 1;
  add("between_cells", first, between);
  add("period_ends", first + 1, ends);
  for (std::size_t k = 0; k < of_wall.size(); ++k)
    add("wall_" + file.cells.walls[k].name, first + 2 + k, of_wall[k]);
}

std::string write_geo(const CellFile& file, StagedFolder& staged) {
  const PlacedCells cells = placed(file.cells);
  TextFile out(staged.add(file.name.string()));
  out.add("// ", file.title(), "; lengths in ", file.unit(), "\n");
  write_points(file, cells, out);
  write_solids(file, cells, out);
  write_surfaces(file, cells, out);
  out.close();
  return fmt::format(
      "; a volume and a physical group for each, faces shared; lengths in {}; mesh with: gmsh -3 {}",
      file.unit(), file.name.string());
}

}  // namespace

CellWriter gmsh_of_cells() {
  return {.format = {"gmsh", "Gmsh: a script of solids that share their faces, a physical group for each",
                     ".geo"},
          .write = write_geo};
}

}  // namespace bernal
