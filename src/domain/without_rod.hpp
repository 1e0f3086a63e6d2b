#pragma once
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// What a rod about the axis, r <= radius and from <= z <= to, leaves of the profile of a solid of
/// revolution, whose corners are (r, z): a profile again, in the same order. Nothing where the rod takes
/// nothing out or leaves nothing, or where the rest is in several pieces or reaches the rod's side in several
/// places. Cost: O(corners).
std::vector<Vector<2>> without_rod(const std::vector<Vector<2>>& profile, double radius, double from,
                                   double to);

}  // namespace bernal
