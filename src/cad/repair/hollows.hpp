#pragma once
#include <optional>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// The hollow of a thick-walled part that is open to the outside, as a bucket's, a pipe's or a funnel's.
struct Hollow {
  Mesh walls;                   ///< closed, outward: the inner side of the part and a lid on each opening
  double volume = 0;            ///< that they enclose
  double openness = 0;          ///< area of the lids over that of the inner side
  double folded = 0;            ///< share of that side of which the back, across a wall, is of it too
  std::vector<Vector<3>> lids;  ///< their middles
  bool is_flat = true;          ///< each of them lies in a plane

  /// How much of a hollow it is: a vessel's is large and nearly closed, a dent is wide open, a bolt hole is
  /// small.
  double weight() const { return volume * (1 / openness - 1); }
};

/// The open hollows of a solid, the one with the most weight first; none where it has none.
///
/// A face looks out where the way along its normal leaves the convex hull of its piece within a `reach`. The
/// others hang together in sides, each bounded by loops of edges: along a brim the loop runs where the
/// surface turns from the outside to the inside. A lid lies on each loop, in its plane where it has one. Such
/// a side with its lids is a hollow if they close up, cross the solid nowhere, and enclose what is outside of
/// it: so no wall is ever taken for a hollow. A brim that is uneven or set back takes a wider reach, from a
/// few `tolerance`, by which corners may be off, up to some of the piece's diagonal: the least counts that is
/// as good as any in keeping both sides of a wall out of one hollow.
///
/// Orientation does not matter; pieces that stand in a hollow are walls of it.
/// Precondition: closed. Throws Error{bad_mesh} where it has more than 2,000 pieces. Cost: O(T log T) and 1
/// µs a face for each reach, 20 µs for each face near a lid; pieces whose hulls tell that all of their
/// hollows hold less than `least` times what they enclose themselves are passed over.
/// `widest`: an opening beyond this `openness` makes no hollow.
std::vector<Hollow> hollows_of(const Mesh& solid, double tolerance, double least = 0, double widest = 0.95);

/// The hollow of a solid that is rather the wall around it: it holds as much at least, and its openings are
/// no wider than a dish's; or three times as much, as in a short pipe. Nothing where the solid is no such
/// shell. Precondition: as above.
std::optional<Hollow> hollow_of_shell(const Mesh& solid, double tolerance);

}  // namespace bernal::cad
