#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace bernal {

/// A sphere of the fast relaxation. Its place on axis k is x[k] in units of edge / 2^32, so that differences
/// wrap round to the minimum image by themselves and a growing box leaves the coordinates as they are.
/// Resolution: 2^-33 of the edge, 1e-8 radii in a box of 10,000 spheres. A radius of NaN stands for no
/// sphere: it touches nothing.
struct alignas(16) SoftSphere {
  using ArchivedAsBytes = void;
  std::int32_t x[3];
  float r;
};

inline constexpr SoftSphere no_sphere = {{0, 0, 0}, std::numeric_limits<float>::quiet_NaN()};

/// The short way from one place of a sphere to another, in units of the coordinates.
inline std::int32_t steps_between(const SoftSphere& from, const SoftSphere& to, std::size_t k) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to.x[k]) -
                                   static_cast<std::uint32_t>(from.x[k]));
}
/// These units, in a box of those edges.
inline std::array<float, 3> scale_of(const std::array<double, 3>& edges) {
  std::array<float, 3> scale;
  for (std::size_t k = 0; k < 3; ++k) scale[k] = static_cast<float>(edges[k] * 0x1p-32);
  return scale;
}

/// So many spheres that do not touch each other are moved together.
inline constexpr std::size_t lanes = 16;

class SoftWalls;

/// The neighbours of `lanes` spheres: `rows` rows of one place for each of them.
template <class Index>
struct NeighborRows {
  const Index* first;
  std::uint32_t rows;
};

/// What a sweep works on. Sphere (g - first_group) * lanes + l is lane l of group g.
struct SweepTask {
  SoftSphere* spheres;
  std::size_t first_group;
  std::array<float, 3> scale;  ///< edge / 2^32 on each axis
  /// Where all spheres and all edges are alike and there are no walls: the diameter, in edges / 2^32; else 0.
  float diameter;
  float omega;       ///< over-relaxation: the step is min(omega / contacts, 1) times the sum of overlaps
  SoftWalls* walls;  ///< of a container; null in a periodic box
  bool measure;      ///< the largest overlap ratio, and what has to be filled of these:
  float* squeeze;  ///< receives, of lane l of group g at g * lanes + l, the sum of its squared overlap ratios
  float* force;    ///< receives, with `squeeze`, r Σ w (ri + rj - d); both are null where nobody asks
};

/// A part of the box, cut out of it along some axes, in units of the coordinates of spheres; or all of it.
struct SoftRegion {
  static constexpr std::uint64_t all_round = std::uint64_t{1} << 32;
  std::array<std::uint32_t, 3> origin{};
  std::array<std::uint64_t, 3> extent{all_round, all_round, all_round};

  bool wraps(std::size_t k) const { return extent[k] == all_round; }
  /// From the origin, going round the box.
  std::uint32_t offset(const SoftSphere& s, std::size_t k) const {
    return static_cast<std::uint32_t>(s.x[k]) - origin[k];
  }
};

/// So many equal parts of an axis of a region.
class SoftParts {
 public:
  SoftParts(const SoftRegion& region, std::size_t axis, int parts)
      : axis_(axis),
        origin_(region.origin[axis]),
        parts_(parts),
        parts_a_unit_(parts / static_cast<double>(region.extent[axis])) {}

  /// The one that the sphere's centre is in: the last for what is beyond.
  int at(const SoftSphere& s) const {
    const double at = (static_cast<std::uint32_t>(s.x[axis_]) - origin_) * parts_a_unit_;
    return at < parts_ ? static_cast<int>(at) : parts_ - 1;
  }

 private:
  std::size_t axis_;
  std::uint32_t origin_;
  int parts_;
  double parts_a_unit_;
};

/// One level of the background grid of a region: spheres with radii in (largest / 2, largest], sorted by
/// cell.
struct SoftLevel {
  float largest;
  std::array<int, 3> cells;
  std::array<double, 3> cells_a_unit;    ///< of the coordinates
  std::array<double, 3> cells_a_length;  ///< in that of the radii
  std::size_t first_cell;                ///< in `SearchTask::start`
  std::size_t spheres;
};

struct SearchTask {
  SoftRegion region;  ///< around all that may be searched for; the cells of a level share it equally
  std::array<float, 3> scale;
  float skin;  ///< spheres are neighbours where the gap between them is below twice this
  std::span<const SoftLevel> levels;
  const std::uint32_t* start;  ///< of each cell in what follows; one more than there are cells
  /// Spheres by level and cell; followed by `lanes` more that are read but not used.
  const std::int32_t *x, *y, *z;
  const float* r;
  const std::uint32_t* places;  ///< of these in the sweep order
};

/// Some spheres that lie close together, whose neighbours are searched for among the same others.
struct SearchPart {
  std::array<double, 3> low, high;  ///< around their centres, from the origin of the region, in its units
  float reach;                      ///< the largest of their radii, and twice the skin
  SoftSphere origin;                ///< one of them, which the others are seen from
};

/// Spheres that may be neighbours of those of a part, from its origin on, in the unit of the radii. There is
/// room for all spheres of the task and twice `lanes` more.
struct Candidates {
  float *x, *y, *z, *r;
  std::uint32_t* places;
};

/// The inner loops of the fast relaxation, compiled for several instruction sets. All do the same operations
/// on the same numbers in the same order, one correctly rounded operation at a time: the same bits.
/// Where `SweepTask::diameter` is given and nothing is measured, a sweep has a sixth of its operations less:
/// it needs no radii, and one unit for all axes.
struct SoftKernels {
  std::string_view name;

  /// Moves the groups [begin, end) one after the other: each sphere by min(omega / n, 1) Σ w (ri + rj - d) u
  /// over its overlapping neighbours, u being the unit vector away from the neighbour, w = 2 rj / (ri + rj)
  /// and n = Σ w: of a pair the larger one gives way less, so that a large sphere among many small ones is
  /// moved by its large neighbours (Zhao, Li & Liu 2007, equations 3 and 4, for omega = 1 and equal radii). A
  /// wall counts as a neighbour with w = 1. Precondition: no two spheres of a group are neighbours. Cost:
  /// about 1 ns a neighbour. `groups` begins with
  /// group `first_group`. Where it is to measure, returns the largest overlap ratio (ri + rj - d) / (ri + rj)
  /// that was met.
  template <class Index>
  using Sweep = float (*)(const SweepTask&, const NeighborRows<Index>* groups, std::size_t begin,
                          std::size_t end);
  Sweep<std::uint32_t> sweep;
  Sweep<std::uint16_t> sweep_short;  ///< where there are no more than 2^16 places
  /// Finds the candidates of a part, by level and cell, and puts `lanes` behind them that are nobody's
  /// neighbours; returns how many they are. Precondition: along every axis the part is no longer than
  /// half of the box less the farthest that neighbours may be apart. Cost: some 100 ns.
  std::size_t (*gather)(const SearchTask&, const SearchPart&, const Candidates& to);
  /// Writes the places of all neighbours of a sphere of the part but itself, `self`, among so many candidates
  /// to `out` and returns their end; up to `lanes` more entries are scribbled over. Cost: about 0.2 ns a
  /// candidate.
  std::uint32_t* (*search)(const SearchTask&, const SearchPart&, const Candidates& among, std::size_t count,
                           const SoftSphere&, std::uint32_t self, std::uint32_t* out);
};

/// Those that this processor can run, the fastest first; the last is for every x86-64.
std::span<const SoftKernels> soft_kernels();

}  // namespace bernal
