#include "near/cell_layout.hpp"

#include "core/every_dimension.hpp"

namespace bernal {

template <int D>
CellLayout<D>::CellLayout(const Bounds<D>& bounds, const Boundary<D>& boundary, double r_min, double r_max,
                          std::size_t expected)
    : lower_(bounds.lower), size_(bounds.size()), r_max_(r_max) {
  for (int k = 0; k < D; ++k) {
    repeats_[k] = boundary.repeats(k);
    if (!repeats_[k]) continue;
    lower_[k] = boundary.origin[k];
    size_[k] = boundary.edges[k];
  }
  const double max_cells = std::max(64.0, cells_per_sphere * static_cast<double>(expected));
  for (double largest = r_max;; largest /= 2) {
    Level level = make_level(largest, max_cells);
    level.offset = cell_count_;
    std::size_t cells = 1;
    for (const int along : level.cells) cells *= static_cast<std::size_t>(along);
    cell_count_ += cells;
    levels_.push_back(level);
    if (largest / 2 < r_min || levels_.size() == max_levels) break;
  }
}

template <int D>
void CellLayout<D>::rescale(const Vector<D>& edges) {
  size_ = edges;
  for (Level& level : levels_) {
    for (int k = 0; k < D; ++k) level.inverse_edge[k] = level.cells[k] / edges[k];
  }
}

template <int D>
typename CellLayout<D>::Level CellLayout<D>::make_level(double largest_radius, double max_cells) const {
  double edge = 2 * largest_radius;
  // The border cell of an open axis holds what is left of it; a period has whole cells only.
  const auto cells_along = [&](int k) {
    const double whole = std::floor(size_[k] / edge);
    return repeats_[k] ? std::max(1.0, whole) : whole + 1;
  };
  const auto all_cells = [&] {
    double cells = 1;
    for (int k = 0; k < D; ++k) cells *= cells_along(k);
    return cells;
  };
  while (all_cells() > max_cells) edge *= 1.25;

  Level level;
  level.largest_radius = largest_radius;
  for (int k = 0; k < D; ++k) {
    level.cells[k] = static_cast<int>(cells_along(k));
    level.inverse_edge[k] = repeats_[k] ? level.cells[k] / size_[k] : 1 / edge;
  }
  return level;
}

template <int D>
std::size_t CellLayout<D>::level_of(double r) const {
  std::size_t l = 0;
  for (double largest = r_max_ / 2; r <= largest && l + 1 < levels_.size(); largest /= 2) ++l;
  return l;
}

#define BERNAL_INSTANTIATE(D) template class CellLayout<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
