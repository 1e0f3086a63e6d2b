#include "work/periodic_holes.hpp"

#include <algorithm>

#include "bernal/domain/boundary.hpp"
#include "core/every_dimension.hpp"
#include "neighbors/cell_grid.hpp"
#include "work/room.hpp"

namespace bernal {

template <int D>
void move_to_holes(Spheres<D>& spheres, const Vector<D>& edges, std::vector<std::uint32_t> ids,
                   Random& random, const std::vector<bool>& walls) {
  constexpr double probes_a_sphere = 2, least_probes = 1000;
  const Boundary<D> boundary{edges};
  const Bounds<D> box{Vector<D>::Zero(), edges};
  const auto [least, most] = std::ranges::minmax(spheres.r);
  std::ranges::stable_sort(ids, std::greater<>(), [&](auto i) { return spheres.r[i]; });
  std::vector<bool> moves(spheres.size(), false);
  for (const std::uint32_t i : ids) moves[i] = true;
  CellGrid<D> grid(boundary, least, most, spheres.size());
  for (std::uint32_t i = 0; i < spheres.size(); ++i)
    if (!moves[i]) grid.insert(i, spheres.center(i), spheres.r[i]);

  struct Probe {
    Vector<D> place;
    double room;
  };
  std::vector<Probe> holes;
  const auto probes =
      static_cast<std::size_t>(least_probes + probes_a_sphere * static_cast<double>(spheres.size()));
  for (std::size_t n = 0; n < probes; ++n) {
    const Vector<D> p = uniform_point(random, box);
    double room = most;
    for (int k = 0; k < D && !walls.empty(); ++k)
      if (walls[static_cast<std::size_t>(k)]) room = std::min({room, p[k], edges[k] - p[k]});
    const double between = room_between_spheres(grid, p, -most, room, 0, [&](std::uint32_t j) {
      return Nearby{boundary.minimum_image(spheres.center(j) - p).squaredNorm(), spheres.r[j]};
    });
    holes.push_back({p, between});
  }
  std::ranges::stable_sort(holes, std::greater<>(), &Probe::room);
  auto hole = holes.begin();
  for (const std::uint32_t i : ids) {
    const double r = spheres.r[i], apart = 0.5 * (r + least);
    const auto taken = [&] {
      return grid.any_near(hole->place, r, [&](std::uint32_t j) {
        return moves[j] &&
               boundary.minimum_image(hole->place - spheres.center(j)).squaredNorm() < apart * apart;
      });
    };
    while (hole != holes.end() && taken()) ++hole;
    spheres.set_center(i, hole != holes.end() ? (hole++)->place : uniform_point(random, box));
    grid.insert(i, spheres.center(i), r);
  }
}

#define BERNAL_INSTANTIATE(D)                                                                        \
  template void move_to_holes<D>(Spheres<D>&, const Vector<D>&, std::vector<std::uint32_t>, Random&, \
                                 const std::vector<bool>&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
