#pragma once
#include <cstdint>

#include "bernal/core/monitor.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// Bounds on the one-sided distance of surface S from R: max over p in S of min over q in R of |p - q|.
struct Deviation {
  double largest = 0;  ///< the distance at `place`, a lower bound
  double at_most = 0;  ///< upper bound for every point of the surface
  Vector<3> place = Vector<3>::Zero();
};

/// When the bounds of a deviation are close enough: within `absolute`, or this share of it, or the rounding
/// of the coordinates, whichever is largest.
struct Closeness {
  double absolute;
  double share = 0;
};

/// The one-sided distance of `surface` from `reference`, certified. Faces whose corners all lie on one face
/// of the reference have distance zero. Of the others, the part with the largest bound is halved, or cut
/// along an edge of the reference face that it lies on, until the bounds are close enough, `evaluations`
/// distances were taken, or the monitor stops; the bounds hold in any case. Bounds of a triangle:
///
///   d(center) + radius of a ball about the center that contains it  (distance is 1-Lipschitz),
///   max over its corners of d to one triangle of the reference      (that distance is convex).
///
/// Precondition: neither is empty. Cost: two tree searches an evaluation, and one evaluation for each face
/// that the reference lacks; many if a curved surface is far from the reference everywhere.
Deviation farthest(const Mesh& surface, const Mesh& reference, Closeness, const Monitor& monitor = {},
                   std::uint64_t evaluations = 2'000'000);

}  // namespace bernal::cad
