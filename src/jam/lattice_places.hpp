#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/domain/container.hpp"

namespace bernal {

/// So many places of a lattice in a container, as a start for spheres of about that radius: of a simple,
/// face-centred or body-centred cubic or a hexagonal close-packed one, in the plane of a square or a
/// hexagonal one; along the axes, turned by right angles or halves of them, or as chance has it; with a
/// corner, a middle or any place of its cell in the middle of the container; as wide as leaves enough places,
/// and stretched by up to a tenth along each axis at times. Those are taken that are deepest inside, or any.
/// Nothing where the container is so long and thin that it would take too many cells. Cost: about ten passes
/// over the cells of the container's bounds, a clearance each.
std::optional<std::vector<Vector<3>>> lattice_places(const Container& container, std::size_t count,
                                                     double radius, Random& random);

/// The places of the widest grid along the axes that fills the container's bounds with so many cells or more:
/// in a box those of spheres that divide it. Nothing where not so many of them are inside.
std::optional<std::vector<Vector<3>>> grid_places(const Container& container, std::size_t count);

}  // namespace bernal
