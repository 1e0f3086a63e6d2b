#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "measure/flat_walls.hpp"
#include "measure/power_cells.hpp"

namespace bernal {

/// A cell as a polyhedron, or a polygon, of its own.
struct CellPiece {
  struct Face {
    ConvexCell::Label label;
    std::uint32_t first, count;  ///< of `loops`
  };
  Vector<3> center = Vector<3>::Zero();  ///< in the period
  std::vector<Vector<3>> corners = {};
  std::vector<Face> faces = {};           ///< in two dimensions sides, anticlockwise
  std::vector<std::uint32_t> loops = {};  ///< corners of the faces, anticlockwise seen from outside
  double reach = 0;                       ///< the distance of the farthest corner from the centre

  std::span<const std::uint32_t> loop(const Face& face) const {
    return std::span(loops).subspan(face.first, face.count);
  }
};

/// The cells of all spheres, each for itself, in threads. Lengths are near 1, periods those of the boundary.
std::vector<CellPiece> cell_pieces(const Spheres<3>&, const Boundary<3>&, const FlatWalls&);

}  // namespace bernal
