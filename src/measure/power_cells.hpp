#pragma once
#include <cstdint>
#include <functional>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/boundary.hpp"
#include "measure/convex_cell.hpp"

namespace bernal {

/// Of what the cells of a power diagram fill: a box whose axes end or repeat themselves.
struct CellBox {
  int dimension = 3;  ///< in two the cells are prisms of height 1 on the plane z = 0, whose volumes are areas
  Bounds<3> bounds;   ///< along axes with a period not looked at
  Boundary<3> boundary;
};

/// Takes the cell of a sphere, which may be empty, in coordinates about its centre in the period.
using VisitCell = std::function<void(std::uint32_t sphere, const Vector<3>& center, const ConvexCell&)>;

/// Calls visit(…) once for the cell of every sphere in the power diagram, from several threads and in any
/// order, with the same cells for any number of threads. Of spheres with the same centre and radius the first
/// has the cell.
///
/// The spheres are divided into blocks. In each, the regular triangulation of its spheres and of those around
/// it, images among them, says which neighbours a cell has. As what is around ends somewhere, every corner of
/// a cell is then proven: no sphere has less power there than the cell's own. That is so at once where the
/// corner is deep enough among the spheres that were looked at, the largest radius of all granted to those
/// beyond; else the sphere of the least power is asked for, and cuts the cell if it is another one. Along an
/// axis with a period one period more on either side holds the nearest image of every sphere to every corner.
/// Cost: see `local_packing`. Precondition: coordinates near 1.
void for_each_power_cell(const Spheres<3>&, const CellBox&, const VisitCell& visit);

}  // namespace bernal
