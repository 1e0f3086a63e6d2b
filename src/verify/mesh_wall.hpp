#pragma once
#include <cstdint>

#include "bernal/domain/domain.hpp"
#include "verify/ball.hpp"
#include "verify/predicates.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// In double, to a few roundoffs of the triangle's size.
double distance_from_triangle(const Vector<3>& p, const Corners& corners);

/// The triangles of a mesh as a wall.
///
/// Inside is where the winding number is 1. That is well defined because the surface has no boundary: for any
/// two points as many edges run from a to b as from b to a, which the constructor checks. It is a
/// precondition that the mesh faces outwards and does not intersect itself (see Mesh).
///
/// With exact corners that are not doubles (see ExactCorners), all lengths are multiplied by `scale`: then
/// corners and centres are sums of two doubles, and radii exact products.
class MeshWall {
 public:
  /// Keeps a reference to the mesh. Throws Error{bad_mesh} unless it has triangles, finite vertices, valid
  /// indices, exact corners that match its vertices, and no boundary.
  explicit MeshWall(const Mesh& mesh);

  /// Tests the ball against the near triangles and decides the side of its centre; counts both. `least`: see
  /// Walls.
  WallState wall_state_of(const Ball<3>& ball, const CertifyOptions& options, double least,
                          Tally& tally) const;

  /// Whether the mesh winds around the centre once. Exact.
  bool center_inside(const Ball<3>& ball, Arithmetic arithmetic, Tally& tally) const;
  /// In double, to a few roundoffs; infinity where it is not below `below`.
  double distance_from(const Vector<3>& p, double below = Box<3>::infinity) const;
  /// Whether all triangles are, in double and by a billionth more.
  bool is_farther_than(const Vector<3>& p, double distance) const;

 private:
  struct Facet {
    Box<3> extent;
    std::uint32_t triangle;

    Box<3> box() const { return extent; }
    double center(int axis) const { return 0.5 * extent.lower[axis] + 0.5 * extent.upper[axis]; }
  };

  Corners corners(const Facet& facet) const;
  CornersOf<WidePoint> exact_corners(const Facet& facet) const;
  static std::vector<Facet> facets_of(const Mesh& mesh);
  Truth clears(const Ball<3>& ball, const Reach& reach, const Facet& facet, Arithmetic arithmetic,
               Tally& tally) const;

  const Mesh& mesh_;
  BoxTree<Facet, 3> facets_;
  double largest_;
};

}  // namespace bernal::verify
