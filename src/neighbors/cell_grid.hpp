#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"

namespace bernal {

/// A background grid with doubly linked lists, hierarchical in the radius.
///
/// Level l holds the spheres with radii in (R_l / 2, R_l], R_l = r_max / 2^l, in cubic cells of edge 2 R_l,
/// so that a query looks at a bounded number of cells of each level however widely the radii differ. Levels
/// without spheres cost nothing. A level never has more than about `cells_per_sphere` cells for each expected
/// sphere: where the domain is large and sparse its cells grow instead.
///
/// The grid stores ids, not coordinates. Invariant: sphere id is in exactly one list, that of the cell
/// that holds its centre on the level of its radius; centres beyond the bounds count to the border cell.
///
/// Cost: insert, remove, move O(1); a query O(levels + spheres met). Memory: 16 bytes a sphere, 4 a cell.
/// Source: Zhao, Li & Liu 2007, figure 7 (one level).
template <int D>
class CellGrid {
 public:
  using Id = std::uint32_t;
  static constexpr Id none = 0xFFFFFFFF;

  /// Radii to come lie in [r_min, r_max], 0 < r_min; `expected` is about how many spheres will come.
  CellGrid(const Bounds<D>& bounds, double r_min, double r_max, std::size_t expected)
      : bounds_(bounds), r_max_(r_max) {
    const double max_cells = std::max(64.0, cells_per_sphere * static_cast<double>(expected));
    double largest = r_max;
    std::size_t offset = 0;
    for (;;) {
      Level level;
      level.largest_radius = largest;
      level.edge = 2 * largest;
      for (;;) {
        double cells = 1;
        for (int k = 0; k < D; ++k) cells *= std::floor(bounds.size()[k] / level.edge) + 1;
        if (cells <= max_cells) break;
        level.edge *= 1.25;
      }
      level.inverse_edge = 1 / level.edge;
      level.offset = offset;
      std::size_t cells = 1;
      for (int k = 0; k < D; ++k) {
        level.cells[k] = static_cast<int>(std::floor(bounds.size()[k] / level.edge)) + 1;
        cells *= static_cast<std::size_t>(level.cells[k]);
      }
      offset += cells;
      levels_.push_back(level);
      if (largest / 2 < r_min || levels_.size() == max_levels) break;
      largest /= 2;
    }
    heads_.assign(offset, none);
  }

  /// Precondition: `id` is not in the grid, r in [r_min, r_max].
  void insert(Id id, const Vector<D>& center, double r) {
    if (id >= links_.size()) links_.resize(id + std::size_t{1});
    Level& level = levels_[level_of(r)];
    ++level.spheres;
    link(id, cell_of(level, center), static_cast<std::uint8_t>(&level - levels_.data()));
  }

  /// Precondition: `id` is in the grid.
  void remove(Id id) {
    --levels_[links_[id].level].spheres;
    unlink(id);
  }

  /// Tells the grid where sphere `id` is now. Precondition: it is in the grid.
  void move(Id id, const Vector<D>& center) {
    Link& l = links_[id];
    const std::uint32_t cell = cell_of(levels_[l.level], center);
    if (cell == l.cell) return;
    unlink(id);
    link(id, cell, l.level);
  }

  void clear() {
    std::fill(heads_.begin(), heads_.end(), none);
    links_.clear();
    for (Level& level : levels_) level.spheres = 0;
  }

  /// Calls visit(id) until it returns true, for every sphere whose bounding cube, blown up by `reach`, may
  /// hold c: at least for all with max_k |c - c_id|_k < reach + r_id, which includes all whose surface is
  /// nearer than `reach`. Returns whether it returned true.
  template <class Visit>
  bool any_near(const Vector<D>& c, double reach, Visit&& visit) const {
    for (const Level& level : levels_) {
      if (level.spheres == 0) continue;
      const double half = reach + level.largest_radius;
      std::array<int, D> first, last, at;
      for (int k = 0; k < D; ++k) {
        first[k] = coordinate(level, k, c[k] - half);
        last[k] = coordinate(level, k, c[k] + half);
      }
      at = first;
      for (;;) {
        for (Id id = heads_[index(level, at)]; id != none; id = links_[id].next) {
          if (visit(id)) return true;
        }
        int k = 0;
        while (k < D && ++at[k] > last[k]) {
          at[k] = first[k];
          ++k;
        }
        if (k == D) break;
      }
    }
    return false;
  }

  /// As `any_near`, for all of them.
  template <class Visit>
  void for_each_near(const Vector<D>& c, double reach, Visit&& visit) const {
    any_near(c, reach, [&](Id id) {
      visit(id);
      return false;
    });
  }

  std::size_t level_count() const { return levels_.size(); }
  std::size_t cell_count() const { return heads_.size(); }

 private:
  static constexpr double cells_per_sphere = 4;
  static constexpr std::size_t max_levels = 40;

  struct Level {
    double largest_radius = 0;
    double edge = 0;
    double inverse_edge = 0;
    std::array<int, D> cells{};
    std::size_t offset = 0;   // of its first cell in heads_
    std::size_t spheres = 0;  // how many it holds
  };
  struct Link {
    Id next = none;
    Id previous = none;
    std::uint32_t cell = 0;
    std::uint8_t level = 0;
  };

  std::size_t level_of(double r) const {
    std::size_t l = 0;
    for (double largest = r_max_ / 2; r <= largest && l + 1 < levels_.size(); largest /= 2) ++l;
    return l;
  }
  int coordinate(const Level& level, int k, double x) const {
    const double cell = (x - bounds_.lower[k]) * level.inverse_edge;
    if (!(cell > 0)) return 0;
    return cell < level.cells[k] ? static_cast<int>(cell) : level.cells[k] - 1;
  }
  std::size_t index(const Level& level, const std::array<int, D>& at) const {
    std::size_t i = 0;
    for (int k = D - 1; k >= 0; --k)
      i = i * static_cast<std::size_t>(level.cells[k]) + static_cast<std::size_t>(at[k]);
    return level.offset + i;
  }
  std::uint32_t cell_of(const Level& level, const Vector<D>& c) const {
    std::array<int, D> at;
    for (int k = 0; k < D; ++k) at[k] = coordinate(level, k, c[k]);
    return static_cast<std::uint32_t>(index(level, at));
  }
  void link(Id id, std::uint32_t cell, std::uint8_t level) {
    Link& l = links_[id];
    l = {heads_[cell], none, cell, level};
    if (l.next != none) links_[l.next].previous = id;
    heads_[cell] = id;
  }
  void unlink(Id id) {
    const Link& l = links_[id];
    (l.previous == none ? heads_[l.cell] : links_[l.previous].next) = l.next;
    if (l.next != none) links_[l.next].previous = l.previous;
  }

  Bounds<D> bounds_;
  double r_max_;
  std::vector<Level> levels_;
  std::vector<Id> heads_;
  std::vector<Link> links_;
};

}  // namespace bernal
