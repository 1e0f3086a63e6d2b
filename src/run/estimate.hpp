#pragma once
#include <memory>

#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/scene/scene.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// The share of a container's volume that spheres of radius r can cover without passing the wall: corners and
/// parts thinner than the sphere are left out. From 5,000 points of a low-discrepancy sequence; a point
/// nearer to the wall than r counts when a sphere that is moved from there off one wall after the other,
/// until it clears all of them, still covers it. Error: about 0.003 from the points; where the nearest place
/// at which the sphere fits is elsewhere, as in corners that are not right-angled, a point may be missed.
/// Cost: about 50 ms in a mesh.
double coverable_share(const Container& container, double r);

/// The packing fraction that the scene's stages are likely to reach in a container when they may fill it.
/// `made`: see run/fitting.hpp.
double expected_packing_fraction(const Scene& scene, const Domain& shape, const SizeDistribution& radii,
                                 const std::shared_ptr<const Container>& made = {});

/// How far below the one of the two functions here that is for the scene's domain a result may lie: 0.01, the
/// error of the rod model, in a periodic box; 0.016 and 0.03 in a container, where relaxation and compression
/// were measured.
double error_of_expectation(const Scene& scene);

/// What the last stage that places spheres says that it reaches of itself, whatever the sizes: 1 where it
/// says nothing.
double reached_by_last(const Scene& scene);

/// What relaxation reaches of spheres of these sizes in a periodic box: the prediction in three dimensions;
/// in others the packing fractions of equal spheres, which are not much lower than those of others.
double close_packing_fraction(const SizeDistribution& radii, int dimension);

/// What the stages of a scene that densify make of that, as a factor: 1 where there is none.
double gain_of_stages(const Scene& scene, const SizeDistribution& radii);

}  // namespace bernal
