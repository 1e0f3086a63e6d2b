#pragma once
#include <array>
#include <vector>

#include "bernal/domain/container.hpp"
#include "measure/convex_cell.hpp"
#include "near/box_tree.hpp"

namespace bernal {

/// The walls of a mesh or a polygon, for the volume of convex cells inside them, exact to rounding.
///
/// The walls in a cell are clipped to it; the cell is bisected, with its walls, while they are many, and cut
/// along the plane of the largest wall when they are few, until a part has no walls. Such a part is inside if
/// its middle is.
class WallPolygons {
 public:
  /// Precondition: a mesh or a polygon without an inset, in the coordinates of the container, which must
  /// outlive this. The walls of a polygon are normal to the plane z = 0, as high as cells of two dimensions.
  /// Cost: O(T log T); memory about 150 bytes a triangle.
  WallPolygons(const Domain&, const Container&);

  /// Volume (area in two dimensions) inside of a cell in coordinates about `center`. Cost: 1 to 2 µs a part;
  /// there are a few more parts than walls in the cell.
  double volume_inside(const ConvexCell& cell, const Vector<3>& center) const;

 private:
  struct Wall {
    std::array<Vector<3>, 4> corner;
    int corners;
    Vector<3> normal;
  };
  /// The part of a wall in a cell, in coordinates about its centre.
  struct Piece {
    std::vector<Vector<3>> loop;
    Vector<3> normal;
    double area = 0;
  };

  void add(std::initializer_list<Vector<3>> corners);
  void build();
  std::vector<Piece> pieces_in(const ConvexCell&, const Vector<3>& center, double rounding) const;
  double inside(const ConvexCell&, std::vector<Piece> pieces, const Vector<3>& center, double rounding) const;
  static Piece below(const Piece&, const Vector<3>& normal, double offset, double rounding);

  const Container& container_;
  std::vector<Wall> walls_;  ///< in the order of the tree
  BoxTree<3> tree_;
};

}  // namespace bernal
