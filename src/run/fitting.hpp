#pragma once
#include <cstdint>

#include "bernal/domain/container.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal {

/// No sphere larger than this fits into the shape, or beside its own images: exact for the analytic ones; for
/// a mesh an upper bound from its bounds and its volume.
double largest_fitting_radius(const Domain& shape);

/// Throws Error{bad_scene} at the scene's container if it repeats itself so often that spheres of that
/// radius, in a bed, would meet two images of others.
void require_long_periods(const Scene& scene, const Domain& container, double radius);

/// Throws Error{bad_scene} at the scene's sizes, with the remedy, if a sphere of that radius cannot fit.
void require_fitting(const Scene& scene, const Domain& container, double radius);

/// Throws Error{bad_argument}: not a single random place was found in it.
[[noreturn]] void refuse_thin_container();

/// Where to cut an unbounded tail of sizes: the radius for whose spheres' centres only one hundredth of the
/// container has room; single larger ones would wait for a place for ever. From 10,000 random points.
double radius_with_hardly_any_room(const Container& container, std::uint64_t seed);

}  // namespace bernal
