#pragma once
#include <string>
#include <string_view>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// Whether it is a container: of given size, with walls that stand.
bool has_fixed_walls(const PeriodicBox& box);

/// Of a density in kg/m³ that no solid has, and many have in g/cm³, what may be meant in place of it; else
/// empty.
std::string doubt_of_density(std::string_view key, double density);

/// Makes a bulk density a porosity, and a porosity a packing fraction where there is no bed: no floor, stages
/// that make none. Throws Error{bad_scene} where that contradicts what else the target says, and for a bulk
/// density that leaves no porosity of spheres.
void take_porosity(Scene& scene);

}  // namespace bernal
