#pragma once
#include <span>

#include "hard/wall.hpp"

namespace bernal {

struct LargestSphere {
  Vector<3> center;
  double radius;
};

/// The largest sphere in the region between planes, which lies within `bounds`: the linear programme
///   maximise r  subject to  n·c + r <= o  for every plane
/// in four variables, the centre c, which is that of Chebyshev, and r. Planes come one after the other in a
/// random order; one that leaves the best sphere so far outside is touched by the next best, which is the
/// same programme with a variable less.
///
/// The radius is the clearance of the centre, so that this sphere fits; no other is larger by more than some
/// hundred roundoffs of the bounds. Below 0 where nothing is between the planes. Precondition: no wall is
/// round. Cost: O(planes), expected, about 0.2 µs each.
/// Source: Seidel, Discrete Comput. Geom. 6, 423 (1991).
LargestSphere largest_sphere_between(std::span<const Wall<3>> planes, const Bounds<3>& bounds);

}  // namespace bernal
