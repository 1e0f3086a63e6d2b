#pragma once
#include <memory>

#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/plan/plan.hpp"
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
/// `made`: see plan/fitting.hpp.
double expected_packing_fraction(const Scene& scene, const Domain& shape, const SizeDistribution& radii,
                                 const std::shared_ptr<const Container>& made = {});

/// What relaxation reaches in a box that has walls along some axes, or all, of what sizes reach without.
double reached_between_walls(const Scene& scene, const Box& box, const SizeDistribution& radii);

/// Takes the height that the scene gives the bed. Throws Error{bad_scene} where the container has it not, or
/// no room is in it for the largest spheres, or gaps contradict its density.
void set_height_of_bed(Plan& plan);

/// Of a scene with a stage that makes a bed, from what is expected to fit and how many there are.
Plan::ExpectedBed expected_bed(const Plan& plan);

/// How far below the one of the two functions here that is for the scene's domain a result may lie: 0.01, the
/// error of the rod model, in a periodic box; 0.016 and 0.03 in a container, where relaxation and compression
/// were measured; and where that is so thin that walls are everywhere a share of what is `expected`, as it is
/// a matter of how spheres happen to fit.
double error_of_expectation(const Scene& scene, const Domain& shape, const SizeDistribution& radii,
                            double expected);

/// That share: 0.12 (x - 1)^1.5 where x = A d / V is more than 1, for walls of area A, a volume V and the
/// mean diameter d that counts by surface. Of 41 cylinders, boxes and balls 1 to 20 diameters wide with x
/// from 0.9 to 4.4, and a Menger sponge, filled with as many equal spheres as could be made to fit, all but
/// two came within this and a sphere of what was expected, from 0.7 to 1.8 times as many; those to 1 of 3.3
/// and 422 of 408. 0 in other than two and three dimensions.
double error_between_walls(const Domain& shape, const SizeDistribution& radii);

/// How many of the largest spheres, those of `VolumeCarriers::radius`, lie across a container: as if it were
/// a cube, or between walls along the axes that have them, with its volume over the area of its walls.
/// Infinite without walls, and in other than two and three dimensions.
double largest_across(const Domain& shape, const SizeDistribution& radii);

/// The share by which what is expected may be wrong where fewer than three of the largest spheres lie across:
/// that of `error_between_walls` with their diameter in place of the mean, 0 where more do. Two sizes 1 : 10,
/// 70 % of the volume large, in a cube 1.5 of the large ones across: 0.597 expected, 0.388 reached.
double error_of_few_large(const Domain& shape, const SizeDistribution& radii);

/// That of `error_of_expectation`, or of `error_of_few_large` where that is more: what people are told. A
/// target that is to be reached surely goes by the first alone.
double stated_error(const Scene& scene, const Domain& shape, const SizeDistribution& radii, double expected);

/// What the last stage that places spheres says that it reaches of itself, whatever the sizes: 1 where it
/// says nothing.
double reached_by_last(const Scene& scene);

/// What relaxation reaches of spheres of these sizes in a periodic box: the prediction in three dimensions;
/// in others the packing fractions of equal spheres, which are not much lower than those of others.
double close_packing_fraction(const SizeDistribution& radii, int dimension);

/// What the stages of a scene that densify make of that, as a factor: 1 where there is none.
double gain_of_stages(const Scene& scene, const Domain& shape, const SizeDistribution& radii);

}  // namespace bernal
