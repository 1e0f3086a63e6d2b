#pragma once
#include <optional>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// The hollow of a thick-walled part that is open to the outside, such as a bucket, a pipe or a funnel.
struct Hollow {
  Mesh walls;                   ///< closed, outward: the inner side of the part and a lid on each opening
  double volume = 0;            ///< enclosed by the walls
  double openness = 0;          ///< area of the lids over that of the inner side
  double folded = 0;            ///< share of the inner side with more of it on its back, across a wall
  std::vector<Vector<3>> lids;  ///< their centres
  bool is_flat = true;          ///< each lid is planar

  /// Significance of a hollow: a vessel's is large and nearly closed, a dent is wide open, a bolt hole is
  /// small.
  double weight() const { return volume * (1 / openness - 1); }
};

/// The open hollows of a solid, the one with the largest weight first.
///
/// A face looks out if the ray along its normal leaves the convex hull of its piece within a `reach`. The
/// other faces form connected sides, each bounded by loops of edges: along a brim the loop runs where the
/// surface turns from the outside to the inside. A lid closes each loop, in its plane if it is planar. A side
/// with its lids is a hollow if together they are closed, cross the solid nowhere, and enclose what is
/// outside of it; so no wall is ever taken for a hollow. A brim that is uneven or set back needs a larger
/// reach; reaches from a few `tolerance` (the error of the corners) up to a share of the piece's diagonal are
/// tried, and the smallest counts that keeps both sides of a wall out of one hollow as well as any.
///
/// Orientation does not matter; pieces inside a hollow are walls of it. `least`: pieces whose hulls show that
/// all their hollows are smaller than this multiple of what the piece itself encloses are skipped. `widest`:
/// openings beyond this `openness` make no hollow. Precondition: closed. Throws Error{bad_mesh} for more than
/// 2,000 pieces. Cost: O(T log T), 1 µs a face for each reach, and 20 µs for each face near a lid.
std::vector<Hollow> hollows_of(const Mesh& solid, double tolerance, double least = 0, double widest = 0.95);

/// The hollow of a solid that is probably the wall around it: it is at least as large as the solid, with
/// openings no wider than a dish's, or three times as large, as in a short pipe. Absent if the solid is no
/// such shell. Precondition: closed.
std::optional<Hollow> hollow_of_shell(const Mesh& solid, double tolerance);

}  // namespace bernal::cad
