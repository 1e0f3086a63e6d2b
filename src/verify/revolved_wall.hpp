#pragma once
#include "bernal/domain/domain.hpp"
#include "verify/ball.hpp"
#include "verify/box_tree.hpp"
#include "verify/segment.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// The edges of a profile that turns about an axis as a wall. In the half plane through the axis and a ball's
/// centre the wall is the profile itself: the ball clears it where the disc about (r, z) clears its edges.
class RevolvedWall {
 public:
  /// Throws Error{bad_argument} unless axis and base are finite, the axis is not zero, and there are corners,
  /// all of them finite and none beyond the axis. Keeps a reference.
  explicit RevolvedWall(const Revolved& solid);

  /// Tests the ball against the near edges and decides the side of its centre; counts both.
  WallState wall_state_of(const Ball<3>& ball, const CertifyOptions& options, double least,
                          Tally& tally) const;

 private:
  static std::vector<PlaneEdge> edges_of(const Revolved& solid);
  double distance_from_nearest(const Vector<2>& place, const Box<2>& around, double first) const;
  bool center_inside(const Ball<3>& ball, const Box<2>& place, Arithmetic arithmetic, Tally& tally) const;

  const Revolved& solid_;
  Vector<3> unit_axis_;
  double extent_ = 0;
  BoxTree<PlaneEdge, 2> edges_;
};

}  // namespace bernal::verify
