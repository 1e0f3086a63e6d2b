#pragma once
#include <vector>

#include "bernal/domain/domain.hpp"
#include "bernal/measure/cells.hpp"
#include "measure/convex_cell.hpp"

namespace bernal {

/// The walls of a convex domain as planes.
struct FlatWalls {
  std::vector<Cells::Wall> walls;
  double deviation = 0;     ///< from round ones
  Bounds<3> around;         ///< the box, else larger than the domain on all sides
  bool are_of_box = false;  ///< so that the bounds have them already, with their labels
  int dimension = 3;

  /// Cuts a cell about `center` by the wall that is nearest to the centre, which leaves less for others to
  /// cut; by all that it reaches. Labels are `label_of_wall`.
  void cut_by_nearest(ConvexCell& cell, const Vector<3>& center) const;
  void cut(ConvexCell& cell, const Vector<3>& center) const;
};

/// As labels of faces.
constexpr ConvexCell::Label label_of_wall(std::size_t wall) {
  return -1 - static_cast<ConvexCell::Label>(wall);
}

/// Of a box those along the axes that do not repeat themselves. Throws Error{bad_argument} for a domain that
/// is not convex. Cost: of a mesh O(T log T), and corners times flat walls.
FlatWalls flat_walls_of(const Domain&, int sides);

}  // namespace bernal
