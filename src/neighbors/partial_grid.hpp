#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"
#include "neighbors/counting_sort.hpp"

namespace bernal {

/// Spheres sorted by the cells of a grid over only the first few axes, for searches of one reach in any
/// dimension. Beyond three or four dimensions the 3^D cells around a point are more than the spheres that are
/// there; a column of cells without end along the other axes holds them one after the other, which the
/// processor takes several at a time. No axis at all is the comparison of all pairs.
///
/// The axes are those of a box [0, edge); where one repeats itself, distances are those to the nearest image.
/// Spheres may move after `sort`: `update` takes their places, and queries look `slack` farther. Those that
/// `add` brings stay unsorted, and every query looks at all of them: sort again when they become many.
///
/// Cost: sort O(N); a query about 3^k cells and N (3 reach / edge)^k spheres for k axes; k is that of the
/// least `cost_of` if it is left to the grid. Memory: 8 D + 12 bytes a sphere.
template <int D>
class PartialGrid {
 public:
  using Id = std::uint32_t;
  static constexpr int automatic = -1;

  /// What a query costs on k axes, in comparisons of two spheres, when on each axis it opens so many of so
  /// many cells: a row of cells along the first axis costs as much to open as looking at eight spheres
  /// (measured in 2 to 8 dimensions with 100 to 30,000 spheres; the choice was within a fifth of the best).
  static double cost_of(int k, const std::array<double, D>& opened, const std::array<double, D>& cells,
                        double spheres) {
    double rows = k > 0 ? 8 : 0, met = spheres;
    for (int axis = 0; axis < k; ++axis) {
      if (axis > 0) rows *= opened[axis];
      met *= opened[axis] / cells[axis];
    }
    return rows + met;
  }

  /// `repeats[k]` says whether axis k is periodic. No query will reach farther than `reach` and `slack`.
  PartialGrid(const Vector<D>& edges, const std::array<bool, D>& repeats, double reach, double slack,
              std::size_t expected, int axes = automatic)
      : repeats_(repeats), slack_(slack) {
    std::array<double, D> cells, opened;
    for (int k = 0; k < D; ++k) {
      cells[k] = std::clamp(std::floor(edges[k] / (reach + slack)), 1.0, most_cells_along_an_axis);
      opened[k] = std::min(cells[k], 1 + 2 * (reach + slack) * cells[k] / edges[k]);
      period_[k] = repeats[k] ? edges[k] : std::numeric_limits<double>::infinity();
    }
    const auto spheres = static_cast<double>(expected);
    axes_ = std::min(axes, D);
    if (axes == automatic) {
      axes_ = 0;
      double least = cost_of(0, opened, cells, spheres);
      for (int k = 1; k <= D; ++k) {
        const double cost = cost_of(k, opened, cells, spheres);
        if (cost >= least) continue;
        axes_ = k;
        least = cost;
      }
    }
    // A box that is almost empty: cells of no use are not made.
    double all = 1;
    for (int k = 0; k < std::min(axes_, D); ++k) {
      const double most = std::max(3.0, std::floor(std::max(64.0, 4 * spheres) / all));
      cells_[k] = static_cast<int>(std::min(cells[k], most));
      all *= cells_[k];
      per_length_[k] = cells_[k] / edges[k];
    }
    start_.assign(static_cast<std::size_t>(all) + 1, 0);
  }

  int axes() const { return axes_; }
  std::size_t size() const { return ids_.size(); }
  /// How many came by `add` since the last `sort`.
  std::size_t unsorted() const { return ids_.size() - start_.back(); }

  /// Takes the first `n` spheres, with their places.
  template <class Columns>
  void sort(const Columns& x, const std::vector<double>& r, std::size_t n) {
    std::vector<std::uint32_t> slot(n);
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t index = 0;
      for (int k = std::min(axes_, D) - 1; k >= 0; --k)
        index = index * static_cast<std::size_t>(cells_[k]) + coordinate(k, place(x, k, i));
      slot[i] = static_cast<std::uint32_t>(index);
    }
    counting_sort(slot, start_.size() - 1, start_);
    ids_.resize(n);
    r_.resize(n);
    for (std::size_t i = 0; i < n; ++i) ids_[slot[i]] = static_cast<Id>(i);
    for (std::size_t s = 0; s < n; ++s) r_[s] = r[ids_[s]];
    for (auto& column : x_) column.resize(n);
    update(x);
  }

  /// The places of all spheres now, none of them farther than `slack` from where it was sorted.
  template <class Columns>
  void update(const Columns& x) {
    for (int k = 0; k < D; ++k)
      for (std::size_t s = 0; s < ids_.size(); ++s) x_[k][s] = place(x, k, ids_[s]);
  }

  /// Sphere `size()`.
  void add(const Vector<D>& c, double r) {
    for (int k = 0; k < D; ++k) x_[k].push_back(c[k]);
    r_.push_back(r);
    ids_.push_back(static_cast<Id>(ids_.size()));
  }

