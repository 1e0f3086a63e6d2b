#include "near/partial_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "near/counting_sort.hpp"

namespace bernal {
namespace {

constexpr double most_cells_along_an_axis = 1 << 20;
/// Spheres of which the distances are taken at once.
constexpr std::size_t block = 32;
/// So few that are not sorted are looked at one after the other.
constexpr std::size_t few_unsorted = 64;
constexpr PartialGrid::Id none = ~PartialGrid::Id{0};

/// What a query costs on k axes, in comparisons of two spheres, when on each axis it opens so many of so many
/// cells: a row of cells along the first axis costs as much to open as looking at eight spheres (measured in
/// 2 to 8 dimensions with 100 to 30,000 spheres; the choice was within a fifth of the best).
double cost_of(int k, const PartialGrid::EachAxis<double>& opened, const PartialGrid::EachAxis<double>& cells,
               double spheres) {
  double rows = k > 0 ? 8 : 0, met = spheres;
  for (int axis = 0; axis < k; ++axis) {
    if (axis > 0) rows *= opened[axis];
    met *= opened[axis] / cells[axis];
  }
  return rows + met;
}

}  // namespace

PartialGrid::PartialGrid(const Vector<dynamic>& edges, const EachAxis<bool>& repeats, double reach,
                         double slack, std::size_t expected, int axes)
    : dimension_(static_cast<int>(edges.size())), repeats_(repeats), slack_(slack) {
  EachAxis<double> cells{}, opened{};
  for (int k = 0; k < dimension_; ++k) {
    cells[k] = std::clamp(std::floor(edges[k] / (reach + slack)), 1.0, most_cells_along_an_axis);
    opened[k] = std::min(cells[k], 1 + 2 * (reach + slack) * cells[k] / edges[k]);
    period_[k] = repeats[k] ? edges[k] : std::numeric_limits<double>::infinity();
  }
  const auto spheres = static_cast<double>(expected);
  axes_ = std::min(axes, dimension_);
  if (axes == automatic) {
    axes_ = 0;
    double least = cost_of(0, opened, cells, spheres);
    for (int k = 1; k <= dimension_; ++k) {
      const double cost = cost_of(k, opened, cells, spheres);
      if (cost >= least) continue;
      axes_ = k;
      least = cost;
    }
  }
  // A box that is almost empty: cells of no use are not made.
  double all = 1;
  for (int k = 0; k < axes_; ++k) {
    const double most = std::max(3.0, std::floor(std::max(64.0, 4 * spheres) / all));
    cells_[k] = static_cast<int>(std::min(cells[k], most));
    all *= cells_[k];
    per_length_[k] = cells_[k] / edges[k];
  }
  start_.assign(static_cast<std::size_t>(all) + 1, 0);
  last_added_.assign(static_cast<std::size_t>(all), none);
}

void PartialGrid::sort(const Columns& x, const std::vector<double>& r, std::size_t n) {
  std::vector<std::uint32_t> slot(n);
  for (std::size_t i = 0; i < n; ++i)
    slot[i] = static_cast<std::uint32_t>(cell_of([&](int k) { return x[k][i]; }));
  counting_sort(slot, start_.size() - 1, start_);
  ids_.resize(n);
  r_.resize(n);
  for (std::size_t i = 0; i < n; ++i) ids_[slot[i]] = static_cast<Id>(i);
  for (std::size_t s = 0; s < n; ++s) r_[s] = r[ids_[s]];
  for (int k = 0; k < dimension_; ++k) x_[k].resize(n);
  update(x);
  if (!added_before_.empty()) std::ranges::fill(last_added_, none);
  added_before_.clear();
}

void PartialGrid::update(const Columns& x) {
  for (int k = 0; k < dimension_; ++k)
    for (std::size_t s = 0; s < ids_.size(); ++s) x_[k][s] = x[k][ids_[s]];
}

void PartialGrid::add(const double* c, double r) {
  Id& last = last_added_[cell_of([&](int k) { return c[k]; })];
  added_before_.push_back(last);
  last = static_cast<Id>(ids_.size());
  for (int k = 0; k < dimension_; ++k) x_[k].push_back(c[k]);
  r_.push_back(r);
  ids_.push_back(static_cast<Id>(ids_.size()));
}

std::size_t PartialGrid::coordinate(int k, double x) const {
  double cell = std::floor(x * per_length_[k]);
  if (repeats_[k]) cell -= cells_[k] * std::floor(cell / cells_[k]);
  return static_cast<std::size_t>(std::clamp(cell, 0.0, cells_[k] - 1.0));
}

/// Spheres `first` to `last` of the order, of which one calls.
bool PartialGrid::look_at(const double* c, double reach, std::size_t first, std::size_t last, Visitor visitor,
                          void* it) const {
  double squared[block];
  for (; first < last; first += block) {
    const std::size_t n = std::min(block, last - first);
    std::fill(squared, squared + n, 0.0);
    for (int k = 0; k < dimension_; ++k) {
      const double* const x = x_[k].data() + first;
      const double at = c[k], period = period_[k];
      for (std::size_t s = 0; s < n; ++s) {
        const double direct = std::abs(at - x[s]);
        const double d = std::min(direct, period - direct);
        squared[s] += d * d;
      }
    }
    for (std::size_t s = 0; s < n; ++s) {
      const double limit = reach + r_[first + s];
      if (squared[s] < limit * limit && visitor(it, ids_[first + s], squared[s])) return true;
    }
  }
  return false;
}

/// Looks at the stretches of the order that hold all with |c - x|_k < half on every axis of the grid.
bool PartialGrid::search(const double* c, double reach, Visitor visitor, void* it) const {
  const auto visit = [&](std::size_t first, std::size_t last) {
    return look_at(c, reach, first, last, visitor, it);
  };
  if (axes_ == 0) return visit(0, ids_.size());
  const bool in_chains = unsorted() > few_unsorted;
  std::vector<Id> added;
  const auto gather = [&](std::size_t from, std::size_t to) {
    for (std::size_t cell = from; cell < to; ++cell)
      for (Id s = last_added_[cell]; s != none; s = added_before_[s - start_.back()]) added.push_back(s);
  };
  const double half = reach + largest_;
  EachAxis<int> first{}, count{}, step{};
  for (int k = 0; k < axes_; ++k) {
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
    for (int k = axes_ - 1; k > 0; --k) {
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
    const std::size_t wrapped = row + static_cast<std::size_t>(std::max(0, beyond));
    if (visit(start_[row], start_[wrapped])) return true;
    if (in_chains) {
      gather(begin, end);
      gather(row, wrapped);
    }
    int k = 1;
    for (; k < axes_; ++k) {
      if (++step[k] < count[k]) break;
      step[k] = 0;
    }
    if (k >= axes_) break;
  }
  if (!in_chains) return visit(start_.back(), ids_.size());
  // As they came, so that it makes no difference how they are found.
  std::ranges::sort(added);
  return std::ranges::any_of(added, [&](Id s) { return visit(s, s + std::size_t{1}); });
}

}  // namespace bernal
