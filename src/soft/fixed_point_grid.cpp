#include "soft/fixed_point_grid.hpp"

#include <algorithm>
#include <functional>

#include "core/every_dimension.hpp"
#include "near/counting_sort.hpp"

namespace bernal {
namespace {

/// Looking at a cell costs as much as looking at so many spheres.
constexpr double cost_of_a_cell = 1.5;
constexpr double most_cells_a_sphere = 4;
/// With fewer along an axis a sphere looks at all of them anyway.
constexpr int fewest_cells = 4;

}  // namespace

/// Those with the most cells, as long as a query becomes cheaper.
template <int D>
void FixedPointGrid<D>::choose_axes(const Vector<D>& edges, double reach, double count) {
  std::vector<Axis> axes;
  for (int k = 0; k < D; ++k) axes.push_back({k, static_cast<int>(std::min(edges[k] / reach, 1e6))});
  std::ranges::stable_sort(axes, std::greater<>(), &Axis::cells);
  double share = 1, looked_at = 1, cells = 1, least_cost = cost_of_a_cell + count;
  axes_.clear();
  for (Axis axis : axes) {
    axis.cells =
        static_cast<int>(std::min<double>(axis.cells, std::max(1.0, most_cells_a_sphere * count / cells)));
    if (axis.cells < fewest_cells) break;
    share *= 3.0 / axis.cells;
    looked_at *= 3;
    cells *= axis.cells;
    const double cost = cost_of_a_cell * looked_at + count * share;
    if (cost > least_cost) break;
    least_cost = cost;
    axes_.push_back(axis);
  }
}

template <int D>
std::vector<std::uint32_t> FixedPointGrid<D>::sort(const Vector<D>& edges, double reach,
                                                   const std::vector<FixedPlace<D>>& places,
                                                   std::size_t count) {
  choose_axes(edges, reach, static_cast<double>(count));
  std::size_t all = 1;
  for (const Axis& axis : axes_) all *= static_cast<std::size_t>(axis.cells);
  std::vector<Id> cell(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t c = 0;
    for (const Axis& axis : axes_) {
      const auto n = static_cast<std::uint64_t>(axis.cells);
      c = c * n + (places[i].x[axis.axis] * n >> 32);
    }
    cell[i] = static_cast<Id>(c);
  }
  counting_sort(cell, all, cell_start_);
  return cell;
}

template <int D>
void FixedPointGrid<D>::rows_near(const FixedPlace<D>& place, std::vector<Row>& rows) const {
  rows.clear();
  if (axes_.empty()) {
    rows.push_back({cell_start_.front(), cell_start_.back()});
    return;
  }
  const auto coordinate = [&](const Axis& axis) {
    return static_cast<int>(place.x[axis.axis] * static_cast<std::uint64_t>(axis.cells) >> 32);
  };
  const int across = static_cast<int>(axes_.size()) - 1;
  int combinations = 1;
  for (int a = 0; a < across; ++a) combinations *= 3;
  const Axis fast = axes_.back();
  const int at = coordinate(fast);
  for (int n = 0; n < combinations; ++n) {
    std::size_t cell = 0;
    for (int a = 0, digits = n; a < across; ++a, digits /= 3) {
      const Axis& axis = axes_[static_cast<std::size_t>(a)];
      const int c = (coordinate(axis) + digits % 3 - 1 + axis.cells) % axis.cells;
      cell = cell * static_cast<std::size_t>(axis.cells) + static_cast<std::size_t>(c);
    }
    const Id* start = &cell_start_[cell * static_cast<std::size_t>(fast.cells)];
    if (at == 0) {
      rows.push_back({start[0], start[2]});
      rows.push_back({start[fast.cells - 1], start[fast.cells]});
    } else if (at == fast.cells - 1) {
      rows.push_back({start[at - 1], start[at + 1]});
      rows.push_back({start[0], start[1]});
    } else {
      rows.push_back({start[at - 1], start[at + 2]});
    }
  }
}

#define BERNAL_INSTANTIATE(D) template class FixedPointGrid<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
