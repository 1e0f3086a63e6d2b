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

/// Bounds on a point's clearance, known without a query of the tree.
struct ClearanceBounds {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();

  bool inside() const { return lower > 0; }
  bool outside() const { return upper < 0; }
};

/// The clearance at the centres of up to 32³ cubes that cover the mesh. As clearance is 1-Lipschitz, each
/// bounds it everywhere: one look-up decides most points of a container, and nearly all that insertion tries.
///
/// The bounds are proven: sides are decided exactly, distances are known to a fiftieth of a cube (which saves
/// most of the search in the middle of round parts), and bounds are widened by that and by a millionth of a
/// cube, far more than rounding. Cost: one rough nearest search a cube to build, 5 ns a look-up. The tree
/// must outlive the field.
class ClearanceField {
 public:
  /// Beyond the bounds is outside, but along the axes that are `open`, where nothing is known of it.
  ClearanceField(const TriangleTree& tree, const Bounds<3>& bounds, const std::array<bool, 3>& open = {});

  ClearanceBounds at(const Vector<3>& p) const;

  /// The side of the wall that p is on, exactly: goes from p along an axis to a neighbouring cube whose side
  /// is known, or to the centre of its own cube, and counts the crossings of the wall on this short path.
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
  std::array<bool, 3> open_;
  double edge_ = 0, per_edge_ = 0;
  Cell count_ = {0, 0, 0};
  std::vector<double> clearance_;
};

}  // namespace bernal::cad
