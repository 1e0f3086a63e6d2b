#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bernal/core/vector.hpp"
#include "core/archive.hpp"
#include "core/large_pages.hpp"
#include "hard/prefetch.hpp"

namespace bernal {

/// A background grid of a periodic box that, unlike `CellGrid`, stores the points and reaches themselves,
/// those of a cell in one cache line: for points that move now and then and query their neighbours as often,
/// with nothing in the caches. It rounds them: positions to 2^-16 of a cell's edge, reaches up to 2^-16 of
/// the cells' largest.
///
/// Benefit: filling it and one query for each point in random order takes 0.8 of the time of a `CellGrid` for
/// 10^4 points in three dimensions, 0.6 for 10^5, 0.45 for 10^6 (tests/bench/near_bench.cpp).
///
/// Level l holds the points with reaches in (R_l / 2, R_l], R_l = R / 2^l, in cells of edge 2 R_l or more.
/// Cost: `insert` and `move` O(1), a query the points of about 3^D cells a level. Memory: 64 bytes a cell (a
/// level has at most half as many cells as points) and for each further line of a crowded cell; 4 a point.
template <int D>
class HomeGrid {
 public:
  using Id = std::uint32_t;

  /// Prepares for points with these reaches.
  void start(const Vector<D>& edges, std::span<const double> reaches) {
    edges_ = edges;
    for (int k = 0; k < D; ++k) inverse_edges_[k] = 1 / edges[k];
    const auto [least, most] = std::ranges::minmax(reaches);
    cell_of_.assign(reaches.size(), 0);
    levels_.clear();
    do levels_.push_back({.largest = std::ldexp(most, -static_cast<int>(levels_.size()))});
    while (levels_.back().largest / 2 >= least && levels_.size() < most_levels);
    for (const double reach : reaches) ++level_of(reach).points;
    std::size_t cells = 0;
    for (Level& level : levels_) cells += divide(level, cells);
    lines_.assign(cells, {});
    free_ = 0;
  }

  void archive(Archive& a) { a(edges_, inverse_edges_, levels_, lines_, free_, cell_of_); }

  void insert(Id id, const Vector<D>& home, double reach) { append(id, level_of(reach), home, reach); }
  void move(Id id, const Vector<D>& home, double reach) {
    remove(id, cell_of_[id]);
    append(id, level_of(reach), home, reach);
  }

  /// Calls visit(id) for every point whose distance, minimum image, is less than the sum of the two reaches,
  /// and for none that is farther by more than `coarseness` cells' edges.
  template <class Visit>
  void for_each_near(const Vector<D>& home, double reach, Visit&& visit) const {
    for_each_cell_near(home, reach,
                       [&](const Level& level, std::size_t c, const auto& corner, bool all_around) {
                         if (all_around)
                           for_each_in<true>(level, c, corner, reach, visit);
                         else
                           for_each_in<false>(level, c, corner, reach, visit);
                       });
  }
  /// Prefetches the memory for such a query.
  void prefetch_near(const Vector<D>& home, double reach) const {
    for_each_cell_near(home, reach,
                       [&](const Level&, std::size_t c, const auto&, bool) { bernal::prefetch(&lines_[c]); });
  }

  static constexpr double coarseness = 5.0 / (1 << 16);

 private:
  static constexpr std::size_t most_levels = 30;
  static constexpr double cells_a_point = 0.5;
  static constexpr double steps = 1 << 16, reach_steps = steps - 2;  // of a cell's edge, of the largest reach
  static constexpr std::uint32_t a_line = 60 / (2 * D + 6);

  /// The points of a cell. If there are too many, the others are in further lines, all of them full, chained
  /// to the cell's own.
  struct alignas(64) Line {
    using ArchivedAsBytes = void;
    std::uint32_t count : 3 = 0, next : 29 = 0;  // next: 0 if none
    Id ids[a_line] = {};
    std::uint16_t x[a_line][D] = {};
    std::uint16_t reach[a_line] = {};
  };
  static_assert(sizeof(Line) == 64);

  struct Level {
    using ArchivedAsBytes = void;
    double largest;
    std::size_t points = 0;
    std::array<int, D> cells = {};
    std::array<double, D> inverse = {}, width = {};  // of a cell's edge
    double margin = 0;  // added to the sum of two reaches, because positions are rounded
    std::size_t begin = 0;
  };

  /// Divides a level into cells, numbered from `begin`. Returns their number.
  std::size_t divide(Level& level, std::size_t begin) const {
    const double most_cells = std::max(64.0, cells_a_point * static_cast<double>(level.points));
    level.begin = begin;
    for (double edge = 2 * level.largest;; edge *= 1.25) {
      double all = 1, squared = 0;
      for (int k = 0; k < D; ++k) {
        level.cells[k] = static_cast<int>(std::clamp(std::floor(edges_[k] / edge), 1.0, 1e6));
        level.inverse[k] = level.cells[k] / edges_[k];
        level.width[k] = edges_[k] / level.cells[k];
        squared += level.width[k] * level.width[k];
        all *= level.cells[k];
      }
      if (all > most_cells) continue;
      level.margin = std::sqrt(squared) / steps;  // twice half a step, with a reserve for rounding
      return static_cast<std::size_t>(all);
    }
  }
  Level& level_of(double reach) {
    std::size_t l = 0;
    while (l + 1 < levels_.size() && reach <= levels_[l + 1].largest) ++l;
    return levels_[l];
  }

