#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// How the certificate decides; both give the same answers.
enum class Arithmetic {
  filtered,  ///< double with a certified error bound, exact rational arithmetic where the bound cannot decide
  exact,     ///< exact rational arithmetic throughout
};

/// What was proven about spheres in a container or a periodic box, taking the doubles as written for exact
/// real numbers. Touching is allowed.
///
/// In a container, for every pair of spheres: |ci - cj| >= ri + rj; for every sphere: its ball lies inside
/// the closed container. Pairs and triangles of a mesh that bounding boxes separate are not counted; every
/// other one is decided exactly, and so is every sphere against each of the six faces of a box, the base, the
/// top and the side of a cylinder, or the wall of a sphere.
///
/// In a periodic box with the edges L, in any dimension, for every pair of spheres and every vector k of
/// integers: |ci - cj + k·L| >= ri + rj; for every sphere and every k that is not 0: |k·L| >= 2 ri. A pair
/// counts once, whatever the number of its images that meet, and is judged by the nearest; a sphere that
/// meets its own images counts as a pair of itself. Centres may lie outside the box: they stand for their
/// images in it, without rounding. There are no walls.
struct Certificate {
  bool certified = false;  ///< no overlap, no protrusion, every radius positive and finite

  std::uint64_t spheres = 0;
  std::uint64_t pairs_tested = 0;    ///< near pairs
  std::uint64_t walls_tested = 0;    ///< near pairs of a sphere and a piece of wall
  std::uint64_t centers_tested = 0;  ///< centres whose side of a mesh was decided
  std::uint64_t decided_double = 0;  ///< of the three sums above, by the filter
  std::uint64_t decided_exact = 0;   ///< of the three sums above, by exact arithmetic

  std::uint64_t overlapping_pairs = 0;   ///< by more than is allowed
  std::uint64_t protruding_spheres = 0;  ///< crossing the wall or outside it

  /// The pair with the largest (ri + rj - d) / (ri + rj), over near pairs, the smaller index first; twice the
  /// same for a sphere and its own image. None if no pair is near.
  std::optional<std::array<std::uint64_t, 2>> worst_pair;
  /// That ratio in double, with the sign of the exact decision: > 0 if and only if spheres overlap. 0 if no
  /// pair is near.
  double max_overlap = 0;
  /// The sphere with the smallest (clearance - r) / r, over spheres near a wall or outside; none if there are
  /// no such. Outside a box or a cylinder the clearance is that from the worst of its faces.
  std::optional<std::uint64_t> worst_wall;
  /// That ratio in double, with the sign of the exact decision: < 0 if and only if a sphere protrudes. 0 if
  /// no sphere is near a wall.
  double min_wall_gap = 0;

  double seconds = 0;
  std::string statement;  ///< one sentence for people
};

/// Certifies. Shares no neighbour search, kernel or stage with the packer. `allowed_overlap` in [0, 1) is the
/// largest overlap ratio of a pair that still counts as none (0: strict). Uses all threads of the calling
/// arena; the answer does not depend on their number.
///
/// A sphere whose centre is not finite or whose radius is not positive and finite makes the packing not
/// certified, as the statement says; then nothing else is tested. Throws Error{bad_argument} for columns of
/// different lengths, spheres that have not the dimension of the domain and absurd measures of a container or
/// a box, Error{bad_mesh} for a mesh with a boundary. That a mesh does not intersect itself is not checked.
///
/// Cost: O(N log N + near pairs), about 0.7 µs a sphere at N = 30,000 and 0.9 at 10,000,000 on one core, a
/// quarter more in a periodic box; a mesh of T triangles adds O(T log T), about 0.5 µs each. Exact arithmetic
/// throughout is 4 to 12 times slower. In high dimensions most pairs are near ones, and the cost is that of
/// all pairs.
Certificate certify(const Spheres<dynamic>& spheres, const Domain& domain, double allowed_overlap = 0,
                    Arithmetic arithmetic = Arithmetic::filtered);

/// "3 and 7" or "3 and its own image"; "none".
std::string worst_pair_text(const Certificate&);

}  // namespace bernal
