#pragma once
#include <string>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// Lines that tell what was understood: the container, what the importer did to it, the spheres, the outputs.
std::string describe(const Plan& plan);

/// The same and all that would run, with what it is expected to cost: what `bernal explain` prints. Where
/// the scene names no stages, those that run stand at the end with all their defaults.
std::string explain(const Plan& plan);

}  // namespace bernal
