#pragma once
#include "bernal/report/section.hpp"

namespace bernal {

/// What the plane cuts of the domain's walls, or of those of one period: see `Section::outline`. Empty where
/// it misses them. A plane through corners or along facets counts as lying a hair above, and where
/// nothing is above, a hair below.
std::vector<std::vector<Vector<2>>> section_outline(const Domain&, const SectionPlane&);

/// Signed by the sense in which the line runs around it.
double area_within(const std::vector<Vector<2>>& loop);

/// The area that the disc has in common with what the loop encloses, signed as `area_within` is.
/// Cost: O(points).
double area_within(const std::vector<Vector<2>>& loop, const Vector<2>& center, double radius);

}  // namespace bernal
