#include <fmt/format.h>

#include "cells/cell_file.hpp"
#include "cells/placed_cells.hpp"
#include "cells/vtk_appended.hpp"
#include "files/output_file.hpp"

namespace bernal {
namespace {

/// Cell types of VTK.
constexpr std::uint8_t polygon_type = 7, polyhedron_type = 42;

/// The arrays of VTK's unstructured grid.
struct Grid {
  std::vector<double> points;
  std::vector<std::int64_t> connectivity, offsets, faces, face_offsets;
  std::vector<std::uint8_t> types;
  std::vector<std::int64_t> id, neighbours, face_count;
  std::vector<double> volume, radius, sphericity;
};

/// The nodes of a polygon in their order: sides are in theirs.
void add_polygon(const PlacedCells& placed, const std::vector<std::int64_t>& sides, Grid& grid) {
  for (const std::int64_t side : sides) {
    const PlacedCells::Face& face = placed.faces[static_cast<std::size_t>(std::abs(side) - 1)];
    grid.connectivity.push_back(side > 0 ? face.nodes[0] : face.nodes[1]);
  }
  grid.offsets.push_back(static_cast<std::int64_t>(grid.connectivity.size()));
  grid.types.push_back(polygon_type);
}

/// `seen` says of every node for which cell it was listed last.
void add_polyhedron(const PlacedCells& placed, const std::vector<std::int64_t>& sides,
                    std::vector<std::int64_t>& seen, Grid& grid) {
  const auto cell = static_cast<std::int64_t>(grid.types.size());
  grid.faces.push_back(static_cast<std::int64_t>(sides.size()));
  for (const std::int64_t side : sides) {
    const std::vector<std::uint32_t>& nodes =
        placed.faces[static_cast<std::size_t>(std::abs(side) - 1)].nodes;
    grid.faces.push_back(static_cast<std::int64_t>(nodes.size()));
    if (side > 0)
      grid.faces.insert(grid.faces.end(), nodes.begin(), nodes.end());
    else
      grid.faces.insert(grid.faces.end(), nodes.rbegin(), nodes.rend());
    for (const std::uint32_t node : nodes) {
      if (seen[node] == cell) continue;
      seen[node] = cell;
      grid.connectivity.push_back(node);
    }
  }
  grid.offsets.push_back(static_cast<std::int64_t>(grid.connectivity.size()));
  grid.face_offsets.push_back(static_cast<std::int64_t>(grid.faces.size()));
  grid.types.push_back(polyhedron_type);
}

Grid grid_of(const CellFile& file) {
  const PlacedCells cells = placed(file.cells);
  Grid grid;
  for (const Vector<3>& p : cells.nodes) grid.points.insert(grid.points.end(), {p[0], p[1], p[2]});
  std::vector<std::int64_t> seen(cells.nodes.size(), -1);
  for (std::size_t i = 0; i < file.cells.size(); ++i) {
    if (cells.faces_of_cell[i].empty()) continue;
    if (file.cells.dimension == 2)
      add_polygon(cells, cells.faces_of_cell[i], grid);
    else
      add_polyhedron(cells, cells.faces_of_cell[i], seen, grid);
    const CellShape& shape = file.shapes[i];
    grid.id.push_back(static_cast<std::int64_t>(i));
    grid.neighbours.push_back(shape.neighbours);
    grid.face_count.push_back(shape.faces);
    grid.volume.push_back(shape.volume);
    grid.radius.push_back(file.packing.spheres.r[i]);
    grid.sphericity.push_back(shape.sphericity);
  }
  return grid;
}

std::string write_vtu(const CellFile& file, StagedFolder& staged) {
  const Grid grid = grid_of(file);
  const bool flat = file.cells.dimension == 2;
  VtkAppended data;
  std::string text = vtu_head(file.title(), file.unit(), grid.points.size() / 3, grid.types.size());
  text += data.tag("Float64", "Points", grid.points, 3) + "      </Points>\n      <Cells>\n";
  text += data.tag("Int64", "connectivity", grid.connectivity);
  text += data.tag("Int64", "offsets", grid.offsets);
  text += data.tag("UInt8", "types", grid.types);
  if (!flat) {
    text += data.tag("Int64", "faces", grid.faces);
    text += data.tag("Int64", "faceoffsets", grid.face_offsets);
  }
  text += "      </Cells>\n      <CellData Scalars=\"volume\">\n";
  text += data.tag("Int64", "id", grid.id);
  text += data.tag("Float64", "volume", grid.volume);
  text += data.tag("Int64", "faces", grid.face_count);
  text += data.tag("Int64", "neighbours", grid.neighbours);
  text += data.tag("Float64", "radius", grid.radius);
  text += data.tag("Float64", "sphericity", grid.sphericity);
  text += R"(      </CellData>
    </Piece>
  </UnstructuredGrid>
)";
  OutputFile out(staged.add(file.name.string()));
  out.append(text);
  data.append_to(out);
  out.close();
  return fmt::format("; with id, volume, faces, neighbours, radius and sphericity; lengths in {}",
                     file.unit());
}

}  // namespace

CellWriter vtu_of_cells() {
  return {
      .format = {"vtu", "ParaView and VTK: polyhedra, each with id, volume and numbers of faces", ".vtu", 2},
      .write = write_vtu};
}

}  // namespace bernal
