#pragma once
#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/core/vector.hpp"
#include "bernal/domain/container.hpp"
#include "domain/places.hpp"

namespace bernal {

/// A random place of the container at which a sphere of that radius clears the wall, or of those that were
/// tried the one where it does best: for spheres that will be pushed off the wall. Throws Cancelled.
/// Cost: a hundred bounded distances at most, once a place inside is found.
Vector<3> clear_place(double r, const Container& container, const Places& places, Random& random,
                      const Monitor& monitor);

}  // namespace bernal
