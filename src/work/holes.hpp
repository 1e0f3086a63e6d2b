#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "work/places.hpp"

namespace bernal {

/// A place in a container: the radius of the largest sphere that fits there between the others, negative
/// where spheres cover it, and the distance from the wall.
struct Hole {
  Vector<3> place;
  double room, clearance;

  double fitting() const { return std::min(room, clearance); }
};

/// For each of the radii, which descend, the emptiest of `probes` random places that has not been given to
/// one before it: one that clears the wall if there is any. Fewer, if there are not so many places. Cost:
/// about 0.2 µs a probe.
std::vector<Hole> holes_for(std::span<const double> radii, const Container& container, const Places& places,
                            const Spheres<3>& spheres, std::size_t probes, Random& random);

}  // namespace bernal
