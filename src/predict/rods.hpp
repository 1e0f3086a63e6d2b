#pragma once
#include <span>
#include <vector>

#include "bernal/sizes/size_distribution.hpp"

namespace bernal::predict {

/// The lengths of `count` rods in ascending order, in units of the distribution's radii: quantiles
/// F^-1((i - 1/2) / count), i = 1 … count, of the chord lengths (Farr 2013, eqs. 18, 23–25)
///   F(L) = 1 - [m2(L) - L² m0(L)] / m2(0),   mk(L) = ∫_L^∞ r^k dC(r).
std::vector<double> rod_lengths(const SizeDistribution& sizes, int count);

/// The fraction of the line that the rods cover when each, from the longest to the shortest, is put at the
/// end of the largest gap. The gaps beside a rod and its smaller neighbour are never below f times the
/// smaller; where the largest gap is too small for that the line grows. Precondition: ascending positive
/// lengths, at least one.
double covered_fraction(std::span<const double> ascending_lengths);

}  // namespace bernal::predict
