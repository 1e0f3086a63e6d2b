#pragma once
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "stages/places.hpp"

namespace bernal {

/// A place in a container and the radius of the largest sphere that fits there between the others and the
/// wall; negative where spheres cover it.
struct Hole {
  Vector<3> place;
  double room;
};

/// The emptiest of `probes` random places, the roomiest first, at most `wanted` of them and each outside the
/// holes before it. Cost: about 0.2 µs a probe.
std::vector<Hole> emptiest_holes(const Container& container, const Places& places,
                                 const Spheres<3>& spheres, std::size_t probes, std::size_t wanted,
                                 Random& random);

}  // namespace bernal
