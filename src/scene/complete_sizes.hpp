#pragma once
#include <cstddef>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// Of classes of several materials the density that all spheres have together, where the scene says none:
/// what a mass is counted by. Throws Error{bad_scene} where it says another.
void complete_density(Scene&);

/// Of a scene whose sizes are a list, each exactly once: that there are as many spheres, and that they are
/// dealt and not drawn. Throws Error{bad_scene} where the scene says otherwise.
void complete_list(Scene&);

/// The count alone, once it is known how many spheres are there from the start.
void complete_count_of_list(Scene&, std::size_t there);

}  // namespace bernal
