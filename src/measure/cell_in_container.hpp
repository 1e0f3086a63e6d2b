#pragma once
#include <memory>
#include <optional>

#include "bernal/domain/container.hpp"
#include "measure/convex_cell.hpp"
#include "measure/wall_polygons.hpp"

namespace bernal {

/// The volume of a cell inside a container of two or three dimensions, to rounding: between round walls in
/// closed form, see `volume_inside`; in a mesh or polygon a cell inside a ball that lies in the container
/// counts whole, and any other is cut along the walls, see `WallPolygons`; a solid of revolution is taken for
/// one with many flat sides there, of the same volume.
class CellInContainer {
 public:
  /// The domain is the one that the container was made from; both must outlive this. Precondition: no box and
  /// no inset.
  CellInContainer(const Domain&, const Container&);

  /// Those in which all of it lies: the flat sides of a solid of revolution reach out of its own.
  Bounds<3> bounds() const { return container_.bounds(); }

  /// Cuts off parts that are certainly outside, if that is cheap, to reduce the work.
  void trim(ConvexCell& cell, const Vector<3>& center) const;

  /// Volume (area in two dimensions). The cell is in coordinates about `center`. Cost: one clearance for a
  /// cell far from walls, some µs for one at a round wall.
  double volume(const ConvexCell& cell, const Vector<3>& center) const;

 private:
  double volume_between_facets(const ConvexCell& cell, const Vector<3>& center) const;

  const Domain& domain_;
  std::unique_ptr<const Container> flat_sided_;  ///< in place of a solid of revolution
  const Container& container_;
  std::optional<WallPolygons> polygons_;
};

}  // namespace bernal
