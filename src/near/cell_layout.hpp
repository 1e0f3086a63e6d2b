#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/vector.hpp"
#include "core/archive.hpp"

namespace bernal {

/// The cells of a background grid, hierarchical in the radius, of a region that is open or repeats itself
/// along each axis: which cell holds a centre, and which cells a search has to look at. What stands in the
/// cells, and how, is for others (`CellGrid`, lists; `SortedCells`, sorted arrays).
///
/// Level l is for spheres with radii in (R_l / 2, R_l], R_l = r_max / 2^l, in cells of edge 2 R_l, so that
/// a search looks at a bounded number of cells of each level however widely the radii differ. A level never
/// has more than about `cells_per_sphere` cells for each expected sphere: where the domain is large and
/// sparse its cells grow instead. Along a periodic axis the cells divide the period evenly, and are the
/// longer for it. Along an open axis centres beyond the bounds count to the border cell; along a periodic one
/// every image of a centre is in the same cell. Cells are numbered level by level, along the first axis
/// fastest.
template <int D>
class CellLayout {
 public:
  struct Level {
    using ArchivedAsBytes = void;
    double largest_radius = 0;
    Vector<D> inverse_edge = Vector<D>::Zero();
    std::array<int, D> cells{};
    std::size_t offset = 0;  ///< the number of its first cell
  };
  /// `count` cells of one axis from `first` on, going round where it repeats itself.
  struct Range {
    int first, count;
  };
  using Block = std::array<Range, D>;

  /// Radii lie in [r_min, r_max], 0 < r_min; `expected` is about how many spheres will come.
  CellLayout(const Bounds<D>& bounds, const Boundary<D>& boundary, double r_min, double r_max,
             std::size_t expected);

  /// See CellGrid::rescale.
  void rescale(const Vector<D>& edges);
  /// What it has been rescaled to.
  void archive(Archive& a) { a(lower_, size_, levels_); }

  const std::vector<Level>& levels() const { return levels_; }
  std::size_t cell_count() const { return cell_count_; }
  std::size_t level_of(double r) const;

  std::uint32_t cell_of(const Level& level, const Vector<D>& c) const {
    std::size_t i = 0;
    for (int k = D - 1; k >= 0; --k)
      i = i * static_cast<std::size_t>(level.cells[k]) + static_cast<std::size_t>(coordinate(level, k, c[k]));
    return static_cast<std::uint32_t>(level.offset + i);
  }

  /// The cells that may hold a centre whose distance from c is below `half` on every axis: at least one, also
  /// where `half` is below 0.
  Block block_around(const Level& level, const Vector<D>& c, double half) const {
    Block block;
    for (int k = 0; k < D; ++k) {
      block[k] = repeats_[k] ? cells_around(level, k, c[k], half) : cells_between(level, k, c[k], half);
      block[k].count = std::max(1, block[k].count);
    }
    return block;
  }

  /// Calls visit(first, end) for the runs of cells with numbers that follow each other, in the order along
  /// the first axis, the second, …, until it returns true. Returns whether it did.
  template <class Visit>
  static bool any_run(const Level& level, const Block& block, Visit&& visit) {
    return any_run_across<D - 1>(level, block, 0, visit);
  }

 private:
  static constexpr double cells_per_sphere = 4;
  static constexpr std::size_t max_levels = 40;
  /// Of an edge: how far a centre may have drifted from its cell by the rounding of some hundred thousand
  /// rescalings.
  static constexpr double drift = 1e-10;

  Level make_level(double largest_radius, double max_cells) const;

  /// Faster than the library's, which is a call where the compiler may not assume SSE 4.
  static double floor_of(double x) {
    if (!(std::abs(x) < 0x1p62)) return x;  // a whole number, or none
    const auto whole = static_cast<double>(static_cast<std::int64_t>(x));
    return whole > x ? whole - 1 : whole;
  }

  template <int K, class Visit>
  static bool any_run_across(const Level& level, const Block& block, std::size_t layer, Visit& visit) {
    const auto cells = static_cast<std::size_t>(level.cells[K]);
    const auto first = static_cast<std::size_t>(block[K].first);
    const std::size_t end = first + static_cast<std::size_t>(block[K].count);
    layer *= cells;
    if constexpr (K == 0) {
      layer += level.offset;
      if (visit(layer + first, layer + std::min(end, cells))) return true;
      return end > cells && visit(layer, layer + end - cells);
    } else {
      for (std::size_t at = first; at < end; ++at)
        if (any_run_across<K - 1>(level, block, layer + (at < cells ? at : at - cells), visit)) return true;
      return false;
    }
  }

  int coordinate(const Level& level, int k, double x) const {
    double cell = (x - lower_[k]) * level.inverse_edge[k];
    const double cells = level.cells[k];
    if (cell >= 0 && cell < cells) return static_cast<int>(cell);
    if (repeats_[k]) cell = std::floor(cell) - cells * std::floor(std::floor(cell) / cells);
    if (!(cell > 0)) return 0;
    return cell < cells ? static_cast<int>(cell) : level.cells[k] - 1;
  }
  Range cells_between(const Level& level, int k, double x, double half) const {
    const int first = coordinate(level, k, x - half);
    return {first, coordinate(level, k, x + half) - first + 1};
  }
  Range cells_around(const Level& level, int k, double x, double half) const {
    half += drift * size_[k];
    x -= lower_[k];
    const double first = floor_of((x - half) * level.inverse_edge[k]);
    const double count = floor_of((x + half) * level.inverse_edge[k]) - first + 1;
    const double cells = level.cells[k];
    if (!(count < cells)) return {0, level.cells[k]};
    if (first >= 0 && first < cells) return {static_cast<int>(first), static_cast<int>(count)};
    return {static_cast<int>(first - cells * std::floor(first / cells)), static_cast<int>(count)};
  }

  Vector<D> lower_, size_;
  std::array<bool, D> repeats_;
  double r_max_;
  std::vector<Level> levels_;
  std::size_t cell_count_ = 0;
};

}  // namespace bernal
