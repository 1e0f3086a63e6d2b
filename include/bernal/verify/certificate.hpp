#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// How the certificate decides; both give the same answers.
enum class Arithmetic {
  filtered,  ///< double with a certified error bound, exact rational arithmetic where the bound cannot decide
  exact,     ///< exact rational arithmetic throughout
};

/// What was proven about spheres in a domain, taking the doubles as written for exact real numbers. Touching
/// is allowed.
///
/// Pairs: |ci - cj| >= ri + rj for every pair of spheres. Where the domain repeats itself, L being the vector
/// of its periods, 0 along open axes: |ci - cj + k·L| >= ri + rj for every vector k of integers, and
/// |k·L| >= 2 ri for every sphere and every k·L that is not 0. A pair counts once, whatever the number of its
/// images that meet, and is judged by the nearest; a sphere that meets its own images counts as a pair of
/// itself. Along axes with a period centres may lie anywhere: they stand for their images, without rounding.
///
/// Walls: every ball lies inside the closed domain, whose walls are the two faces of every axis of a box that
/// does not repeat itself, in any dimension; the base, the top and the side of a cylinder, only the side of a
/// periodic one; the surface of a sphere; the triangles of a mesh, between its
/// exact corners where it has such.
///
/// Where gaps are asked for, balls and walls keep them: |ci - cj| >= ri + rj + gap, in all images, and the
/// ball of radius ri + wall_gap lies inside. What is said below of overlap and protrusion then means too
/// small a gap as well, and all ratios are those of spheres with half the gap around each, (ri + rj + gap -
/// d) / (ri + rj + gap), and with the wall's gap around them, (clearance - r - wall_gap) / (r + wall_gap).
///
/// Pairs and triangles that bounding boxes separate are not counted; every other one is decided exactly, and
/// so is every sphere against each of the other walls.
struct Certificate {
  bool certified = false;  ///< no overlap above the allowed, no protrusion, every radius positive and finite
  double allowed_overlap = 0;    ///< the largest overlap ratio of a pair that counted as none
  double gap = 0, wall_gap = 0;  ///< that were asked for
  bool cancelled = false;        ///< the monitor ended it: the figures are of what was decided until then

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

  /// Where gaps are asked for, the least distance between the surfaces of two spheres, and of a sphere from
  /// the wall, negative outside; on the side of what is asked for that was decided exactly. None where that
  /// is more than twice the gap, or of a wall more than twice its gap and more than the other.
  std::optional<double> least_distance, least_wall_distance;

  struct Overlap {
    std::array<std::uint64_t, 2> pair;  ///< as `worst_pair`
    double ratio;                       ///< as `max_overlap`; above what is allowed
    bool operator==(const Overlap&) const = default;
  };
  struct Protrusion {
    std::uint64_t sphere;
    double gap;  ///< as `min_wall_gap`; negative
    bool operator==(const Protrusion&) const = default;
  };
  /// The overlapping pairs and the protruding spheres, as many as were asked for: the worst first, equal ones
  /// by index.
  std::vector<Overlap> overlaps;
  std::vector<Protrusion> protrusions;

  double seconds = 0;
  std::string statement;  ///< one sentence for people
};

struct CertifyOptions {
  double allowed_overlap = 0;  ///< in [0, 1): the largest overlap ratio of a pair that still counts as none
  double gap = 0;  ///< that spheres keep from each other, finite and not negative, in the unit of the domain
  double wall_gap = 0;  ///< the same, from the walls
  Arithmetic arithmetic = Arithmetic::filtered;
  /// How many overlapping pairs and how many protruding spheres are listed at most: the worst of each.
  std::size_t list = 0;
  static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  int threads = 0;  ///< 0: those of the calling arena
  /// So many spheres, twice that for a moment, are held beside those that are given; of more, slabs are
  /// looked at one after the other, each with what reaches into it. Nothing is decided otherwise for that.
  std::size_t at_once = std::size_t{1} << 21;
  Monitor monitor = {};  ///< hears of pairs, then of walls
};

/// Certifies. Shares no neighbour search, kernel or stage with the packer. The answer does not depend on the
/// number of threads. Once the monitor cancels, nothing is certified any more.
///
/// A sphere whose centre is not finite or whose radius is not positive and finite makes the packing not
/// certified, as the statement says; then nothing else is tested. Throws Error{bad_argument} for columns of
/// different lengths, gaps that are none, spheres that have not the dimension of the domain, a box whose
/// members are not of one dimension and absurd measures of a domain, Error{bad_mesh} for a mesh with a
/// boundary. That a mesh does not intersect itself is not checked.
///
/// Cost: O(N log N + near pairs), about 0.7 µs a sphere at N = 30,000 and 0.9 at 10,000,000 on one core, a
/// quarter more where the domain repeats itself; a mesh of T triangles adds O(T log T), about 0.5 µs each.
/// Exact arithmetic throughout is 4 to 12 times slower. In high dimensions most pairs are near ones, and the
/// cost is that of all pairs. Memory beside the spheres: about 64 bytes for each of those that are looked at
/// at once and 40 more for those that come next, and 4 bytes for all where there are more. A list of n takes
/// up to 48 n bytes a thread.
Certificate certify(const Spheres<dynamic>& spheres, const Domain& domain,
                    const CertifyOptions& options = {});

/// Spheres that nobody has to hold, such as those of a file.
struct SphereRows {
  std::uint64_t count = 0;
  int dimension = 3;
  /// The rows from `first` on, as many as there is room for, one a sphere: its coordinates and its radius.
  /// Called from one thread, for all rows several times, and says the same every time.
  std::function<void(std::uint64_t first, std::span<double> rows)> read = {};
};

/// The same certificate of spheres that are read in pieces, with no more of them in memory than three times
/// `at_once` and 0.2 bytes for each of the others: slabs are read one after the other. Cost: that of the
/// other, and of reading all rows some six times if they come in the order of one coordinate, and else once
/// for each slab.
Certificate certify(const SphereRows& spheres, const Domain& domain, const CertifyOptions& options = {});

/// "3 and 7" or "3 and its own image".
std::string pair_text(const std::array<std::uint64_t, 2>& pair);
/// That of the worst pair; "none".
std::string worst_pair_text(const Certificate&);

}  // namespace bernal
