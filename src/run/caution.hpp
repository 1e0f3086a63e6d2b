#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "bernal/run/run.hpp"

namespace bernal {

/// Whether as many spheres are to be placed as are expected or fit, and walls are so near everywhere that how
/// many that are is a guess.
bool is_guess(const Plan& plan);
/// Then, where as many as are expected are wanted: how many these may be too few or too many, at least one.
std::optional<std::uint64_t> give_or_take(const Plan& plan);

/// What a plan is likely to end in, where that is not what was asked for: too few large spheres for a
/// periodic box; a packing fraction beyond what these sizes pack to, or beyond any arrangement of equal
/// spheres; a mesh in which no place is known for any of them. Empty where nothing is to be said.
/// Precondition: what is expected is known.
std::string caution_of(const Plan& plan);

/// "the largest sphere that is known to fit has the diameter 12.6 mm", as the scene says sizes, with so much
/// room around it.
std::string largest_in_words(const Plan& plan, double around);

}  // namespace bernal
