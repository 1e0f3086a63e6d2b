#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"
#include "core/parallel.hpp"
#include "near/counting_sort.hpp"

namespace bernal {

/// Points sorted by the cells of a grid, so that what is near in space is near in memory: for searches among
/// points that stay where they are, of any reach. Knows periodic axes, and visits *images*: in a box that is
/// shorter than the reach the same point comes once for every image of it that is near, the point itself
/// included.
///
/// What it buys: to be filled and asked once for each point takes 0.65 of the time of a `CellGrid` for 10^4
/// points in three dimensions, 0.5 for 10^5, a quarter in five dimensions (tests/bench/near_bench.cpp).
///
/// Invariant: the points of cell c are those from start_[c] to start_[c + 1]; neighbours along the first axis
/// follow each other. Cost: making it O(N); a query O(cells that the ball meets + points in them). Memory:
/// 8 D + 4 bytes a point, 4 a cell, at most two cells a point.
template <int D>
class PointGrid {
 public:
  using Id = std::uint32_t;

  /// The centres of the spheres `ids`. `edge` > 0 is the least edge of a cell: about the reach of the queries
  /// to come, or a third of it where a cell would hold many points.
  PointGrid(const Spheres<D>& spheres, std::span<const Id> ids, const Boundary<D>& boundary, double edge)
      : boundary_(boundary) {
    constexpr std::size_t grain = 1 << 14;
    const auto point_of = [&](Id id) { return boundary.wrap(spheres.center(id)); };
    lay_cells(ids, point_of, edge);
    std::vector<std::uint32_t> place(ids.size());
    parallel_ranges(ids.size(), grain, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) place[i] = cell_of(point_of(ids[i]));
    });
    counting_sort(place, cell_count_, start_);
    ids_.resize(ids.size());
    for (auto& column : x_) column.resize(ids.size());
    parallel_ranges(ids.size(), grain, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const Vector<D> p = point_of(ids[i]);
        ids_[place[i]] = ids[i];
        for (int k = 0; k < D; ++k) x_[k][place[i]] = p[k];
      }
    });
  }

  /// The centres of all spheres.
  PointGrid(const Spheres<D>& spheres, const Boundary<D>& boundary, double edge)
      : PointGrid(spheres, first_ids(spheres.size()), boundary, edge) {}

  /// The ids in the order of the cells: whoever asks for all of them in this order stays in the cache.
  std::span<const Id> ids() const { return ids_; }
  /// The point at that place of the order, wrapped into the box.
  Vector<D> point(std::size_t place) const {
    Vector<D> p;
    for (int k = 0; k < D; ++k) p[k] = x_[k][place];
    return p;
  }

  /// Calls visit(id, image of the point - c) at least for every image nearer than `reach` to c, which lies in
  /// the box where axes are periodic.
  template <class Visit>
  void for_each_near(const Vector<D>& c, double reach, Visit&& visit) const {
    const double wide = reach * (1 + 1e-9);
    Vector<D> shift = Vector<D>::Zero();
    visit_axis<D - 1>(c, wide * wide, 0, shift, visit);
  }

 private:
  static constexpr double cells_per_point = 2;

  static std::vector<Id> first_ids(std::size_t count) {
    std::vector<Id> ids(count);
    std::iota(ids.begin(), ids.end(), Id{0});
    return ids;
  }

  template <class PointOf>
  void lay_cells(std::span<const Id> ids, const PointOf& point_of, double edge) {
    Vector<D> upper = Vector<D>::Zero();
    if (!ids.empty()) lower_ = upper = point_of(ids.front());
    for (const Id id : ids) {
      const Vector<D> p = point_of(id);
      lower_ = lower_.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    Vector<D> size = upper - lower_;
    for (int k = 0; k < D; ++k) {
      if (!(boundary_.edges[k] > 0)) continue;
      lower_[k] = boundary_.origin[k];
      size[k] = boundary_.edges[k];
    }
    const double most = std::max(1.0, cells_per_point * static_cast<double>(ids.size()));
    double cells = 0;
    edge = std::max(edge, 1e-12 / most * size.maxCoeff());  // or it takes long, or for ever, to be as large
    for (;; edge *= 1.1) {
      cells = 1;
      for (int k = 0; k < D; ++k) {
        const double along = std::clamp(std::floor(size[k] / edge), 1.0, most + 1);
        cells_[k] = static_cast<std::int64_t>(along);
        cells *= along;
      }
      if (cells <= most) break;
    }
    for (int k = 0; k < D; ++k) cell_edge_[k] = size[k] > 0 ? size[k] / static_cast<double>(cells_[k]) : edge;
    cell_count_ = static_cast<std::size_t>(cells);
  }

  std::int64_t unwrapped(int k, double x) const {
    // The floor, faster than the library's, which is a call where the compiler may not assume SSE 4.
    const double cell = std::clamp((x - lower_[k]) / cell_edge_[k], -0x1p62, 0x1p62);
    const auto whole = static_cast<std::int64_t>(cell);
    return static_cast<double>(whole) > cell ? whole - 1 : whole;
  }
  std::uint32_t cell_of(const Vector<D>& p) const {
    std::int64_t cell = 0;
    for (int k = D - 1; k >= 0; --k) {
      cell = cell * cells_[k] + std::clamp<std::int64_t>(unwrapped(k, p[k]), 0, cells_[k] - 1);
    }
    return static_cast<std::uint32_t>(cell);
  }

  /// All layers of cells across axis k that the ball meets; `squared` is what is left of its squared radius
  /// there, `cell` the index of the layer among those of the higher axes.
  template <int K, class Visit>
  void visit_axis(const Vector<D>& c, double squared, std::int64_t cell, Vector<D>& shift,
                  Visit& visit) const {
    // Points may lie a rounding beyond the cell that they are in, along each axis by its own: next to one
    // that is 1e19 long, that of the longest would be a multitude of cells.
    const double rounding = 1e-12 * cell_edge_[K], half = std::sqrt(squared) + rounding;
    std::int64_t first = unwrapped(K, c[K] - half), last = unwrapped(K, c[K] + half);
    const std::int64_t n = cells_[K];
    const bool periodic = boundary_.edges[K] > 0;
    if (!periodic) {
      first = std::clamp<std::int64_t>(first, 0, n - 1);
      last = std::clamp<std::int64_t>(last, 0, n - 1);
    }
    for (std::int64_t at = first; at <= last;) {
      const bool beyond = periodic && (at < 0 || at >= n);
      const std::int64_t turn = !beyond ? 0 : at >= 0 ? at / n : -((n - 1 - at) / n);
      shift[K] = static_cast<double>(turn) * boundary_.edges[K];
      if constexpr (K == 0) {  // what lies in one box is one run of points
        const std::int64_t end = std::min(last, turn * n + n - 1);
        visit_run(start_[static_cast<std::size_t>(cell * n + at - turn * n)],
                  start_[static_cast<std::size_t>(cell * n + end - turn * n) + 1], c - shift, visit);
        at = end + 1;
      } else {
        const double near = lower_[K] + static_cast<double>(at) * cell_edge_[K];
        const double away = std::max({0.0, near - c[K] - rounding, c[K] - near - cell_edge_[K] - rounding});
        const double rest = squared - away * away;
        if (rest > 0) visit_axis<K - 1>(c, rest, cell * n + at - turn * n, shift, visit);
        ++at;
      }
    }
  }

  template <class Visit>
  void visit_run(std::uint32_t first, std::uint32_t last, const Vector<D>& from, Visit& visit) const {
    for (std::uint32_t p = first; p < last; ++p) visit(ids_[p], Vector<D>(point(p) - from));
  }

  Boundary<D> boundary_;
  Vector<D> lower_ = Vector<D>::Zero();
  Vector<D> cell_edge_ = Vector<D>::Ones();
  std::array<std::int64_t, D> cells_{};
  std::size_t cell_count_ = 1;
  std::vector<std::uint32_t> start_;
  std::vector<Id> ids_;
  std::array<std::vector<double>, D> x_;
};

}  // namespace bernal
