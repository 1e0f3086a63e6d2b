#pragma once
#include "bernal/domain/container.hpp"
#include "measure/convex_cell.hpp"

namespace bernal {

/// How much of a cell lies in a container of two or three dimensions.
///
/// A cell that a ball in the container holds is all inside. Another one is divided into triangles or
/// tetrahedra, and these are halved across their longest edges until the clearances at their corners, being
/// 1-Lipschitz, say that all or nothing is inside; or until clearance between them is linear to within a
/// small part of `length`, or they are small: then the share where its linear interpolant is positive counts,
/// which between flat walls is exact.
class CellInContainer {
 public:
  /// `length`: of the container's volume over the area of its walls; no more precise is what is found in
  /// cells that are larger.
  CellInContainer(const Container& container, double length) : container_(container), length_(length) {}

  /// Volume, in two dimensions area. The cell is in coordinates about `center`. Cost: one clearance for a
  /// cell that is far from walls, some hundreds for one at a wall.
  double volume(const ConvexCell& cell, const Vector<3>& center) const;

 private:
  template <int N>
  double volume_of_parts(const ConvexCell& cell, const Vector<3>& center, double length) const;

  const Container& container_;
  double length_;
};

}  // namespace bernal
