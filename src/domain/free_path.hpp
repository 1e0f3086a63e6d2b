#pragma once
#include <span>
#include <vector>

#include "bernal/core/tolerance.hpp"
#include "bernal/domain/container.hpp"
#include "domain/motion.hpp"

namespace bernal {

// The move limit without a skin: the largest t in [0, limit] such that the ball at c + s·direction, for all s
// in [0, t], does not reach beyond the wall; touching is allowed. All doubles are taken for the real numbers
// that they are, the direction as it stands. A ball that reaches beyond the wall at the start may move
// nowhere: 0. Clearance to one convex piece of wall is convex along the way, and that from inside a convex
// wall concave: where the ball starts clear, the t of which that holds are an interval, and the answer is its
// end.
//
// With L the sum of the ball's radius, the wall's radius and the largest distance of c from the points that
// the wall is given by, and u the unit roundoff, the levels promise:
//
//   exact     the largest double t of which that is true, decided in integers (domain/exact_way.hpp): the
//             next double is past the contact. No filter is asked.
//   filtered  a double t <= exact and > exact - 4u·(L / |direction| + t) - 2 doubles; the limit if and
//             only if `exact` is the limit. Where extended precision cannot prove that, `exact` decides.
//   plain     kernels/first_contact.hpp with `rounding_skin` in place of the skin: the ball never reaches
//             beyond the wall by more than `rounding_bound`, and where it stops before the limit, its gap was
//             at most twice that on the way. No bound is meant for t itself: a ball that grazes a wall gains
//             much way from little distance.
//
// Preconditions: finite doubles, 0 < r, limit >= 0 (infinity stands for the largest double).
// Cost, per wall that limits: plain 0.1 µs, filtered 0.5 µs, exact 10 to 100 µs.

double free_path(const Corners& triangle, const Motion& motion, WallArithmetic arithmetic);
double free_path(const AnalyticWall& wall, const Motion& motion, WallArithmetic arithmetic);
/// The least of them, each asked only as far as the ones before allow.
double free_path(std::span<const AnalyticWall> walls, const Motion& motion, WallArithmetic arithmetic);
double free_path(const Facet& facet, const Motion& motion, WallArithmetic arithmetic);

/// The same of walls that a container says are near, with `way_to(facet, motion)` for each, of which the
/// motion reaches only as far as the ones before allow. Precondition: a direction that is not zero.
template <class Way>
double free_path_among_near(const Container& walls, Motion motion, const Way& way_to) {
  const double speed = motion.direction.stableNorm() * (1 + 8 * tolerance::roundoff);
  const double reach = motion.r + walls.free_path_bound(motion.c, motion.r);
  thread_local std::vector<NearFacet> near;
  near.clear();
  walls.facets_near(motion.c, reach + motion.limit * speed, near);
  for (const NearFacet& n : near) {
    if (n.distance - reach >= motion.limit * speed) break;
    motion.limit = way_to(n.facet, motion);
  }
  return motion.limit;
}

/// A bound of the error of a distance as kernels/first_contact.hpp computes it for a ball on its way, in
/// terms of S, the sum of L and the largest coordinate.
///
/// In roundoffs u: the place c + t·direction is off by 3 S on each axis, 5.2 S together. For a triangle the
/// way w to its corner is off by S, base and side, each of at most 2 S, by as much; taking the parts along
/// base and height away rounds products and differences of those lengths, 4 S each, and the norm adds 3 S:
/// below 32 S. For a cylinder the part across the axis is off by 24 |w|_1 <= 42 |w| (domain/cylinder.cpp);
/// with the place and the radii below 52 S. Planes and spheres take less.
inline double rounding_bound(double lengths) { return 64 * tolerance::roundoff * lengths; }
/// What stands for the skin in plain arithmetic, and the share of the bound that it is. By the rule of the
/// kernels the gap is at least half of it and at most 33/32 of it as computed; so, whatever is rounded, at
/// least -0.55 and at most 1.93 of the bound.
inline constexpr double plain_skin = 0.9;
inline double rounding_skin(double lengths) { return plain_skin * rounding_bound(lengths); }
/// S of a facet.
double lengths_of(const Facet& facet, const Motion& motion);

/// How far the surface of the ball is from the facet after t·direction, negative where it reaches beyond it
/// or, of a triangle, where that is nearer to its centre than its radius. In the 64 bits of long double:
/// wrong by less than 32 of their roundoffs of the lengths that occur, a 64th of a roundoff of double.
long double gap_after(const Facet& facet, const Motion& motion, long double t);
long double gap_after(const AnalyticWall& wall, const Motion& motion, long double t);

/// The bounded distance at the container's level: the largest double r <= reach such that the ball of radius
/// r about c lies inside as `contains` decides it; 0 if not even r = 0 does. Where that is exact or filtered,
/// it is the clearance rounded down to the last bit. In plain arithmetic `Container::clearance_within`.
double clear_radius(const Container& container, const Vector<3>& c, double reach);

/// The rule of kernels/first_contact.hpp, decided exactly: for a ball with its skin, which may always leave
/// what it rests on. In the terms of that page: `limit` where the gap never falls below skin / 2 on the whole
/// way; else the last double before it falls below `skin`; 0 where it is below that at once and does not grow
/// to it. A gap of a round wall, which grows and falls again, limits where it falls.
double first_contact_exactly(const Facet& facet, const Motion& motion, double skin);

}  // namespace bernal
