#pragma once
#include "cad/wall_triangle.hpp"

namespace bernal::cad {

/// Bounds that hold for the exact distance of the doubles given, whatever was rounded on the way.
struct DistanceBounds {
  double lower = 0;
  double upper = 0;
};

/// Certified bounds on the distance of p from a triangle, by duality. With w_i = p - v_i for the vertices
/// v_i:
///
///   for any direction n:           distance >= min_i n·w_i / |n|
///   for any weights lambda_i >= 0: distance <= |sum lambda_i w_i| / sum lambda_i
///
/// so the nearest point need not be known exactly, only guessed; a bad guess widens the bounds and never
/// falsifies them. Only the rounding of these two expressions has to be bounded, see the .cpp.
/// Width: some 20 roundoffs of the farthest vertex on triangles of good shape. Cost: 60 ns.
DistanceBounds bound_distance(const Vector<3>& p, const WallTriangle& t);

/// Whether the exact distance of p from the triangle is at least r >= 0, in rational arithmetic. Cost: 20 µs.
bool exactly_clears(const Vector<3>& p, const WallTriangle& t, double r);

/// The same through the bounds, in rational arithmetic only where they straddle r.
bool certainly_clears(const Vector<3>& p, const WallTriangle& t, double r);

}  // namespace bernal::cad
