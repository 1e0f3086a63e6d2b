#pragma once
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "verify/ball.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// Decides for every ball whether it lies in the closed container.
///
/// A box has six pieces of wall, a cylinder three (base, top, side) and a sphere one: every ball is tried
/// against each. Of a mesh the triangles whose boxes touch the ball's are tried, and the side of its centre
/// is decided. Throws Error{bad_mesh} for a mesh that encloses nothing and Error{bad_argument} for absurd
/// measures. Cost: O(N), for a mesh of T triangles O(T log T + N log T + near pieces).
Tally judge_walls(const BallTree<3>& balls, const Domain& container, Arithmetic arithmetic);

/// The same for a domain that repeats itself along some axes, or a box of any dimension: only axes that end
/// are looked at, and centres may lie anywhere along the others. One thread.
Tally judge_walls(const Spheres<dynamic>& spheres, const Domain& domain, Arithmetic arithmetic);

}  // namespace bernal::verify
