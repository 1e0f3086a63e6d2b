#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bernal/core/vector.hpp"
#include "core/archive.hpp"
#include "core/large_pages.hpp"
#include "hard/prefetch.hpp"

namespace bernal {

/// A background grid of a periodic box that keeps, unlike `CellGrid`, the points and reaches themselves, cell
/// by cell in one piece of memory and in single precision: for points that move now and then and are asked
/// for their neighbours as often, when nothing of it is in the caches.
///
/// Level l holds the points with reaches in (R_l / 2, R_l], R_l = R / 2^l, in cells of edge 2 R_l or more.
/// Cost: `insert` and `move` O(1), a query the points of some 3^D cells a level. Memory: 4 (4 D + 8) + 16
/// bytes a cell, of which there are at most as many as points on each level.
template <int D>
class HomeGrid {
 public:
  using Id = std::uint32_t;

  /// Without points. Ids are below `count`, reaches in [least, most].
  void start(const Vector<D>& edges, double least, double most, std::size_t count) {
    edges_ = edges;
    for (int k = 0; k < D; ++k) inverse_edges_[k] = 1 / edges[k];
    most_ = most;
    margin_ = rounding * edges.sum();
    cell_of_.assign(count, 0);
    levels_.clear();
    std::size_t cells = 0;
    for (double largest = most;; largest /= 2) {
      levels_.push_back(make_level(largest, count, cells));
      if (largest / 2 < least || levels_.size() == most_levels) break;
    }
    cells_.resize(cells);
    for (std::size_t c = 0; c < cells; ++c) cells_[c] = {c * room, 0, room};
    points_.resize(cells * room);
  }

  void archive(Archive& a) { a(edges_, inverse_edges_, most_, margin_, levels_, cells_, points_, cell_of_); }

  void insert(Id id, const Vector<D>& home, double reach) {
    Level& level = level_of(reach);
    ++level.points;
    append(id, cell_at(level, home), home, reach);
  }
  void move(Id id, const Vector<D>& home, double reach) {
    Cell& cell = cells_[cell_of_[id]];
    Point* const begin = points_.data() + cell.begin;
    Point* const at = std::find_if(begin, begin + cell.count, [&](const Point& p) { return p.id == id; });
    *at = begin[cell.count - 1];
    --cell.count;
    append(id, cell_at(level_of(reach), home), home, reach);
  }

  /// Appends every point whose distance, minimum image, is less than the sum of the two reaches, and none
  /// that is farther by more than 3e-7 of the sum of all edges.
  void find_near(const Vector<D>& home, double reach, std::vector<Id>& found) const {
    for_each_cell_near(home, reach, [&](std::size_t c) { find_in(cells_[c], home, reach, found); });
  }
  /// Asks the memory for all that such a query will look at.
  void prefetch_near(const Vector<D>& home, double reach) const {
    for_each_cell_near(home, reach, [&](std::size_t c) {
      bernal::prefetch(&cells_[c]);
      bernal::prefetch(&points_[c * room]);
      bernal::prefetch(&points_[c * room + 3]);
    });
  }

 private:
  static constexpr std::size_t most_levels = 30;
  static constexpr double cells_a_point = 1;
  static constexpr std::uint32_t room = 4;  // of a cell, to begin with
  /// What a reach is longer by, of the sum of all edges: more than rounding to single precision takes from
  /// the distance and from the reach.
  static constexpr double rounding = 1.2e-7;

  struct Point {
    float x[D];
    float reach;
    Id id;
  };
  struct Cell {
    std::size_t begin = 0;
    std::uint32_t count = 0, room = 0;
  };
  struct Level {
    double largest;
    std::array<int, D> cells;
    std::array<double, D> inverse;
    std::size_t begin;
    std::size_t points = 0;
  };

