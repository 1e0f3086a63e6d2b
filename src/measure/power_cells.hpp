#pragma once
#include <cstdint>
#include <functional>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "measure/convex_cell.hpp"

namespace bernal {

/// Of what the cells of a power diagram fill: a box whose axes end or repeat themselves.
struct CellBox {
  int dimension = 3;  ///< in two the cells are prisms of height 1 on the plane z = 0, whose volumes are areas
  Bounds<3> bounds;   ///< along axes with a period not looked at
  Boundary<3> boundary;
  /// May cut off beforehand what nobody asks for of the cell about `center`.
  std::function<void(const Vector<3>& center, ConvexCell&)> trim = {};
};

/// Takes the cell of a sphere, which may be empty, in coordinates about its centre in the period.
using VisitCell = std::function<void(std::uint32_t sphere, const Vector<3>& center, const ConvexCell&)>;

/// Calls visit(…) once for the cell of every sphere in the power diagram, or of so many where there are more,
/// evenly spread, from several threads and in any order, with the same cells for any number of threads. Of
/// spheres with the same centre and radius the first has the cell.
///
/// Each cell is cut by the planes between its sphere and the others, the nearest first, out of a tree of
/// boxes whose largest radius says how near a plane with one of its spheres may come: until none that is left
/// comes as near as the farthest corner. What a plane would take off within a rounding of a corner stays.
/// Along an axis with a period one period more on either side holds the nearest image of every sphere to
/// every corner. Cost: see `local_packing`. Precondition: coordinates near 1.
void for_each_power_cell(const Spheres<3>&, const CellBox&, std::size_t most, const VisitCell& visit);

}  // namespace bernal
