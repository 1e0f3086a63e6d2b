#pragma once
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/scene/scene.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// The share of a container's volume that a sphere of radius r can cover without passing the wall: corners
/// and parts thinner than the sphere are left out. From 5,000 points of a low-discrepancy sequence; a point
/// nearer to the wall than r counts when the sphere that touches the wall there does not pass it elsewhere.
/// Error: about 0.003 from the points in a part with few corners; where a sphere could cover the point from
/// another side it is missed. Cost: about 50 ms in a mesh.
double coverable_share(const Container& container, double r);

/// The packing fraction that the scene's stages are likely to reach in a container when they may fill it.
double expected_packing_fraction(const Scene& scene, const Shape& shape, const SizeDistribution& radii);

/// What relaxation reaches of spheres of these sizes in a periodic box: the prediction in three dimensions;
/// in others the packing fractions of equal spheres, which are not much lower than those of others.
double close_packing_fraction(const SizeDistribution& radii, int dimension);

}  // namespace bernal
