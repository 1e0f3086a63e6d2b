#pragma once
#include <cstdint>

#include "bernal/domain/domain.hpp"
#include "verify/ball.hpp"
#include "verify/predicates.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// The triangles of a mesh as a wall.
///
/// Inside is where the winding number is 1. That is well defined because the surface has no boundary: as many
/// edges run from a to b as from b to a, for any two points, which the constructor checks. That the mesh does
/// not intersect itself and faces outwards is its precondition (see Mesh).
///
/// Where the corners are no doubles (see ExactCorners), all lengths are taken `scale` times: so the corners
/// and the centres are sums of two doubles, and the radii exact products.
class MeshWall {
 public:
  /// Keeps a reference to the mesh. Throws Error{bad_mesh} unless it has triangles, only finite vertices,
  /// valid indices, exact corners that are those of its vertices, and no boundary.
  explicit MeshWall(const Mesh& mesh);

  /// Tries the ball against the near triangles and decides the side of its centre; counts both.
  Stand stand_of(const Ball<3>& ball, const CertifyOptions& options, Tally& tally) const;

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
  bool center_inside(const Ball<3>& ball, Arithmetic arithmetic, Tally& tally) const;
  double distance_from(const Vector<3>& p) const;

  const Mesh& mesh_;
  BoxTree<Facet, 3> facets_;
};

}  // namespace bernal::verify
