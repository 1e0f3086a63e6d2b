#include <fmt/format.h>

#include "cells/cell_file.hpp"
#include "cells/placed_cells.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

template <class Nodes>
void add_face(TextFile& out, const Nodes& nodes) {
  out.add("f");
  for (const std::uint32_t node : nodes) out.add(" ", node + 1);
  out.add("\n");
}

std::string write_obj(const CellFile& file, StagedFolder& staged) {
  const PlacedCells cells = placed(file.cells);
  TextFile out(staged.add(file.name.string()));
  out.add("# ", file.title(), "; lengths in ", file.unit(), "; a group a cell, faces outwards\n");
  for (const Vector<3>& p : cells.nodes) out.add("v ", p[0], " ", p[1], " ", p[2], "\n");
  for (std::size_t i = 0; i < file.cells.size(); ++i) {
    if (cells.faces_of_cell[i].empty()) continue;
    out.add("g cell_", i, "\n");
    std::vector<std::uint32_t> outline;
    for (const std::int64_t side : cells.faces_of_cell[i]) {
      const std::vector<std::uint32_t>& nodes =
          cells.faces[static_cast<std::size_t>(std::abs(side) - 1)].nodes;
      if (file.cells.dimension == 2)
        outline.push_back(side > 0 ? nodes[0] : nodes[1]);
      else if (side > 0)
        add_face(out, nodes);
      else
        add_face(out, std::vector<std::uint32_t>(nodes.rbegin(), nodes.rend()));
    }
    if (!outline.empty()) add_face(out, outline);
  }
  out.close();
  return fmt::format("; a group for each, named after its sphere, counted from 0; lengths in {}",
                     file.unit());
}

}  // namespace

CellWriter obj_of_cells() {
  return {.format = {"obj", "Wavefront OBJ, for Blender and others: a group for each cell", ".obj", 2},
          .write = write_obj};
}

}  // namespace bernal
