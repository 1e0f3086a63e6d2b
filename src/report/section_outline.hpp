#pragma once
#include "bernal/report/section.hpp"

namespace bernal {

/// The cut of a plane through the walls of the domain, or of one period: see `Section::outline`. Empty if the
/// plane misses them. A plane through corners or along facets counts as slightly higher, or slightly lower if
/// nothing is above it.
std::vector<std::vector<Vector<2>>> section_outline(const Domain&, const SectionPlane&);

/// Signed by the loop's orientation.
double area_within(const std::vector<Vector<2>>& loop);

/// The common area of the disc and the inside of the loop, signed like `area_within`. Cost: O(points).
double area_within(const std::vector<Vector<2>>& loop, const Vector<2>& center, double radius);

}  // namespace bernal
