#pragma once
#include "bernal/domain/domain.hpp"
#include "core/made.hpp"
#include "geometry/curved_patch.hpp"
#include "verify/mesh_wall.hpp"

namespace bernal::verify {

/// The surface of a CAD file as a wall: see `geometry/curved_patch.hpp` for why it holds.
///
/// A ball is clear of the surface if each of its pieces is: a piece whose corners span a flat triangle, and
/// that bends by e, is no nearer than that triangle by more than e and its slack. Pieces that this does not
/// decide are halved until either a point of the surface is found that is too near, or what is left is less
/// than rounding or the slack: then the ball is refused as well. So what is certified is proven, and what is
/// refused is nearer than its reach, or clears it by less than slack and rounding.
///
/// The side of the centre is that of the triangles, from which it must be farther than the surface may be
/// moved.
class TrueWall {
 public:
  /// Keeps a reference to the mesh. Throws as MeshWall. Preconditions: the mesh has a surface, whose bounds
  /// are set. Cost: some µs a piece, and O(n log n).
  explicit TrueWall(const Mesh& mesh);

  /// The distance of a ball that lies inside is that of the surface in double, off by up to the slack of its
  /// pieces and 1e-8 of the radius, or by a millionth of what a piece bends where that is more. `least`: see
  /// Walls. Cost: O(log n), and for every near piece a few to some thousand points of the surface, most where
  /// a ball and a wall of nearly its own curvature touch.
  WallState wall_state_of(const Ball<3>& ball, const CertifyOptions& options, double least,
                          Tally& tally) const;

 private:
  struct Piece {
    Box<3> extent;
    std::uint32_t number;
    Bending bending;
    double slack;

    Box<3> box() const { return extent; }
    double center(int axis) const { return 0.5 * extent.lower[axis] + 0.5 * extent.upper[axis]; }
  };

  static std::vector<Piece> pieces_of(const TrueSurface&);

  Made made_{"true surface"};
  const TrueSurface& surface_;
  MeshWall triangles_;
  BoxTree<Piece, 3> pieces_;
  double track_ = 0;
};

}  // namespace bernal::verify
