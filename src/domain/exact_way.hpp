#pragma once
#include <cstdint>

#include "domain/dyadic.hpp"
#include "domain/motion.hpp"

namespace bernal {

// What a ball does on its way, decided without rounding: every double is taken for the real number that it
// is. Only signs of polynomials of the doubles are asked for (domain/dyadic.hpp).

/// Whether the closed ball of radius r about p is on the inner side of the wall, touching allowed. With
/// w = p - point:
///
///   plane     w·axis >= (r - radius)·|axis|, compared by sign and square
///   cylinder  |w|²·|axis|² - (w·axis)² <= (radius - r)²·|axis|² and r <= radius
///   sphere    |w|² <= (radius - r)² and r <= radius
///
/// Cost: about 2 µs.
bool clears_exactly(const AnalyticWall& wall, const ExactVector& p, double r);

/// Whether no point of the triangle is nearer than r > 0 to any of the points c + s·direction, 0 <= s <= t:
/// the way clears the triangle.
///
/// The way is a segment. It comes nearest to the triangle with one of its ends, over a corner of the
/// triangle, or between an edge of it and the way where both lie within; or it crosses the triangle. Each is
/// decided by itself, also where the triangle or the way has no length. Cost: about 10 µs.
bool way_clears_exactly(const Corners& triangle, const Motion& motion, double r, double t);

/// The place c + t·direction.
ExactVector place_after(const Motion& motion, double t);

/// How many decisions about a wall this thread has made without rounding: those above, and exactly_clears in
/// cad/certified_distance.hpp.
inline thread_local std::uint64_t exact_decisions = 0;

}  // namespace bernal
