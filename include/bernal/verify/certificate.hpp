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

/// The arithmetic of the certificate; both kinds give the same answers.
enum class Arithmetic {
  filtered,  ///< double with a certified error bound; exact rational arithmetic if the bound cannot decide
  exact,     ///< exact rational arithmetic throughout
};

/// What was proven about spheres in a domain, with the given doubles as exact real numbers. Touching is
/// allowed.
///
/// Pairs: |ci - cj| >= ri + rj for every pair of spheres. In a periodic domain with the vector of periods L
/// (0 along open axes): |ci - cj + k·L| >= ri + rj for every integer vector k, and |k·L| >= 2 ri for every
/// sphere and every nonzero k·L. A pair counts once, however many of its images overlap, and is judged by the
/// nearest; a sphere that overlaps its own images counts as a pair with itself. Along periodic axes centres
/// may lie anywhere: they represent all their images, without rounding.
///
/// Walls: every ball lies inside the closed domain. Its walls are both faces of each non-periodic axis of a
/// box, in any dimension; base, top and side of a cylinder (only the side if periodic); the surface of a
/// sphere; the triangles of a mesh, with its exact corners if it has them.
///
/// Gaps: if requested, |ci - cj| >= ri + rj + gap, in all images, and the ball of radius ri + wall_gap lies
/// inside. Overlap and protrusion below then include gaps that are too small, and all ratios are those of
/// enlarged spheres: (ri + rj + gap - d) / (ri + rj + gap) and (clearance - r - wall_gap) / (r + wall_gap).
///
/// Pairs and triangles with separate bounding boxes are not counted; all others are decided exactly, and so
/// is every sphere against each of the other walls. The closest pair and the sphere closest to a wall are
/// those of all, however far apart they are.
struct Certificate {
  bool certified = false;      ///< no overlap above the allowed, no protrusion, all radii positive and finite
  double allowed_overlap = 0;  ///< the largest overlap ratio that counted as none
  double gap = 0, wall_gap = 0;  ///< the requested gaps
  bool cancelled = false;        ///< the monitor stopped it; the figures cover what was decided until then

  std::uint64_t spheres = 0;
  std::uint64_t pairs_tested = 0;    ///< near pairs
  std::uint64_t walls_tested = 0;    ///< pairs of a sphere and a piece of wall, see `walls_tested_are_near`
  std::uint64_t centers_tested = 0;  ///< centres that were located inside or outside a mesh
  std::uint64_t decided_double = 0;  ///< of the three counts above, by the filter
  std::uint64_t decided_exact = 0;   ///< of the three counts above, by exact arithmetic

  std::uint64_t overlapping_pairs = 0;   ///< overlapping by more than allowed
  std::uint64_t protruding_spheres = 0;  ///< crossing a wall or outside

  /// The pair with the largest (ri + rj - d) / (ri + rj) of all pairs and images, the smaller index first;
  /// one index twice for a sphere and its own image. Absent where there is none: of fewer than two spheres,
  /// or none in a domain that repeats itself.
  std::optional<std::array<std::uint64_t, 2>> worst_pair;
  /// That ratio in double, with the sign of the exact decision: > 0 if and only if spheres overlap. Off by at
  /// most 1e-15 times 1 + |ratio|; across a period, and in a tilted box, also by some roundoffs of the period
  /// and of the centres over ri + rj. 0 if there is no pair.
  double max_overlap = 0;
  /// The sphere with the smallest (clearance - r) / r of all; absent if there are no walls, or no spheres.
  /// Outside a box or a cylinder the clearance is that of the worst face.
  std::optional<std::uint64_t> worst_wall;
  /// That ratio in double, with the sign of the exact decision: < 0 if and only if a sphere protrudes. Off by
  /// some roundoffs of the coordinates of centre and walls, or of the size of a triangle, over r; for the
  /// surface of a CAD file by 1e-8, or a millionth of what a piece of it bends over r where that is more, and
  /// by the tolerances of the file. 0 if there is none.
  double min_wall_gap = 0;

  /// If gaps were requested, the least distance between the surfaces of two spheres, and between a sphere and
  /// a wall (negative outside), on the exactly decided side of the requested gap. Absent if it is more than
  /// twice the gap; for walls, more than twice the wall gap and more than the sphere gap.
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
  /// The overlapping pairs and the protruding spheres, up to the requested number: the worst first, ties by
  /// index.
  std::vector<Overlap> overlaps;
  std::vector<Protrusion> protrusions;

