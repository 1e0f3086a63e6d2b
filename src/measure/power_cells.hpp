#pragma once
#include <array>
#include <cstdint>
#include <functional>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "measure/convex_cell.hpp"

namespace bernal {

/// The box that the cells of a power diagram fill, with open or periodic axes.
struct CellBox {
  int dimension = 3;  ///< in two, cells are prisms of height 1 on the plane z = 0, whose volumes are areas
  Bounds<3> bounds;   ///< ignored along periodic axes
  Boundary<3> boundary;
  /// If set, cuts off unneeded parts of the cell about `center` beforehand.
  std::function<void(const Vector<3>& center, ConvexCell&)> trim = {};
};

/// Whose cell is behind a face: that of a sphere, moved by so many periods along each axis.
struct CellNeighbour {
  std::uint32_t sphere;
  std::array<int, 3> image;  ///< -1, 0 or 1 along periodic axes, counted between the centres in the period
};
/// What the label of a face means. Precondition: it is not negative. Those of the walls of the box are -1 to
/// -6: below and above along x, then along y and z.
CellNeighbour neighbour_of(ConvexCell::Label label);
ConvexCell::Label label_of(const CellNeighbour&);
/// The labels of the ends of prisms in two dimensions.
inline constexpr ConvexCell::Label below_plane = -(ConvexCell::Label{1} << 40), above_plane = below_plane - 1;

/// Receives the cell of a sphere, possibly empty, in coordinates about its centre in the period.
using VisitCell = std::function<void(std::uint32_t sphere, const Vector<3>& center, const ConvexCell&)>;

/// Calls visit(…) once for the cell of every sphere in the power diagram, or for `most` of them, evenly
/// spread, if there are more; from several threads and in any order, with the same cells for any number of
/// threads. Of spheres with equal centre and radius the first has the cell.
///
/// Each cell is cut by the planes between its sphere and the others, the nearest first. A tree of boxes, each
/// with its largest radius, bounds how near a plane of its spheres may be; the search ends when no remaining
/// plane can reach the farthest corner. A cut within rounding of a corner is skipped. Along a periodic axis
/// one more period on either side contains the nearest image of every sphere to every corner. Cost: see
/// `local_packing`. Precondition: coordinates near 1.
void for_each_power_cell(const Spheres<3>&, const CellBox&, std::size_t most, const VisitCell& visit);

}  // namespace bernal
