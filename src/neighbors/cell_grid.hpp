#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"
#include "bernal/domain/boundary.hpp"

namespace bernal {

/// A background grid with doubly linked lists, hierarchical in the radius, of a region that is open or
/// repeats itself along each axis.
///
/// Level l holds the spheres with radii in (R_l / 2, R_l], R_l = r_max / 2^l, in cells of edge 2 R_l, so that
/// a query looks at a bounded number of cells of each level however widely the radii differ. Levels without
/// spheres cost nothing. A level never has more than about `cells_per_sphere` cells for each expected sphere:
/// where the domain is large and sparse its cells grow instead. Along a periodic axis the cells divide the
/// period evenly, and are the longer for it.
///
/// The grid stores ids, not coordinates. Invariant: sphere id is in exactly one list, that of the cell
/// that holds its centre on the level of its radius. Along an open axis centres beyond the bounds count to
/// the border cell; along a periodic one every image of a centre is in the same cell.
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
      : CellGrid(bounds, {}, r_min, r_max, expected) {}
  /// Of a box that is periodic on every axis k: all edges are above 0.
  CellGrid(const Boundary<D>& box, double r_min, double r_max, std::size_t expected)
      : CellGrid({box.origin, box.origin + box.edges}, box, r_min, r_max, expected) {}
  /// Of a region within `bounds` along the open axes, and of a period along the others.
  CellGrid(const Bounds<D>& bounds, const Boundary<D>& boundary, double r_min, double r_max,
           std::size_t expected);

  /// A box [0, edge) that is periodic on every axis and all centres have been multiplied by the same factor
  /// on each axis; the box has these edges now. Spheres stay in their cells. Radii have not changed: what a
  /// query finds is what is near in the new box. Cost: O(levels).
  void rescale(const Vector<D>& edges);

  /// Precondition: `id` is not in the grid, r in [r_min, r_max].
  void insert(Id id, const Vector<D>& center, double r);

  /// Precondition: `id` is in the grid.
  void remove(Id id);

  /// Tells the grid where sphere `id` is now. Precondition: it is in the grid.
  void move(Id id, const Vector<D>& center) {
    Link& l = links_[id];
    const std::uint32_t cell = cell_of(levels_[l.level], center);
    if (cell == l.cell) return;
    unlink(id);
    link(id, cell, l.level);
  }

  void clear();

  /// Calls visit(id) until it returns true, for every sphere whose bounding cube, blown up by `reach`, may
  /// hold c: at least for all with max_k |c - c_id|_k < reach + r_id, which includes all whose surface is
  /// nearer than `reach`. Along periodic axes that means any image of the sphere; none is visited twice.
  /// Returns whether it returned true.
  template <class Visit>
  bool any_near(const Vector<D>& c, double reach, Visit&& visit) const {
    if constexpr (D == 2 || D == 3) return walk(c, reach, visit);
    using Plain = std::remove_reference_t<Visit>;
    return search(
        c, reach, [](void* it, Id id) -> bool { return (*static_cast<Plain*>(it))(id); },
        const_cast<void*>(static_cast<const void*>(std::addressof(visit))));
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
  /// Of an edge: how far a centre may have drifted from its cell by the rounding of some hundred thousand
  /// rescalings.
  static constexpr double drift = 1e-10;

  struct Level {
    double largest_radius = 0;
    Vector<D> inverse_edge = Vector<D>::Zero();
    std::array<int, D> cells{};
    std::size_t offset = 0;   // of its first cell in heads_
    std::size_t spheres = 0;  // how many it holds
  };
  /// `count` cells of one axis from `first` on, going round where it repeats itself.
  struct Range {
    int first, count;
  };
  struct Link {
    Id next = none;
    Id previous = none;
    std::uint32_t cell = 0;
    std::uint8_t level = 0;
  };

  template <class Visit>
  bool walk(const Vector<D>& c, double reach, Visit&& visit) const {
    for (const Level& level : levels_) {
      if (level.spheres == 0) continue;
      const double half = reach + level.largest_radius;
      std::array<Range, D> range;
      std::array<int, D> at, step{};
      for (int k = 0; k < D; ++k) {
        range[k] = repeats_[k] ? cells_around(level, k, c[k], half) : cells_between(level, k, c[k], half);
        at[k] = range[k].first;
      }
      for (;;) {
        for (Id id = heads_[index(level, at)]; id != none; id = links_[id].next) {
          if (visit(id)) return true;
        }
        int k = 0;
        for (; k < D; ++k) {
          if (++step[k] < range[k].count) {
            if (++at[k] == level.cells[k]) at[k] = 0;
            break;
          }
          step[k] = 0;
          at[k] = range[k].first;
        }
        if (k == D) break;
      }
    }
    return false;
  }

  /// The same, compiled once for every dimension in which the 3^D cells cost more than a call for each
  /// sphere.
  bool search(const Vector<D>& c, double reach, bool (*visitor)(void* it, Id id), void* it) const;

  /// Appends its cells behind `offset`, and moves that.
  Level make_level(double largest_radius, double max_cells, std::size_t& offset) const;

  std::size_t level_of(double r) const;
  int coordinate(const Level& level, int k, double x) const {
    double cell = (x - lower_[k]) * level.inverse_edge[k];
    const double cells = level.cells[k];
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
    const double first = std::floor((x - half) * level.inverse_edge[k]);
    const double count = std::floor((x + half) * level.inverse_edge[k]) - first + 1;
    if (!(count < level.cells[k])) return {0, level.cells[k]};
    const double cells = level.cells[k];
    return {static_cast<int>(first - cells * std::floor(first / cells)), static_cast<int>(count)};
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

  Vector<D> lower_, size_;
  std::array<bool, D> repeats_;
  double r_max_;
  std::vector<Level> levels_;
  std::vector<Id> heads_;
  std::vector<Link> links_;
};

}  // namespace bernal
