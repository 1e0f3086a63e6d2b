#pragma once
#include <string_view>

#include "bernal/domain/container.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal {

// `made` is the plan's container, or null: then it is made where it is needed, which costs nothing but of
// meshes.

/// No sphere larger than this fits into the shape, or beside its own images: exact for the analytic ones; for
/// a mesh an upper bound from its bounds and its volume.
double largest_fitting_radius(const Domain& shape);

/// The largest sphere that is known to fit. Cost: of meshes some milliseconds, half a second where `wanted`
/// is larger than what is found in these.
double largest_known_radius(const Domain& container, const std::shared_ptr<const Container>& made,
                            double wanted);

/// Throws Error{bad_scene} at the scene's container if it repeats itself so often that spheres of that
/// radius, in a bed, would meet two images of others.
void require_long_periods(const Scene& scene, const Domain& container, double radius);

/// Throws Error{bad_scene} at the scene's sizes, with the remedy or to check the units, if a sphere of that
/// radius cannot fit. Cost in a mesh that is not much thicker than the sphere: some milliseconds, half a
/// second where it hardly fits, and what its container costs if it is not made.
void require_fitting(const Scene& scene, const Domain& container,
                     const std::shared_ptr<const Container>& made, double radius,
                     std::string_view remedy = "use smaller ones");

/// The largest radius that has to fit into a plan's domain: that of its sizes, infinite where these have no
/// end; of a count whose radii are drawn as the scene says, and not from a cut tail, the largest that its
/// seed draws, where that one is too large. Precondition: domain and radii are made. Cost: as
/// `require_fitting`.
double largest_to_fit(const Plan& plan);

/// Whether that may fit, by itself, so that neither of these two refuses it; of sizes without end the median.
bool may_fit(const Plan& plan);

/// Throws Error{bad_argument}: not a single random place was found in it.
[[noreturn]] void refuse_thin_container();

/// Where to cut an unbounded tail of sizes in a domain with walls, infinity for one that ends by itself: the
/// largest radius up to which the container can cover, for every size, the share of the spheres' volume that
/// is as large or larger; at most the largest sphere that fits. What is larger would wait for a place for
/// ever. Throws as `require_fitting` if less than half of all sizes are below. Cost: up to ten times that of
/// `coverable_share`; none where the tail is far below what fits.
double tail_cut(const Scene& scene, const Domain& container, const SizeDistribution& radii,
                const std::shared_ptr<const Container>& made = {});

/// A container's own frame. Throws Error{bad_scene} at the container where it is so far from the origin, and
/// at the sizes where they reach down so far, that neighbouring spheres could not be told apart.
Frame frame_for(const Scene& scene, const Domain& container, const SizeDistribution& radii);

/// Throws Error{bad_scene} where the domain reaches, or a box that follows from the packing would reach,
/// farther than what is written could be read back.
void require_readable_places(const Plan& plan);

/// Throws Error{bad_scene} for a count that would be drawn for long though not a thousandth of it fits.
void require_drawable_count(const Plan& plan);

/// Throws Error{bad_scene}, before anything is drawn, for more spheres than have numbers, and for what this
/// machine has no memory for.
void require_memory(const Plan& plan);

}  // namespace bernal
