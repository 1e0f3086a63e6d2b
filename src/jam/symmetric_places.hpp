#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/domain/container.hpp"
#include "domain/places.hpp"

namespace bernal {

/// So many random places that a group of rotations and reflections about the container's middle maps onto
/// each other, as a start for spheres of about that radius: a group with axes along those of space and, at
/// times, their diagonals, as chance has it, which the container has too. Of a place the images come with it;
/// a place whose images are nearer than a diameter moves to their middle, as a rule on an axis or a mirror.
/// Many of the tightest arrangements in balls and cubes have such a group: in a ball those of 38, 61 and 63.
/// Nothing where the container does not have the group, and where orbits do not add up to so many. Cost: that
/// of some hundred clearances.
std::optional<std::vector<Vector<3>>> symmetric_places(const Container& container, const Places& places,
                                                       std::size_t count, double radius, Random& random);

}  // namespace bernal
