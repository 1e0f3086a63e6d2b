#pragma once
#include "cad/wall_triangle.hpp"

namespace bernal::cad {

/// Bounds on the exact distance of the given doubles, including all rounding.
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
/// so the nearest point need only be guessed; a bad guess widens the bounds but never falsifies them. The
/// rounding of these two expressions is bounded in the .cpp. Width: about 20 roundoffs of the farthest vertex
/// on triangles of good shape. Cost: 60 ns.
DistanceBounds bound_distance(const Vector<3>& p, const WallTriangle& t);

/// Whether the exact distance of p from the triangle is at least r >= 0, in rational arithmetic. Cost: 20 µs.
bool exactly_clears(const Vector<3>& p, const WallTriangle& t, double r);

/// The same by the bounds, and in rational arithmetic only if they straddle r.
bool certainly_clears(const Vector<3>& p, const WallTriangle& t, double r);

}  // namespace bernal::cad
