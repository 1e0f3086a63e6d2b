#pragma once
#include <string>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// What a plan is likely to end in, where that is not what was asked for: too few large spheres for a
/// periodic box, or a container with walls; a packing fraction beyond what these sizes pack to, or beyond any
/// arrangement of equal spheres; a bed less porous than they come to lie; a number that is only guessed, see
/// `give_or_take`; a mesh in which no place is known for any of them; a mass that drawn sizes come nowhere
/// near. Empty where nothing is to be said. Precondition: what is expected is known.
std::string caution_of(const Plan& plan);

/// "the largest sphere that is known to fit has the diameter 12.6 mm", as the scene says sizes, with so much
/// room around it.
std::string largest_in_words(const Plan& plan, double around);

}  // namespace bernal
