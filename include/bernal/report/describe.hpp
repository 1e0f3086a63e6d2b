#pragma once
#include <string>

#include "bernal/plan/plan.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// The plan in words: the container, what the importer did to it, the spheres, the outputs.
std::string describe(const Plan& plan);

/// The same with all stages and their expected cost: what `bernal explain` prints. If the scene names no
/// stages, the default ones are listed at the end with all their options.
std::string explain(const Plan& plan);

/// Of a tilted periodic box ", tilt 6, 0, -1.5", in two dimensions ", tilt 6"; of others nothing.
std::string tilt_in_words(const Domain&);

/// What a scene asks of the cells of its packing, beside what they are.
std::string cells_in_words(const PackedCells&);

}  // namespace bernal
