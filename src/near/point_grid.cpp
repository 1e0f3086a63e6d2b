#include "near/point_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/every_dimension.hpp"
#include "core/parallel.hpp"
#include "near/counting_sort.hpp"

namespace bernal {
namespace {

constexpr double cells_per_point = 2;

std::vector<std::uint32_t> first_ids(std::size_t count) {
  std::vector<std::uint32_t> ids(count);
  std::iota(ids.begin(), ids.end(), 0u);
  return ids;
}

}  // namespace

template <int D>
PointGrid<D>::PointGrid(const Spheres<D>& spheres, std::span<const Id> ids, const TiltedBoundary<D>& boundary,
                        double edge)
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

template <int D>
PointGrid<D>::PointGrid(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary, double edge)
    : PointGrid(spheres, first_ids(spheres.size()), boundary, edge) {}

template <int D>
template <class PointOf>
void PointGrid<D>::lay_cells(std::span<const Id> ids, const PointOf& point_of, double edge) {
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

template <int D>
std::int64_t PointGrid<D>::unwrapped(int k, double x) const {
  // The floor, faster than the library's, which is a call where the compiler may not assume SSE 4.
  const double cell = std::clamp((x - lower_[k]) / cell_edge_[k], -0x1p62, 0x1p62);
  const auto whole = static_cast<std::int64_t>(cell);
  return static_cast<double>(whole) > cell ? whole - 1 : whole;
}

template <int D>
std::uint32_t PointGrid<D>::cell_of(const Vector<D>& p) const {
  std::int64_t cell = 0;
  for (int k = D - 1; k >= 0; --k) {
    cell = cell * cells_[k] + std::clamp<std::int64_t>(unwrapped(k, p[k]), 0, cells_[k] - 1);
  }
  return static_cast<std::uint32_t>(cell);
}

template <int D>
void PointGrid<D>::for_each_run(const Vector<D>& c, double reach, const void* it, VisitRun visit) const {
  const double wide = reach * (1 + 1e-9);
  Vector<D> shift = Vector<D>::Zero();
  visit_axis<D - 1>(c, wide * wide, 0, shift, it, visit);
}

/// All layers of cells across axis K that the ball meets; `squared` is what is left of its squared radius
/// there, `cell` the index of the layer among those of the higher axes.
template <int D>
template <int K>
void PointGrid<D>::visit_axis(const Vector<D>& c, double squared, std::int64_t cell, Vector<D>& shift,
                              const void* it, VisitRun visit) const {
  // Points may lie a rounding beyond the cell that they are in, along each axis by its own: next to one
  // that is 1e19 long, that of the longest would be a multitude of cells.
  const double rounding = 1e-12 * cell_edge_[K], half = std::sqrt(squared) + rounding;
  // Whoever has left a tilted box through a higher axis is beside it along the lower ones.
  const Vector<D> beside = shift;
  const double here = c[K] - beside[K];
  std::int64_t first = unwrapped(K, here - half), last = unwrapped(K, here + half);
  const std::int64_t n = cells_[K];
  const bool periodic = boundary_.edges[K] > 0;
  if (!periodic) {
    first = std::clamp<std::int64_t>(first, 0, n - 1);
    last = std::clamp<std::int64_t>(last, 0, n - 1);
  }
  for (std::int64_t at = first; at <= last;) {
    const bool beyond = periodic && (at < 0 || at >= n);
    const std::int64_t turn = !beyond ? 0 : at >= 0 ? at / n : -((n - 1 - at) / n);
    const auto turns = static_cast<double>(turn);
    shift[K] = beside[K] + turns * boundary_.edges[K];
    for (int j = 0; j < K; ++j) shift[j] = beside[j] + turns * boundary_.along(K, j);
    if constexpr (K == 0) {  // what lies in one box is one run of points
      const std::int64_t end = std::min(last, turn * n + n - 1);
      visit(it, start_[static_cast<std::size_t>(cell * n + at - turn * n)],
            start_[static_cast<std::size_t>(cell * n + end - turn * n) + 1], c - shift);
      at = end + 1;
    } else {
      const double near = lower_[K] + static_cast<double>(at) * cell_edge_[K];
      const double away = std::max({0.0, near - here - rounding, here - near - cell_edge_[K] - rounding});
      const double rest = squared - away * away;
      if (rest > 0) visit_axis<K - 1>(c, rest, cell * n + at - turn * n, shift, it, visit);
      ++at;
    }
  }
}

#define BERNAL_INSTANTIATE(D) template class PointGrid<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
