#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "bernal/core/vector.hpp"
#include "cad/triangle_tree.hpp"

namespace bernal::cad {

enum class Side : std::uint8_t { inside, wall, outside };

/// What is known of a point's clearance without asking the tree.
struct ClearanceBounds {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();

  bool inside() const { return lower > 0; }
  bool outside() const { return upper < 0; }
};

/// The clearance at the centres of up to 32³ cubes that cover the mesh. Clearance is 1-Lipschitz, so
/// each of them bounds it everywhere: most points of a container, and nearly all that insertion tries, are
/// decided by one look.
///
/// The bounds are proven: sides are decided exactly, distances are known to a fiftieth of a cube, which saves
/// most of the search in the middle of round parts, and bounds are widened by that and by a millionth of a
/// cube, which is far more than rounding takes. Cost: building, one rough nearest search a cube; a look, 5
/// ns. The tree must outlive the field.
class ClearanceField {
 public:
  ClearanceField(const TriangleTree& tree, const Bounds<3>& bounds);

  ClearanceBounds at(const Vector<3>& p) const;

  /// On which side of the wall p is, exactly: walks from p along the axes to a cube next to it whose side is
  /// known, or to the centre of its own, and counts the crossings of the wall on that way, which is short.
  Side side(const Vector<3>& p) const;

 private:
  using Cell = std::array<int, 3>;
  Side side_by_centre(const Vector<3>& p) const;
  /// Precondition: p is in the bounds.
  Cell cell_of(const Vector<3>& p) const;
  std::size_t index(const Cell& c) const {
    return (static_cast<std::size_t>(c[2]) * count_[1] + c[1]) * count_[0] + c[0];
  }
  Vector<3> center_of(int x, int y, int z) const {
    return lower_ + edge_ * (Vector<3>(x, y, z) + Vector<3>::Constant(0.5));
  }

  const TriangleTree& tree_;
  Vector<3> lower_, upper_;
  double edge_ = 0, per_edge_ = 0;
  Cell count_ = {0, 0, 0};
  std::vector<double> clearance_;
};

}  // namespace bernal::cad
