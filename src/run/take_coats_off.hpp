#pragma once
#include <cstdint>
#include <vector>

#include "work/supply.hpp"

namespace bernal {

/// Puts the drawn radius in the place of every radius of a supply that has coats, `coat` each, times a scale;
/// `tags` are those of the radii. Returns the scale of the drawn ones: the largest at which every r that is
/// drawn has scale·r + coat no larger than what it had with its coat.
double take_coats_off(std::vector<double>& radii, const std::vector<std::uint32_t>& tags,
                      const Supply& supply, double coat);

/// Of the volume of all spheres of a supply, the share that they have without their coats.
double share_of_drawn(const Supply& supply, int dimension);

}  // namespace bernal
