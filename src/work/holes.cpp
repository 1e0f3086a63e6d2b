#include "work/holes.hpp"

#include <algorithm>
#include <limits>

#include "bernal/domain/boundary.hpp"
#include "core/every_dimension.hpp"
#include "core/parallel.hpp"

namespace bernal {
namespace {

/// Of the probes so many for each hole that is wanted are looked at closely: neighbouring ones find the same.
constexpr std::size_t candidates_a_hole = 8;
/// Of radii that look for holes among themselves.
constexpr std::size_t most_groups = 4;
/// Probes that are looked at by one thread, and so many parts at most.
constexpr std::size_t probes_a_part = 8192, most_parts = 16;

bool roomier(const Hole& a, const Hole& b) { return a.room > b.room; }

/// The roomiest so many of the places that have some clearance.
struct Group {
  double least_clearance;
  std::size_t candidates;
  std::vector<Hole> best = {};  // a heap, the least roomy on top

  double enough(double none) const { return best.size() < candidates ? none : best.front().room; }
  void take(const Hole& hole) {
    if (best.size() == candidates) {
      if (hole.room <= best.front().room) return;
      std::ranges::pop_heap(best, roomier);
      best.pop_back();
    }
    best.push_back(hole);
    std::ranges::push_heap(best, roomier);
  }
};

}  // namespace

std::vector<Hole> holes_for(std::span<const double> radii, const Container& container, const Places& places,
                            const Spheres<3>& spheres, std::size_t probes, Random& random) {
  const auto [least, most] = std::ranges::minmax(spheres.r);
  const Boundary<3>& boundary = container.boundary();
  CellGrid<3> grid(container.bounds(), boundary, least, most, spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i)
    grid.insert(static_cast<CellGrid<3>::Id>(i), spheres.center(i), spheres.r[i]);

  // Of a hole a sphere needs to clear the wall first of all; the roomiest places may all be too near to it.
  std::vector<Group> none;
  for (std::size_t g = 0; g < most_groups; ++g) {
    const std::size_t first = radii.size() * g / most_groups, last = radii.size() * (g + 1) / most_groups;
    if (last > first) none.push_back({radii[first], candidates_a_hole * (last - first)});
  }
  // A centre stays clear of the wall, as it will not pass it; that is the last resort.
  none.push_back({0.5 * radii.back(), none.back().candidates});

  // Of several parts every one has random numbers of its own, and its best go to the best of all in order.
  const std::size_t parts = std::clamp<std::size_t>(probes / probes_a_part, 1, most_parts);
  const std::uint64_t seed = parts > 1 ? random() : 0;
  std::vector<std::vector<Group>> found(parts, none);
  parallel_for(parts, [&](std::size_t part) {
    std::vector<Group>& groups = found[part];
    Random of_part(seed, part);
    Random& own = parts > 1 ? of_part : random;
    for (std::size_t n = probes * part / parts; n < probes * (part + 1) / parts; ++n) {
      const Vector<3> p = places.draw(own);
      double enough = most;
      for (const Group& group : groups) enough = std::min(enough, group.enough(-most));
      const double room = room_between_spheres(grid, p, enough, most, 0, [&](CellGrid<3>::Id j) {
        return Nearby{boundary.minimum_image(spheres.center(j) - p).squaredNorm(), spheres.r[j]};
      });
      if (room <= enough) continue;
      const double clearance = container.clearance_within(p, radii.front());
      for (Group& group : groups) {
        if (clearance < group.least_clearance || room <= group.enough(-most)) continue;
        group.take({p, room, clearance});
        break;
      }
    }
  });
  std::vector<Group>& groups = found.front();
  for (std::size_t part = 1; part < parts; ++part)
    for (std::size_t g = 0; g < groups.size(); ++g)
      for (const Hole& hole : found[part][g].best) groups[g].take(hole);
  std::vector<Hole> best;
  for (const Group& group : groups) best.insert(best.end(), group.best.begin(), group.best.end());
  std::ranges::sort(best, roomier);

  std::vector<Hole> holes;
  std::vector<bool> given(best.size(), false);
  std::vector<double> squared_apart(best.size(),
                                    std::numeric_limits<double>::infinity());  // from those given
  for (const double r : radii) {
    std::size_t chosen = best.size();
    for (std::size_t k = 0; k < best.size(); ++k) {
      if (given[k] || (chosen < best.size() && best[k].clearance <= best[chosen].clearance)) continue;
      if (squared_apart[k] < 0.25 * (r + least) * (r + least)) continue;
      chosen = k;
      if (best[k].clearance >= r) break;
    }
    if (chosen == best.size()) break;
    given[chosen] = true;
    holes.push_back(best[chosen]);
    for (std::size_t k = 0; k < best.size(); ++k)
      squared_apart[k] = std::min(squared_apart[k],
                                  boundary.minimum_image(best[k].place - best[chosen].place).squaredNorm());
  }
  return holes;
}

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
