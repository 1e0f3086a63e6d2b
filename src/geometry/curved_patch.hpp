#pragma once
#include <array>

#include "bernal/geometry/true_surface.hpp"

namespace bernal {

// How far a curved surface is from flat triangles, proven.
//
// 1. A piece bends little. Let S be twice continuously differentiable on the triangle of parameters with the
// corners p1, p2, p3, with |S_uu| <= A, |S_uv| <= B, |S_vv| <= C there. The flat triangle with the corners
// S(p1), S(p2), S(p3) has the point sum l_i S(p_i) where the surface has S(p), p = sum l_i p_i. By Taylor's
// formula about p, whose linear terms cancel,
//
//   |sum l_i S(p_i) - S(p)| <= 1/2 sum l_i (A du_i² + 2 B |du_i dv_i| + C dv_i²),   (du_i, dv_i) = p_i - p.
//
// As 2 |du dv| <= s du² + dv² / s for every s > 0, what stands in brackets is at most the quadratic form
// Q(d) = (A + B s) du² + (C + B / s) dv²; and of a quadratic form sum l_i Q(p_i - p) = sum over i < j of
// l_i l_j Q(p_i - p_j). The largest value of that over the triangle, with the three Q(p_i - p_j) called x, y,
// z, is x y z / (2 x y + 2 y z + 2 z x - x² - y² - z²) where each of them is less than the sum of the others,
// and else a quarter of the largest. Half of it is the *bend* e of the piece. (If Q is the squared length,
// that is half of the squared radius of the circumcircle, or of the longest edge's circle.) Of a cylinder it
// is what a chord is off its arc, R du² / 8. A triangle is halved at the middle of the edge with the largest
// Q; for its halves Q holds as well.
//
// 2. Distance to something convex. Let K be convex. The distance d(x, K) is a convex function of x, so on the
// flat triangle with the corners S(p_i) it is largest at a corner. Hence every point of the piece has
//
//   d(S(p), K) <= max d(S(p_i), K) + e,
//
// and for the same reason every point q has |q - S(p)| >= d(q, flat triangle of the S(p_i)) - e. Pieces are
// halved until e is negligible.
//
// 3. The deviation. With K the flat triangle T that a piece belongs to, or one beside it, this bounds the
// distance `apart` of the surface from the triangles: a ball that keeps this distance from them, and its
// radius, is clear of the surface.
//
// 4. Sides. With K the flat triangle T that the piece belongs to it bounds the `track`. Move every point S(p)
// on a straight line to the point of T that stands for it. As T is convex, nothing leaves the set of points
// with d(x, T) <= track. So where a point is farther than `track` from all flat triangles, the surface and
// the closed mesh of these wind around it equally often: once if it is inside.
//
// 5. Rounding. All this is computed in double. Coordinates of S are sums of sixteen products, or convex
// combinations nested less than 64 deep, and differences of these; corners of divided triangles are off the
// edges between them by a roundoff of the parameters for each of less than 64 divisions. `rounding_of` bounds
// what all of this does to a point and to e.

/// Upper bounds of the lengths of derivatives.
struct DerivativeBounds {
  double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

/// A box of parameters.
struct ParameterBox {
  std::array<double, 2> lower, upper;
};

using ParameterTriangle = std::array<std::array<double, 2>, 3>;

ParameterBox box_of(const ParameterTriangle&);

/// S(u, v), to `rounding_of`. Cost: some 20 ns, of Bézier patches 10 ns a control point.
Vector<3> point_at(const TrueSurface::Patch&, const std::array<double, 2>& at);

/// Of all points of the box. Of a Bézier patch by the control points of the part over the box: of
/// polynomials by their differences; of rational ones S = P / w, with the origin in their middle, by S'' =
/// (P''
/// - 2 w' S' - w'' S) / w and the like. Of a sweep by the lengths of its terms, or by the derivative in the
/// middle and bounds of the next ones.
DerivativeBounds derivative_bounds(const TrueSurface::Patch&, const ParameterBox&);

/// Q(d) = u du² + v dv².
struct Bending {
  double u = 0, v = 0;
};

/// Q of a triangle, by bounds over its box; s is such that both directions of the box have the same share of
/// B.
Bending bending_of(const ParameterTriangle&, const DerivativeBounds&);

/// e, of the triangle or a part of it; or of one whose edges have these Q.
double bend_of(const ParameterTriangle&, const Bending&);
double bend_of_edges(const std::array<double, 3>& q);

/// What rounding does in such a box, in units of the coordinates: 2^-43 of the terms' sizes, and of the
/// parameters 2^-46 times their derivatives.
double rounding_of(const TrueSurface::Patch&, const ParameterBox&, const DerivativeBounds&);

/// The edge with the largest Q, which begins at that corner.
int edge_to_halve(const ParameterTriangle&, const Bending&);

/// The middle of an edge, the same from either side.
inline std::array<double, 2> middle_of_edge(const ParameterTriangle& t, int edge) {
  const auto &a = t[edge], &b = t[(edge + 1) % 3];
  return {0.5 * a[0] + 0.5 * b[0], 0.5 * a[1] + 0.5 * b[1]};
}

}  // namespace bernal
