#pragma once
#include <optional>

#include "bernal/domain/container.hpp"
#include "measure/convex_cell.hpp"
#include "measure/wall_polygons.hpp"

namespace bernal {

/// How much of a cell lies in a container of two or three dimensions.
///
/// A cell that a ball in the container holds is all inside. Another one is cut along the walls of a mesh or a
/// polygon, see `WallPolygons`. Between round walls, and those with an inset, it is divided into triangles or
/// tetrahedra, and these are halved across their longest edges until the clearances at their corners, being
/// 1-Lipschitz, say that all or nothing is inside; or until clearance between them is linear to within a
/// small part of the cell's length, or they are small: then the share where its linear interpolant is
/// positive counts.
class CellInContainer {
 public:
  /// The domain is that which the container was made from; both outlive this.
  CellInContainer(const Domain&, const Container&);

  /// Volume, in two dimensions area. The cell is in coordinates about `center`. Cost: one clearance for a
  /// cell that is far from walls, some hundreds for one at a round wall.
  double volume(const ConvexCell& cell, const Vector<3>& center) const;

 private:
  template <int N>
  double volume_of_parts(const ConvexCell& cell, const Vector<3>& center, double length) const;

  const Container& container_;
  double length_;  ///< of the container: its volume over the area of its walls, in cells that are larger
  std::optional<WallPolygons> polygons_;
};

}  // namespace bernal