  Level make_level(double largest, std::size_t count, std::size_t& cells) const {
    const double most_cells = std::max(64.0, cells_a_point * static_cast<double>(count));
    Level level{.largest = largest, .cells = {}, .inverse = {}, .begin = cells};
    for (double edge = 2 * largest;; edge *= 1.25) {
      double all = 1;
      for (int k = 0; k < D; ++k) {
        level.cells[k] = static_cast<int>(std::clamp(std::floor(edges_[k] / edge), 1.0, 1e6));
        level.inverse[k] = level.cells[k] / edges_[k];
        all *= level.cells[k];
      }
      if (all > most_cells) continue;
      cells += static_cast<std::size_t>(all);
      return level;
    }
  }
  Level& level_of(double reach) {
    std::size_t l = 0;
    for (double largest = most_ / 2; reach <= largest && l + 1 < levels_.size(); largest /= 2) ++l;
    return levels_[l];
  }
  std::size_t cell_at(const Level& level, const Vector<D>& home) const {
    std::size_t index = 0;
    for (int k = D - 1; k >= 0; --k) {
      const int at = std::clamp(static_cast<int>(home[k] * level.inverse[k]), 0, level.cells[k] - 1);
      index = index * static_cast<std::size_t>(level.cells[k]) + static_cast<std::size_t>(at);
    }
    return level.begin + index;
  }
  void append(Id id, std::size_t c, const Vector<D>& home, double reach) {
    Cell& cell = cells_[c];
    if (cell.count == cell.room) {
      const std::size_t begin = points_.size();
      points_.resize(begin + 2 * std::size_t{cell.room});
      std::copy_n(points_.begin() + static_cast<std::ptrdiff_t>(cell.begin), cell.count,
                  points_.begin() + static_cast<std::ptrdiff_t>(begin));
      cell = {begin, cell.count, 2 * cell.room};
    }
    Point& point = points_[cell.begin + cell.count++];
    for (int k = 0; k < D; ++k) point.x[k] = static_cast<float>(home[k]);
    point.reach = static_cast<float>(reach + margin_);
    point.id = id;
    cell_of_[id] = static_cast<std::uint32_t>(c);
  }
  /// Calls visit(c) for all cells that such points may lie in, row by row.
  template <class Visit>
  void for_each_cell_near(const Vector<D>& home, double reach, Visit&& visit) const {
    for (const Level& level : levels_) {
      if (level.points == 0) continue;
      const double half = reach + level.largest;
      std::array<int, D> first, count, at, step{};
      for (int k = 0; k < D; ++k) {
        const int n = level.cells[k];
        const double from = std::floor((home[k] - half) * level.inverse[k]);
        const double to = std::floor((home[k] + half) * level.inverse[k]);
        count[k] = to - from + 1 < n ? static_cast<int>(to - from) + 1 : n;
        first[k] = to - from + 1 < n ? static_cast<int>(from - n * std::floor(from / n)) : 0;
        at[k] = first[k];
      }
      const int beyond = first[0] + count[0] - level.cells[0];
      for (;;) {
        std::size_t row = 0;
        for (int k = D - 1; k > 0; --k)
          row = (row + static_cast<std::size_t>(at[k])) * static_cast<std::size_t>(level.cells[k - 1]);
        row += level.begin;
        for (int m = first[0]; m < std::min(first[0] + count[0], level.cells[0]); ++m)
          visit(row + static_cast<std::size_t>(m));
        for (int m = 0; m < beyond; ++m) visit(row + static_cast<std::size_t>(m));
        int k = 1;
        for (; k < D; ++k) {
          if (++step[k] < count[k]) {
            if (++at[k] == level.cells[k]) at[k] = 0;
            break;
          }
          step[k] = 0;
          at[k] = first[k];
        }
        if (k == D) break;
      }
    }
  }
  /// Without a branch for each point: about half of them are near.
  void find_in(const Cell& cell, const Vector<D>& home, double reach, std::vector<Id>& found) const {
    constexpr double shift = 0x1.8p52;  // rounds to the nearest whole number
    std::size_t count = found.size();
    found.resize(count + cell.count);
    for (std::size_t m = cell.begin; m < cell.begin + cell.count; ++m) {
      const Point& point = points_[m];
      double squared = 0;
      for (int k = 0; k < D; ++k) {
        double d = double{point.x[k]} - home[k];
        d -= edges_[k] * ((d * inverse_edges_[k] + shift) - shift);
        squared += d * d;
      }
      const double near = reach + point.reach;
      found[count] = point.id;
      count += squared < near * near ? 1 : 0;
    }
    found.resize(count);
  }

  Vector<D> edges_ = Vector<D>::Zero();
  std::array<double, D> inverse_edges_{};
  double most_ = 0;
  double margin_ = 0;  // in all reaches
  std::vector<Level> levels_;
  LargePageVector<Cell> cells_;
  LargePageVector<Point> points_;
  LargePageVector<std::uint32_t> cell_of_;
};

}  // namespace bernal
