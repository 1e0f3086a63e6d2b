#pragma once
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// Whether a point lies inside the closed line through these corners, by the even-odd rule; exact.
/// Precondition: finite numbers; the point is not on the line. Cost: O(corners).
bool is_inside(const std::vector<Vector<2>>& line, const Vector<2>& point);

}  // namespace bernal
