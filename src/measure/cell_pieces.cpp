#include "measure/cell_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace bernal {
namespace {

void take_polyhedron(const ConvexCell& cell, CellPiece& piece) {
  piece.corners.assign(cell.corners().begin(), cell.corners().end());
  piece.faces.reserve(piece.corners.size() / 2 + 2);
  piece.loops.reserve(3 * piece.corners.size());
  cell.for_each_face([&](ConvexCell::Label label, std::span<const std::uint32_t> loop) {
    piece.faces.push_back(
        {label, static_cast<std::uint32_t>(piece.loops.size()), static_cast<std::uint32_t>(loop.size())});
    piece.loops.insert(piece.loops.end(), loop.begin(), loop.end());
  });
}

/// The polygon that a prism stands on.
void take_polygon(const ConvexCell& cell, CellPiece& piece) {
  std::vector<std::uint32_t> outline;
  std::map<std::pair<std::uint32_t, std::uint32_t>, ConvexCell::Label>
      label_of;  // of a side, as the face runs
  cell.for_each_face([&](ConvexCell::Label label, std::span<const std::uint32_t> loop) {
    if (label == below_plane) outline.assign(loop.rbegin(), loop.rend());
    if (label == below_plane || label == above_plane) return;
    for (std::size_t k = 0; k < loop.size(); ++k) label_of[{loop[k], loop[(k + 1) % loop.size()]}] = label;
  });
  for (std::uint32_t k = 0; k < outline.size(); ++k) {
    const std::uint32_t from = outline[k], next = (k + 1) % static_cast<std::uint32_t>(outline.size());
    Vector<3> corner = cell.corners()[from];
    corner[2] = 0;
    piece.corners.push_back(corner);
    piece.faces.push_back({label_of[{from, outline[next]}], 2 * k, 2});
    piece.loops.insert(piece.loops.end(), {k, next});
  }
}

void take(const ConvexCell& cell, int dimension, CellPiece& piece) {
  if (!(cell.volume() > 0)) return;
  if (dimension == 2)
    take_polygon(cell, piece);
  else
    take_polyhedron(cell, piece);
  for (const Vector<3>& corner : piece.corners) piece.reach = std::max(piece.reach, corner.norm());
}

}  // namespace

std::vector<CellPiece> cell_pieces(const Spheres<3>& spheres, const Boundary<3>& boundary,
                                   const FlatWalls& walls) {
  std::vector<CellPiece> pieces(spheres.size());
  CellBox box{walls.dimension, walls.around, boundary};
  if (!walls.are_of_box)
    box.trim = [&](const Vector<3>& center, ConvexCell& cell) { walls.cut_by_nearest(cell, center); };
  for_each_power_cell(spheres, box, spheres.size(),
                      [&](std::uint32_t i, const Vector<3>& center, const ConvexCell& cell) {
                        CellPiece& piece = pieces[i];
                        piece.center = center;
                        if (cell.empty()) return;
                        if (walls.are_of_box) return take(cell, walls.dimension, piece);
                        ConvexCell cut = cell;
                        walls.cut(cut, center);
                        if (!cut.empty()) take(cut, walls.dimension, piece);
                      });
  return pieces;
}

}  // namespace bernal
