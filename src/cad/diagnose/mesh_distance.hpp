#pragma once
#include <cstdint>

#include "bernal/core/monitor.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// How far the points of one surface are from another at most: max over p in S of min over q in R of |p - q|.
struct Deviation {
  double largest = 0;  ///< that of `place`, so no less is true
  double at_most = 0;  ///< no point of the surface is farther
  Vector<3> place = Vector<3>::Zero();
};

/// How far apart the bounds of a deviation may stay: by `absolute`, or this share of it if that is more, or
/// what the rounding of the coordinates takes.
struct Closeness {
  double absolute;
  double share = 0;
};

/// The one-sided distance of `surface` from `reference`, certified. Faces with all corners on a face of the
/// reference are no distance away. Of the others, the part farthest by its bound is halved, or cut along an
/// edge of the face of the reference that it lies on, until the bounds are as close as asked for, or until
/// `evaluations` distances were taken, or the monitor stops; the bounds hold then too, only farther apart.
/// Bounds of a triangle:
///
///   d(center) + radius of a ball about the center that holds it  (a distance is 1-Lipschitz),
///   max over its corners of d to one triangle of the reference   (that distance is convex).
///
/// Precondition: neither is empty. Cost: two searches in a tree an evaluation, and one evaluation a face that
/// the reference has not got; many where a curved surface is far from the reference everywhere.
Deviation farthest(const Mesh& surface, const Mesh& reference, Closeness, const Monitor& monitor = {},
                   std::uint64_t evaluations = 2'000'000);

}  // namespace bernal::cad
