#pragma once
#include <vector>

#include "work/supply.hpp"

namespace bernal {

/// Puts the drawn radius in the place of every radius of a supply that has coats, `coat` each, times `scale`;
/// of spheres whose radii came out as so many times those of the supply. Radii are given to spheres in their
/// order, where several are the same with their coats. Returns the scale of the drawn ones: the largest at
/// which every r that is drawn has scale·r + coat no larger than what it had with its coat.
double take_coats_off(std::vector<double>& radii, const Supply& supply, double coat, double scale);

/// Of the volume of all spheres of a supply, the share that they have without their coats.
double share_of_drawn(const Supply& supply, int dimension);

}  // namespace bernal
