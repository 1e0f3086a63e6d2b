#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace bernal {

/// A sphere of the fast relaxation. Its coordinate on axis k is x[k] in units of edge / 2^32. So differences
/// wrap round to the nearest image, and coordinates stay when the box grows. Resolution: 2^-33 of the edge,
/// 1e-8 radii in a box of 10,000 spheres. A radius of NaN means that there is no sphere: it touches nothing.
struct alignas(16) SoftSphere {
  using ArchivedAsBytes = void;
  std::int32_t x[3];
  float r;
};

inline constexpr SoftSphere no_sphere = {{0, 0, 0}, std::numeric_limits<float>::quiet_NaN()};

/// The difference of two coordinates, to the nearest image, in units of the coordinates.
inline std::int32_t steps_between(const SoftSphere& from, const SoftSphere& to, std::size_t k) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to.x[k]) -
                                   static_cast<std::uint32_t>(from.x[k]));
}
/// These units as lengths, in a box with these edges.
inline std::array<float, 3> scale_of(const std::array<double, 3>& edges) {
  std::array<float, 3> scale;
  for (std::size_t k = 0; k < 3; ++k) scale[k] = static_cast<float>(edges[k] * 0x1p-32);
  return scale;
}

/// The number of spheres, none of them neighbours of each other, that move together: a group.
inline constexpr std::size_t lanes = 16;

class SoftWalls;

/// The neighbours of a group: `rows` rows, each with one place for each of its `lanes` spheres.
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
  /// The diameter in edges / 2^32, if all spheres and all edges are equal and there are no walls; else 0.
  float diameter;
  float omega;       ///< over-relaxation: the step is min(omega / contacts, 1) times the sum of overlaps
  SoftWalls* walls;  ///< of a container; null in a periodic box
  bool measure;      ///< whether to find the largest overlap ratio and to fill the next two, if not null
  float* squeeze;    ///< at g * lanes + l, for lane l of group g: the sum of its squared overlap ratios
  float* force;      ///< there, r Σ w (ri + rj - d); null if and only if `squeeze` is
  /// Axes along which the box is shorter than four of the largest radii, one bit each, the first the lowest:
  /// there two spheres may overlap in two images.
  unsigned narrow_axes = 0;
  /// Axes that end at walls, bits as above: there centres keep `wall_share` times their radius away from both
  /// ends, to rounding and never less, or stay in the middle where there is no room for that.
  unsigned walled_axes = 0;
  float wall_share = 1;
};

/// A little more than rounding takes from a radius on its way to a coordinate.
inline constexpr float above_rounding = 1 + 0x1p-21f;
/// The longest distance that a centre keeps from a wall, in units of the coordinates: below half of the edge.
inline constexpr float most_from_wall = 0x1.fffffep30f;

/// The box, or a part of it that is cut out along some axes, in units of the coordinates.
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

/// An axis of a region in equal parts.
class SoftParts {
 public:
  SoftParts(const SoftRegion& region, std::size_t axis, int parts)
      : axis_(axis),
        origin_(region.origin[axis]),
        parts_(parts),
        parts_a_unit_(parts / static_cast<double>(region.extent[axis])) {}

  /// The part that the sphere's centre is in; the last part, if the centre is beyond the region.
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
  std::array<double, 3> cells_a_unit;    ///< cells in a unit of the coordinates
  std::array<double, 3> cells_a_length;  ///< cells in a unit of the radii
  std::size_t first_cell;                ///< in `SearchTask::start`
  std::size_t spheres;
};

struct SearchTask {
  SoftRegion region;  ///< around all spheres; each level divides it into equal cells
  std::array<float, 3> scale;
  float skin;  ///< spheres are neighbours if the gap between them is below twice this
  std::span<const SoftLevel> levels;
  const std::uint32_t* start;  ///< where each cell begins in the next arrays; one entry more than cells
  /// Spheres by level and cell. `lanes` more entries, which are read but not used, follow.
  const std::int32_t *x, *y, *z;
  const float* r;
  const std::uint32_t* places;  ///< their places in the sweep order
};

/// Some spheres that lie close together and share one set of candidates.
struct SearchPart {
  std::array<double, 3> low, high;  ///< bounds of their centres, from the origin of the region, in its units
  float reach;                      ///< the largest of their radii plus twice the skin
  SoftSphere origin;                ///< one of them; coordinates of candidates are relative to it
};

/// Spheres that may be neighbours of those of a part. Coordinates are relative to its origin, in the unit of
/// the radii. Each array has room for all spheres of the task and 2 `lanes` more.
struct Candidates {
  float *x, *y, *z, *r;
  std::uint32_t* places;
};

/// The inner loops of the fast relaxation, compiled for several instruction sets. All do the same operations
/// on the same numbers in the same order, each correctly rounded, so that the results are the same bits. If
/// `SweepTask::diameter` is given and nothing is measured, a sweep has a sixth fewer operations: it needs no
/// radii, and one unit for all axes.
///
/// A sphere meets the nearest image of each neighbour. In a narrow box it also meets the images on the other
/// side of the box along one or more of the `narrow_axes`. If every edge is at least the largest diameter, it
/// can overlap no other image, because all others are at least an edge away; and it can overlap these only
/// where it overlaps the nearest.
struct SoftKernels {
  std::string_view name;

  /// Moves the groups [begin, end) one after the other: each sphere by min(omega / n, 1) Σ w (ri + rj - d) u
  /// over its overlapping neighbours, where u is the unit vector away from the neighbour, w = 2 rj / (ri +
  /// rj) and n = Σ w. The larger sphere of a pair gives way less, so that its large neighbours, and not many
  /// small ones, move a large sphere. With omega = 1 and equal radii these are equations 3 and 4 of Zhao, Li
  /// & Liu (2007). A wall counts as a neighbour with w = 1. `groups` begins with group `first_group`. Returns
  /// the largest overlap ratio (ri + rj - d) / (ri + rj) that it met, if it measures. Precondition: no two
  /// spheres of a group are neighbours. Cost: about 1 ns a neighbour.
  template <class Index>
  using Sweep = float (*)(const SweepTask&, const NeighborRows<Index>* groups, std::size_t begin,
                          std::size_t end);
  Sweep<std::uint32_t> sweep;
  Sweep<std::uint16_t> sweep_short;  ///< the same for at most 2^16 places
  /// Finds the candidates of a part, by level and cell, and returns their number. `lanes` entries behind them
  /// become neighbours of nobody. Precondition: along every axis the part is one point, or no longer than
  /// half of the box less the largest distance of neighbours. Cost: some 100 ns.
  std::size_t (*gather)(const SearchTask&, const SearchPart&, const Candidates& to);
  /// Writes the places of all neighbours of a sphere of the part to `out`, and returns their end. They are
  /// found among the first `count` candidates; `self` is the sphere's own place. It may write `lanes` entries
  /// more. Cost: about 0.2 ns a candidate.
  std::uint32_t* (*search)(const SearchTask&, const SearchPart&, const Candidates& among, std::size_t count,
                           const SoftSphere&, std::uint32_t self, std::uint32_t* out);
};

/// The kernels that this processor can run, the fastest first. The last run on every x86-64.
std::span<const SoftKernels> soft_kernels();

}  // namespace bernal
