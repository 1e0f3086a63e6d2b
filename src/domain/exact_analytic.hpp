#pragma once
#include "bernal/domain/domain.hpp"

namespace bernal {

// Whether the closed ball of radius r >= 0 about c lies in the shape, decided in rational arithmetic on the
// doubles as they are: no rounding, no square root. Cost: some microseconds.

/// lower_k <= c_k - r and c_k + r <= upper_k on every axis that has walls.
bool contains_exactly(const Box&, const Vector<3>& c, double r);

/// With w = c - base and s = w·axis, the axis of any length: s >= r·|axis|, s <= (height - r)·|axis| and
/// |w|²·|axis|² - s² <= (radius - r)²·|axis|², the first two compared by sign and
/// square, and left out for a cylinder that repeats itself.
bool contains_exactly(const Cylinder&, const Vector<3>& c, double r);

/// |c - center|² <= (radius - r)² and r <= radius.
bool contains_exactly(const Sphere&, const Vector<3>& c, double r);

}  // namespace bernal
