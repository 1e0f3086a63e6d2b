#pragma once
#include <span>

#include "bernal/predict/predict.hpp"

namespace bernal::predict {

/// The fraction of the line covered by rods that are placed one by one, from the longest to the shortest, at
/// the end of the largest gap. The gaps between a rod and its smaller neighbour are at least `gap_factor`
/// times the smaller; if the largest gap is too small for that the line grows. Precondition: descending
/// positive lengths, at least one. Cost: O(n log n) at worst; 5 ns a rod if few gaps hold more than one.
double covered_fraction(std::span<const double> descending_lengths, double gap_factor = rod_gap_factor);

}  // namespace bernal::predict