  void append(Id id, const Level& level, const Vector<D>& home, double reach) {
    std::size_t c = 0;
    std::array<std::uint16_t, D> x;
    for (int k = D - 1; k >= 0; --k) {
      const double place = home[k] * level.inverse[k];
      const int at = std::clamp(static_cast<int>(place), 0, level.cells[k] - 1);
      c = c * static_cast<std::size_t>(level.cells[k]) + static_cast<std::size_t>(at);
      x[k] = static_cast<std::uint16_t>(std::clamp((place - at) * steps, 0.0, steps - 1));
    }
    c += level.begin;
    if (lines_[c].count == a_line) {
      const std::uint32_t chained = take_line();
      lines_[chained] = lines_[c];
      lines_[c] = {.count = 0, .next = chained};
    }
    Line& line = lines_[c];
    line.ids[line.count] = id;
    std::copy_n(x.begin(), D, line.x[line.count]);
    line.reach[line.count] = static_cast<std::uint16_t>(reach / level.largest * reach_steps + 1);
    ++line.count;
    cell_of_[id] = static_cast<std::uint32_t>(c);
  }
  /// Replaces it by the last point of the cell's own line.
  void remove(Id id, std::size_t c) {
    Line& line = lines_[c];
    const std::uint32_t last = line.count - 1;
    for (Line* at = &line;; at = &lines_[at->next]) {
      const Id* const found = std::find(at->ids, at->ids + at->count, id);
      if (found == at->ids + at->count) continue;
      const auto m = found - at->ids;
      at->ids[m] = line.ids[last];
      std::copy_n(line.x[last], D, at->x[m]);
      at->reach[m] = line.reach[last];
      break;
    }
    line.count = last;
    if (last > 0 || line.next == 0) return;
    const std::uint32_t chained = line.next;
    line = lines_[chained];
    lines_[chained].next = free_;
    free_ = chained;
  }
  std::uint32_t take_line() {
    if (free_ == 0) {
      lines_.emplace_back();
      return static_cast<std::uint32_t>(lines_.size() - 1);
    }
    return std::exchange(free_, std::uint32_t{lines_[free_].next});
  }
  /// Calls visit(level, c, corner, all_around) for all cells that may contain near points, row by row. The
  /// corner is the cell's lower one relative to home, in its near image. If the cells span the box along some
  /// axis there may be two near images; otherwise each point has only one.
  template <class Visit>
  void for_each_cell_near(const Vector<D>& home, double reach, Visit&& visit) const {
    for (const Level& level : levels_) {
      if (level.points == 0) continue;
      const double half = reach + level.largest + level.margin;
      bool all_around = false;
      std::array<int, D> count, start, at, step{};
      std::array<double, D> lowest, corner;
      for (int k = 0; k < D; ++k) {
        const int n = level.cells[k];
        const double from = std::floor((home[k] - half) * level.inverse[k]);
        const double to = std::floor((home[k] + half) * level.inverse[k]);
        all_around |= to - from + 1 >= n;
        count[k] = to - from + 1 < n ? static_cast<int>(to - from) + 1 : n;
        at[k] = start[k] = static_cast<int>(from - n * std::floor(from / n));
        corner[k] = lowest[k] = from * level.width[k] - home[k];
      }
      for (;;) {
        std::size_t row = 0;
        for (int k = D - 1; k > 0; --k)
          row = (row + static_cast<std::size_t>(at[k])) * static_cast<std::size_t>(level.cells[k - 1]);
        row += level.begin;
        corner[0] = lowest[0];
        for (int m = 0, x = start[0]; m < count[0]; ++m, corner[0] += level.width[0]) {
          visit(level, row + static_cast<std::size_t>(x), corner, all_around);
          if (++x == level.cells[0]) x = 0;
        }
        int k = 1;
        for (; k < D; ++k) {
          if (++step[k] < count[k]) {
            corner[k] = lowest[k] + step[k] * level.width[k];
            if (++at[k] == level.cells[k]) at[k] = 0;
            break;
          }
          step[k] = 0;
          corner[k] = lowest[k];
          at[k] = start[k];
        }
        if (k == D) break;
      }
    }
  }
  /// Visits the near points of a cell. Those of a line are found without a branch for each point, because
  /// about half of them are near.
  template <bool all_around, class Visit>
  void for_each_in(const Level& level, std::size_t c, const std::array<double, D>& corner, double reach,
                   Visit& visit) const {
    constexpr double shift = 0x1.8p52;  // rounds to the nearest whole number
    const double longer = reach + level.margin, reach_step = level.largest / reach_steps;
    std::array<double, D> step, from;  // from: the middle of the first step
    for (int k = 0; k < D; ++k) {
      step[k] = level.width[k] / steps;
      from[k] = corner[k] + 0.5 * step[k];
    }
    for (const Line* line = &lines_[c];; line = &lines_[line->next]) {
      Id near[a_line];
      std::uint32_t count = 0;
      for (std::uint32_t m = 0; m < line->count; ++m) {
        double squared = 0;
        for (int k = 0; k < D; ++k) {
          double d = from[k] + line->x[m][k] * step[k];
          if constexpr (all_around) d -= edges_[k] * ((d * inverse_edges_[k] + shift) - shift);
          squared += d * d;
        }
        const double apart = longer + line->reach[m] * reach_step;
        near[count] = line->ids[m];
        count += squared < apart * apart ? 1 : 0;
      }
      for (std::uint32_t n = 0; n < count; ++n) visit(near[n]);
      if (line->next == 0) break;
    }
  }

  Vector<D> edges_ = Vector<D>::Zero();
  std::array<double, D> inverse_edges_{};
  std::vector<Level> levels_;
  LargePageVector<Line> lines_;  // of all cells, then further ones
  std::uint32_t free_ = 0;       // first unused further line; 0: none
  LargePageVector<std::uint32_t> cell_of_;
};

}  // namespace bernal
