#include "jam/near_walls.hpp"

#include <algorithm>
#include <utility>

#include "core/every_dimension.hpp"

namespace bernal {

template <int D>
void NearWalls<D>::add_near(const Enclosure<D>& enclosure, const Vector<D>& p, double reach) {
  std::vector<WallPiece<D>> pieces;
  enclosure.pieces_near(p, reach, pieces);
  for (WallPiece<D>& piece : pieces) {
    const double distance = view_of<D>(piece, p).distance;
    walls_.push_back({std::move(piece), distance});
  }
  begin_.push_back(static_cast<std::uint32_t>(walls_.size()));
}

template <int D>
void NearWalls<D>::add_touching(std::span<const NearPiece<D>> near, const Vector<D>& p, double radius,
                                double same_place) {
  const std::size_t first = walls_.size();
  std::vector<Vector<D>> ways;
  for (const NearPiece<D>& wall : near) {
    const WallView<D> view = view_of<D>(wall.piece, p);
    if (!(view.distance < radius)) continue;
    const Vector<D> way = view.distance * view.normal;
    const auto same = std::ranges::find_if(
        ways, [&](const Vector<D>& other) { return (way - other).norm() <= same_place; });
    if (same != ways.end()) {
      walls_[first + static_cast<std::size_t>(same - ways.begin())].weight += 1;
    } else {
      ways.push_back(way);
      walls_.push_back(wall);
    }
  }
  begin_.push_back(static_cast<std::uint32_t>(walls_.size()));
}

template <int D>
void NearWalls<D>::erase(std::size_t k) {
  walls_.erase(walls_.begin() + static_cast<std::ptrdiff_t>(k));
  for (std::uint32_t& begin : begin_)
    if (begin > k) --begin;
}

#define BERNAL_INSTANTIATE(D) template class NearWalls<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
