#pragma once
#include <cstdint>
#include <string>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/shape.hpp"

namespace bernal {

/// How the certificate decides; both give the same answers.
enum class Arithmetic {
  filtered,  ///< double with a certified error bound, exact rational arithmetic where the bound cannot decide
  exact,     ///< exact rational arithmetic throughout
};

/// What was proven about spheres in a container, taking the doubles as written for exact real numbers.
///
/// For every pair of spheres: |ci - cj| >= ri + rj. For every sphere: its ball lies inside the closed
/// container. Pairs and walls that bounding boxes separate are not counted; every other one is decided
/// exactly. Touching is allowed.
struct Certificate {
  bool certified = false;  ///< no overlap, no protrusion, every radius positive and finite

  std::uint64_t spheres = 0;
  std::uint64_t pairs_tested = 0;   ///< near pairs
  std::uint64_t walls_tested = 0;   ///< near pairs of a sphere and a piece of wall
  std::uint64_t centers_tested = 0; ///< centres whose side of the wall was decided
  std::uint64_t decided_double = 0; ///< of the three sums above, by the filter
  std::uint64_t decided_exact = 0;  ///< of the three sums above, by exact arithmetic

  std::uint64_t overlapping_pairs = 0;
  std::uint64_t protruding_spheres = 0;  ///< crossing the wall or outside it

  /// The pair with the largest (ri + rj - d) / (ri + rj), over near pairs; first == second when there is none.
  std::uint64_t worst_pair[2] = {0, 0};
  double max_overlap = 0;  ///< that ratio in double; <= 0 when nothing overlaps
  /// The sphere with the smallest (clearance - r) / r, over spheres near a wall, and that ratio in double.
  std::uint64_t worst_wall = 0;
  double min_wall_gap = 0;

  double seconds = 0;
  std::string statement;  ///< one sentence for people
};

/// Certifies. Shares no neighbour search, kernel or stage with the packer. `allowed_overlap` is the largest
/// overlap ratio of a pair that still counts as none (0: strict). Uses all threads of the calling arena; the
/// answer does not depend on their number.
/// Cost: O(N log N); about 1 µs a sphere.
Certificate certify(const Spheres<3>& spheres, const Shape& container, double allowed_overlap = 0,
                    Arithmetic arithmetic = Arithmetic::filtered);

}  // namespace bernal
