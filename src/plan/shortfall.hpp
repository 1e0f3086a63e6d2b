#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// A periodic box that was to be packed as closely as spheres come to lie at random, and was not.
struct Shortfall {
  double below = 0;  ///< packing fraction that is missing
  /// By more than the model can be wrong, and more than the chance of few spheres: it is not what was asked.
  bool is_loose = false;
  std::string reason = {};  ///< what is missing, of what, and why: a clause
};

/// Whether a packing of n spheres that lacks so much of the packing fraction to be expected of it is loose.
bool is_loose(double below, double expected, std::uint64_t n);

/// Random close packing of the very sizes that are there, in a periodic box of two to six dimensions; of
/// other than three that of equal spheres, and between walls, in two and three, less what these cost. Nothing
/// elsewhere. Where the scene asks for gaps, of spheres with half of them around. Cost: O(N log N), and some
/// milliseconds.
std::optional<double> expected_of_sizes(const Packing& packing);

/// Holds a packing against the least of what it was to reach: `packing.expected_of_sizes`; the packing
/// fraction that is asked for, or that the count has in the box of given size; what the stages reach of
/// themselves, as relaxation from a loose start does; and what a start had, which relaxation may keep.
/// Nothing where the difference is within the error of that (`stated_error`), or nothing is known.
/// Precondition: the stages came to their end with all spheres.
std::optional<Shortfall> shortfall_of(const Packing& packing, const Plan& plan);

}  // namespace bernal
