#pragma once
#include "bernal/domain/domain.hpp"
#include "verify/ball.hpp"
#include "verify/box_tree.hpp"
#include "verify/segment.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// The edges of a polygon as a wall.
///
/// Inside is where a ray crosses the edges an odd number of times, which is well defined for any closed
/// lines; that they do not cross each other is a precondition of the polygon but not needed here.
class PolygonWall {
 public:
  /// Throws Error{bad_argument} unless there are corners and all of them are finite.
  explicit PolygonWall(const Polygon& polygon);

  /// Tests the disc against the near edges and decides the side of its centre; counts both. `least`: see
  /// Walls.
  WallState wall_state_of(const Ball<2>& ball, const CertifyOptions& options, double least,
                          Tally& tally) const;

 private:
  static std::vector<PlaneEdge> edges_of(const Polygon& polygon);
  /// In double, to a few roundoffs; infinity where it is not below `below`.
  double distance_from(const Vector<2>& p, double below, double largest) const;
  bool center_inside(const Ball<2>& ball, Arithmetic arithmetic, Tally& tally) const;

  BoxTree<PlaneEdge, 2> edges_;
};

}  // namespace bernal::verify
