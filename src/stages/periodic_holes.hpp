#pragma once
#include <algorithm>
#include <limits>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/boundary.hpp"
#include "neighbors/cell_grid.hpp"

namespace bernal {

/// Puts some of the spheres of a periodic box into holes between the others: the largest first, each into the
/// roomiest of the random places, two for each sphere in the box and a thousand more, that none of those
/// before it has covered by half. Room is what is left to the nearest surface. Precondition: not all spheres
/// are to be moved. Cost: about 1 µs a place in three dimensions, N times as much where N is small.
template <int D>
void move_to_holes(Spheres<D>& spheres, const Vector<D>& edges, std::vector<std::uint32_t> ids,
                   Random& random) {
  constexpr double probes_a_sphere = 2, least_probes = 1000;
  const Boundary<D> boundary{edges};
  const auto [least, most] = std::ranges::minmax(spheres.r);
  std::ranges::stable_sort(ids, std::greater<>(), [&](auto i) { return spheres.r[i]; });
  std::vector<bool> moves(spheres.size(), false);
  for (const std::uint32_t i : ids) moves[i] = true;
  CellGrid<D> grid(boundary, least, most, spheres.size());
  for (std::uint32_t i = 0; i < spheres.size(); ++i)
    if (!moves[i]) grid.insert(i, spheres.center(i), spheres.r[i]);

  struct Hole {
    Vector<D> place;
    double room;
  };
  std::vector<Hole> holes;
  const auto probes =
      static_cast<std::size_t>(least_probes + probes_a_sphere * static_cast<double>(spheres.size()));
  for (std::size_t n = 0; n < probes; ++n) {
    const Vector<D> p = uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges});
    double room = most;
    const auto lower = [&](double reach) {
      grid.for_each_near(p, reach, [&](std::uint32_t j) {
        room = std::min(room, boundary.minimum_image(spheres.center(j) - p).norm() - spheres.r[j]);
      });
    };
    lower(0);
    if (room > 0) lower(room);
    holes.push_back({p, room});
  }
  std::ranges::stable_sort(holes, std::greater<>(), &Hole::room);
  std::vector<double> squared_apart(holes.size(), std::numeric_limits<double>::infinity());
  for (const std::uint32_t i : ids) {
    const double clear = 0.25 * (spheres.r[i] + least) * (spheres.r[i] + least);
    std::size_t chosen = 0;
    while (chosen < holes.size() && squared_apart[chosen] < clear) ++chosen;
    if (chosen == holes.size()) return;
    const Vector<D> place = holes[chosen].place;
    spheres.set_center(i, place);
    for (std::size_t k = 0; k < holes.size(); ++k)
      squared_apart[k] =
          std::min(squared_apart[k], boundary.minimum_image(holes[k].place - place).squaredNorm());
  }
}

}  // namespace bernal
