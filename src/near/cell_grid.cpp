#include "near/cell_grid.hpp"

#include "core/every_dimension.hpp"

namespace bernal {

template <int D>
CellGrid<D>::CellGrid(const Bounds<D>& bounds, const Boundary<D>& boundary, double r_min, double r_max,
                      std::size_t expected)
    : layout_(bounds, boundary, r_min, r_max, expected),
      spheres_on_(layout_.levels().size(), 0),
      heads_(layout_.cell_count(), none) {}

template <int D>
void CellGrid<D>::insert(Id id, const Vector<D>& center, double r) {
  if (id >= links_.size()) links_.resize(id + std::size_t{1});
  const std::size_t level = layout_.level_of(r);
  ++spheres_on_[level];
  link(id, layout_.cell_of(layout_.levels()[level], center), static_cast<std::uint8_t>(level));
}

template <int D>
void CellGrid<D>::clear() {
  std::fill(heads_.begin(), heads_.end(), none);
  links_.clear();
  std::fill(spheres_on_.begin(), spheres_on_.end(), 0);
}

template <int D>
bool CellGrid<D>::search(const Vector<D>& c, double reach, bool (*visitor)(void* it, Id id), void* it) const {
  return walk(c, reach, [&](Id id) { return visitor(it, id); });
}

#define BERNAL_INSTANTIATE(D) template class CellGrid<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
