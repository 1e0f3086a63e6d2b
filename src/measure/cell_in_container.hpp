#pragma once
#include <optional>

#include "bernal/domain/container.hpp"
#include "measure/convex_cell.hpp"
#include "measure/wall_polygons.hpp"

namespace bernal {

/// How much of a cell lies in a container of two or three dimensions, to rounding: between round walls in
/// closed form, see `volume_inside`; of a mesh or a polygon a cell that a ball in the container holds is all
/// inside, and another one is cut along the walls, see `WallPolygons`.
class CellInContainer {
 public:
  /// The domain is that which the container was made from; both outlive this. Precondition: no box and no
  /// inset.
  CellInContainer(const Domain&, const Container&);

  /// Cuts off what is outside in any case, where that is at hand, so that the cell is less work.
  void trim(ConvexCell& cell, const Vector<3>& center) const;

  /// Volume, in two dimensions area. The cell is in coordinates about `center`. Cost: one clearance for a
  /// cell that is far from walls, some µs for one at a round wall.
  double volume(const ConvexCell& cell, const Vector<3>& center) const;

 private:
  double volume_between_facets(const ConvexCell& cell, const Vector<3>& center) const;

  const Domain& domain_;
  const Container& container_;
  std::optional<WallPolygons> polygons_;
};

}  // namespace bernal
