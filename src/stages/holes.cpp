#include "stages/holes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "neighbors/cell_grid.hpp"

namespace bernal {
namespace {

/// Of the probes so many times `wanted` are looked at closely: neighbouring ones find the same hole.
constexpr std::size_t candidates_a_hole = 8;

double room_between(const CellGrid<3>& grid, const Spheres<3>& spheres, const Vector<3>& p, double enough,
                    double limit) {
  double room = limit;
  const auto lower = [&](double reach) {
    return grid.any_near(p, reach, [&](CellGrid<3>::Id j) {
      room = std::min(room, (spheres.center(j) - p).norm() - spheres.r[j]);
      return room < enough;
    });
  };
  // Most places are inside some sphere: look near by before looking far around.
  if (!lower(0)) lower(room);
  return room;
}

}  // namespace

std::vector<Hole> emptiest_holes(const Container& container, const Places& places,
                                 const Spheres<3>& spheres, std::size_t probes, std::size_t wanted,
                                 Random& random) {
  const auto [least, most] = std::ranges::minmax(spheres.r);
  CellGrid<3> grid(container.bounds(), least, most, spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i)
    grid.insert(static_cast<CellGrid<3>::Id>(i), spheres.center(i), spheres.r[i]);

  const auto roomier = [](const Hole& a, const Hole& b) { return a.room > b.room; };
  std::vector<Hole> best;  // a heap, the least roomy on top
  const std::size_t candidates = candidates_a_hole * wanted;
  for (std::size_t n = 0; n < probes; ++n) {
    const Vector<3> p = places.draw(random);
    const double enough = best.size() < candidates ? -std::numeric_limits<double>::infinity() : best.front().room;
    double room = room_between(grid, spheres, p, enough, most);
    if (room <= enough) continue;
    room = std::min(room, container.clearance_within(p, std::max(room, 0.0)));
    // A centre stays clear of the wall, as it will not pass it.
    if (room <= enough || !container.contains(p, 0.5 * least)) continue;
    if (best.size() == candidates) {
      std::ranges::pop_heap(best, roomier);
      best.pop_back();
    }
    best.push_back({p, room});
    std::ranges::push_heap(best, roomier);
  }
  std::ranges::sort(best, roomier);
  std::vector<Hole> holes;
  for (const Hole& candidate : best) {
    if (holes.size() == wanted) break;
    const auto is_same = [&](const Hole& other) {
      const double apart = std::max(other.room, 0.5 * least);
      return (other.place - candidate.place).squaredNorm() < apart * apart;
    };
    if (std::ranges::none_of(holes, is_same)) holes.push_back(candidate);
  }
  return holes;
}

}  // namespace bernal