  /// Calls visit(id, squared distance of the nearest images) until it returns true for spheres with a surface
  /// nearer than `reach` to c, a component of which may be up to half an edge outside the box. Returns
  /// whether it returned true.
  template <class Visit>
  bool any_near(const Vector<D>& c, double reach, Visit&& visit) const {
    return any_run(c, reach + largest_, [&](std::size_t first, std::size_t last) {
      return look_at(c, reach, first, last, visit);
    });
  }

  /// The same for all of them.
  template <class Visit>
  void for_each_near(const Vector<D>& c, double reach, Visit&& visit) const {
    any_near(c, reach, [&](Id id, double squared) {
      visit(id, squared);
      return false;
    });
  }

  /// No sphere is larger; every query reaches so much farther.
  void set_largest(double r) { largest_ = r; }

 private:
  static constexpr double most_cells_along_an_axis = 1 << 20;
  static constexpr std::size_t block = 32;

  template <class Columns>
  static double place(const Columns& x, int k, std::size_t i) {
    if constexpr (requires { x.col(k); }) {
      return x(static_cast<Eigen::Index>(i), k);
    } else {
      return x[static_cast<std::size_t>(k)][i];
    }
  }

  std::size_t coordinate(int k, double x) const {
    double cell = std::floor(x * per_length_[k]);
    if (repeats_[k]) cell -= cells_[k] * std::floor(cell / cells_[k]);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, cells_[k] - 1.0));
  }

  /// Spheres `first` to `last` of the order, of which one calls.
  template <class Visit>
  bool look_at(const Vector<D>& c, double reach, std::size_t first, std::size_t last, Visit& visit) const {
    double squared[block];
    for (; first < last; first += block) {
      const std::size_t n = std::min(block, last - first);
      std::fill(squared, squared + n, 0.0);
      for (int k = 0; k < D; ++k) {
        const double* const x = x_[k].data() + first;
        for (std::size_t s = 0; s < n; ++s) {
          const double direct = std::abs(c[k] - x[s]);
          const double d = std::min(direct, period_[k] - direct);
          squared[s] += d * d;
        }
      }
      for (std::size_t s = 0; s < n; ++s) {
        const double limit = reach + r_[first + s];
        if (squared[s] < limit * limit && visit(ids_[first + s], squared[s])) return true;
      }
    }
    return false;
  }

  /// Calls visit(first, last) for stretches of the order that hold all with |c - x|_k < half on every axis of
  /// the grid, until it returns true.
  template <class Visit>
  bool any_run(const Vector<D>& c, double half, Visit&& visit) const {
    const int axes = std::min(axes_, D);  // for the compiler, which warns of D = 1 otherwise
    if (axes == 0) return visit(0, ids_.size());
    std::array<int, D> first, count, step;
    first.fill(0);
    count.fill(1);
    step.fill(0);
    for (int k = 0; k < axes; ++k) {
      const double low = std::floor((c[k] - half - slack_) * per_length_[k]);
      const double high = std::floor((c[k] + half + slack_) * per_length_[k]);
      if (repeats_[k]) {
        const bool all = high - low + 1 >= cells_[k];
        first[k] = all ? 0 : static_cast<int>(low - cells_[k] * std::floor(low / cells_[k]));
        count[k] = all ? cells_[k] : static_cast<int>(high - low) + 1;
      } else {
        first[k] = static_cast<int>(std::clamp(low, 0.0, cells_[k] - 1.0));
        count[k] = static_cast<int>(std::clamp(high, 0.0, cells_[k] - 1.0)) - first[k] + 1;
      }
    }
    for (;;) {
      std::size_t row = 0;
      for (int k = axes - 1; k > 0; --k) {
        const int at = first[k] + step[k];
        row = row * static_cast<std::size_t>(cells_[k]) +
              static_cast<std::size_t>(at < cells_[k] ? at : at - cells_[k]);
      }
      row *= static_cast<std::size_t>(cells_[0]);
      // Along the first axis cells follow each other, but for the one step from the last to the first.
      const int beyond = first[0] + count[0] - cells_[0];
      const auto begin = row + static_cast<std::size_t>(first[0]);
      const auto end = row + static_cast<std::size_t>(std::min(first[0] + count[0], cells_[0]));
      if (visit(start_[begin], start_[end])) return true;
      if (beyond > 0 && visit(start_[row], start_[row + static_cast<std::size_t>(beyond)])) return true;
      int k = 1;
      for (; k < axes; ++k) {
        if (++step[k] < count[k]) break;
        step[k] = 0;
      }
      if (k >= axes) break;
    }
    return visit(start_.back(), ids_.size());
  }

  std::array<bool, D> repeats_;
  Vector<D> period_;
  double slack_;
  double largest_ = 0;
  int axes_ = 0;
  std::array<int, D> cells_{};
  std::array<double, D> per_length_{};
  std::vector<std::uint32_t> start_;  // of each cell, and the number of those that are sorted
  std::array<std::vector<double>, D> x_;
  std::vector<double> r_;
  std::vector<Id> ids_;
};

}  // namespace bernal
