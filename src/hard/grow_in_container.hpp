#pragma once
#include <vector>

#include "hard/grow.hpp"
#include "hard/wall.hpp"
#include "work/work.hpp"

namespace bernal {

/// Growth in a convex container with the sizes as they were drawn: hard spheres fly, collide with each other
/// and the walls, and grow in proportion until they have their radii (Lubachevsky & Stillinger, J. Stat.
/// Phys. 60, 561 (1990); at a wall v_n -> -v_n - 2 r').
///
/// As many spheres as the target asks for, or as the plan expects, start with a share of their radii at which
/// they fill phi_init of the container: those in the bed where they are, the others by random sequential
/// insertion; where that gets stuck, with half of phi_init. What jams before its radii are reached shows how
/// many spheres the container has room for: the tail of the drawn sequence is taken out, what is left shrinks
/// until it is a fluid again and goes on growing, a few times at most. So the result is the drawn sequence
/// less its tail. Schedule and pressure are those of growth in a periodic box, with the cube root of the
/// container's volume for its length.
///
/// The walls are those of `convex_walls`: facets in one plane to 1e-4 of the smallest radius count as one.
/// Nothing is left to that: all spheres come into the bed by the same question as those of any other stage,
/// whether they fit. Spheres end with their radii and the skin of the bed, 1e-9.
///
/// Ends `converged` with all spheres that were asked for or expected, `full` with those that found room.
/// Throws Error{bad_scene} if the container is not convex, if the largest sphere does not fit into it, or if
/// insertion finds no places at all. Cost: that of growth in a periodic box, some 2,000 collisions a sphere
/// at 0.5 to 0.8 µs; as much again after spheres were taken out. Han's cylinder (R = 1, H = 2, r = 0.0309):
/// 0.60 in 17 s, 0.62 in 24 s, where relaxation takes 0.8 s and 2.7 s; 0.63 in 41 s, where relaxation ends at
/// 0.6288 after 59 s. One thread.
StageEnd grow_in_container(Work& work, const GrowOptions& options);

/// The walls that growth takes the shape to have. Throws Error{bad_scene} if it is not convex.
std::vector<Wall<3>> walls_for_growth(const Domain& shape, double smallest_radius);

}  // namespace bernal
