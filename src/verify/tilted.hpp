#pragma once
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "verify/job.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// The certificate of the pairs of a tilted periodic box of two or three dimensions: d >= (1 - allowed)(ri +
/// rj + gap) for the centres ci and cj + n·H, with H the cell vectors and n whole numbers, and every pair of
/// images that may be near; of a ball and its own images, too.
///
/// Centres are taken as they are given, and n·H is a sum of products of doubles: so Exact evaluates the
/// distance without error, and no centre is wrapped. Images are found in double, by boxes that are wider by
/// more than its rounding. The nearest image of a pair is no farther than half the sum of the lengths of the
/// cell vectors, so that nothing beyond these lengths is looked at, however large a ball is.
///
/// Throws Error{bad_argument} unless every axis has a period, the shortest edge is at least a thousandth of
/// the longest and of the tilt, and every centre lies within a million periods. Memory: all balls at once,
/// some 150 bytes each. Cost: O(N log N + near pairs).
Tally judge_tilted(const Spheres<dynamic>& spheres, const bernal::Box& box, const Job& job);

}  // namespace bernal::verify