  /// What was proven of packings inside of spheres, a level at a time: of all that lie inside the spheres of
  /// a class, see `certify_levels`. What stands above is of the outermost spheres alone.
  struct Level {
    std::string name;            ///< the classes on the way in: "pebble", "pebble / kernel"
    std::uint64_t packings = 0;  ///< each of which was certified once, in its ball
    std::uint64_t packed = 0;    ///< spheres in these
    std::uint64_t filled = 0;    ///< spheres around it that hold one of them, each as often as it stands
    std::uint64_t spheres = 0;   ///< that stand for themselves
    std::uint64_t pairs_tested = 0, walls_tested = 0, decided_double = 0, decided_exact = 0;
    std::uint64_t overlapping_pairs = 0, protruding_spheres = 0;
    /// Filled spheres whose innermost layer is smaller than the ball that they hold, or that hold no packing
    /// which is there, or are turned by no unit quaternion.
    std::uint64_t misplaced = 0;
  };
  std::vector<Level> levels;                ///< none where nothing lies inside
  std::uint64_t spheres_of_all_levels = 0;  ///< with those of the levels, which stand for themselves

  double seconds = 0;
  std::string statement;  ///< one sentence for readers
};

struct CertifyOptions {
  double allowed_overlap = 0;  ///< in [0, 1): the largest overlap ratio that still counts as none
  double gap = 0;              ///< required between spheres, finite and not negative, in the domain's unit
  double wall_gap = 0;         ///< the same, between spheres and walls
  Arithmetic arithmetic = Arithmetic::filtered;
  /// At most this many overlapping pairs and protruding spheres are listed, the worst of each.
  std::size_t list = 0;
  static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  int threads = 0;  ///< 0: those of the caller's arena
  /// The number of spheres (briefly twice that) held in memory besides the given ones. More spheres are
  /// tested slab by slab, each with what reaches into it. This does not affect the answer.
  std::size_t at_once = std::size_t{1} << 21;
  Monitor monitor = {};  ///< hears of pairs, then of walls
};

/// Certifies. It shares no neighbour search, kernel or stage with the packer. The answer is the same for any
/// number of threads. Once the monitor cancels, nothing is certified.
///
/// A sphere with a centre that is not finite, or a radius that is not positive and finite, makes the packing
/// not certified, as the statement says; nothing else is tested then. Throws Error{bad_argument} for columns
/// of different lengths, invalid gaps, spheres of another dimension than the domain, a box whose members
/// differ in dimension, and invalid sizes of a domain; Error{bad_mesh} for a mesh with a boundary.
/// Self-intersection of a mesh is not checked.
///
/// Cost: O(N log N + near pairs), about 0.8 µs a sphere at N = 30,000 and 1 at 10,000,000 on one core, a
/// quarter more in a periodic domain; a mesh of T triangles adds O(T log T), about 0.5 µs each. Exact
/// arithmetic throughout is 4 to 12 times slower. In high dimensions most pairs are near, and the cost is
/// that of all pairs. Memory besides the spheres: about 64 bytes for each sphere of the current slab, 40 for
/// each of the next, and 4 bytes for all if there are several slabs. A list of n takes up to 48 n bytes a
/// thread.
Certificate certify(const Spheres<dynamic>& spheres, const Domain& domain,
                    const CertifyOptions& options = {});

/// Spheres that need not be in memory, such as those of a file.
struct SphereRows {
  std::uint64_t count = 0;
  int dimension = 3;
  /// Fills `rows` from sphere `first` on, one row a sphere: coordinates, then radius. Called from one thread,
  /// for all rows several times, and must return the same each time.
  std::function<void(std::uint64_t first, std::span<double> rows)> read = {};
};

/// The same certificate for spheres that are read in pieces. Memory: at most three times `at_once` spheres,
/// and 0.2 bytes for each of the others. Cost: that of the other overload, plus reading all rows about six
/// times if they are sorted along one coordinate, else once for each slab.
Certificate certify(const SphereRows& spheres, const Domain& domain, const CertifyOptions& options = {});

/// Certifies no more, for a fault that is none of the spheres themselves: the statement begins with it.
void refuse(Certificate&, const std::string& fault);

/// Whether `walls_tested` counts pairs with touching bounding boxes alone, as with the many pieces of meshes,
/// polygons and profiles. Else it counts every sphere with every wall, however far apart they are.
bool walls_tested_are_near(const Domain&);

/// "3 and 7" or "3 and its own image".
std::string pair_text(const std::array<std::uint64_t, 2>& pair);
/// The worst pair as text, or "none".
std::string worst_pair_text(const Certificate&);

}  // namespace bernal
