#include "work/holes.hpp"

#include <limits>
#include <numeric>
#include <utility>

#include "bernal/core/boundary.hpp"
#include "core/every_dimension.hpp"
#include "core/order.hpp"
#include "core/parallel.hpp"
#include "near/counting_sort.hpp"

namespace bernal {
namespace {

/// Of the probes so many for each hole that is wanted are looked at closely: neighbouring ones find the same.
constexpr std::size_t candidates_a_hole = 8;
/// Of radii that look for holes among themselves.
constexpr std::size_t most_groups = 4;
/// Probes that are looked at by one thread, and so many parts at most.
constexpr std::size_t probes_a_part = 8192, most_parts = 16;
/// Of the best of all each of these parts has about as many: so many times its share, and a few, are enough.
constexpr double share_of_part = 1.5, few_of_part = 16;

bool roomier(const Hole& a, const Hole& b) { return a.room > b.room; }

/// Cells of some spheres each, row by row: what comes in their order is near in memory to most of what is
/// near to it in space.
class Rows {
 public:
  Rows(const Bounds<3>& bounds, const Spheres<3>& spheres) : lower_(bounds.lower) {
    double edge =
        4 * std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) / static_cast<double>(spheres.size());
    do {
      for (int k = 0; k < 3; ++k) {
        count_[k] = static_cast<std::size_t>(std::clamp(std::ceil(bounds.size()[k] / edge), 1.0, 2048.0));
        cells_a_length_[k] = 1 / edge;
      }
      edge *= 1.5;
    } while (cells() > 2 * spheres.size() + 8);
  }
  std::size_t cells() const { return count_[0] * count_[1] * count_[2]; }
  std::size_t cell_of(const Vector<3>& p) const {
    std::size_t cell = 0;
    for (int k = 3; k-- > 0;) {
      const double at = std::max(0.0, (p[k] - lower_[k]) * cells_a_length_[k]);
      cell = cell * count_[k] + std::min(count_[k] - 1, static_cast<std::size_t>(at));
    }
    return cell;
  }

 private:
  Vector<3> lower_, cells_a_length_;
  std::size_t count_[3]{};
};

Spheres<3> in_rows(const Spheres<3>& spheres, const Rows& rows) {
  std::vector<std::uint32_t> order, start;
  sort_into_buckets(
      spheres.size(), rows.cells(), [&](std::size_t i) { return rows.cell_of(spheres.center(i)); }, order,
      start);
  Spheres<3> sorted;
  sorted.reserve(order.size());
  for (const std::uint32_t i : order) sorted.push_back(spheres.center(i), spheres.r[i]);
  return sorted;
}

void put_in_rows(std::vector<Vector<3>>& points, const Rows& rows) {
  std::vector<std::pair<std::size_t, std::uint32_t>> order;
  for (const Vector<3>& p : points)
    order.push_back({rows.cell_of(p), static_cast<std::uint32_t>(order.size())});
  std::ranges::sort(order);
  std::vector<Vector<3>> sorted;
  for (const auto& [cell, n] : order) sorted.push_back(points[n]);
  points.swap(sorted);
}

/// A sphere in one place of memory, as a search looks at them in any order.
struct Ball {
  Vector<3> center;
  double r;
};

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

/// To each of the radii, in their order, the roomiest place that clears the wall, or else clears it best, of
/// those that are not given yet nor covered by half by one that is.
std::vector<Hole> deal(std::span<const double> radii, const std::vector<Hole>& best, double least,
                       const Container& container) {
  std::vector<Hole> holes;
  if (best.empty()) return holes;
  const Boundary<3>& boundary = container.boundary();
  const double most_apart = 0.5 * (radii.front() + least);
  CellGrid<3> grid(container.bounds(), boundary, most_apart, most_apart, best.size());
  for (std::size_t k = 0; k < best.size(); ++k)
    grid.insert(static_cast<CellGrid<3>::Id>(k), best[k].place, most_apart);
  std::vector<bool> given(best.size(), false);
  std::vector<double> squared_apart(best.size(),
                                    std::numeric_limits<double>::infinity());  // from those given
  std::size_t first = 0;
  for (const double r : radii) {
    while (first < best.size() && given[first]) ++first;
    std::size_t chosen = best.size();
    for (std::size_t k = first; k < best.size(); ++k) {
      if (given[k] || (chosen < best.size() && best[k].clearance <= best[chosen].clearance)) continue;
      if (squared_apart[k] < 0.25 * (r + least) * (r + least)) continue;
      chosen = k;
      if (best[k].clearance >= r) break;
    }
    if (chosen == best.size()) break;
    given[chosen] = true;
    holes.push_back(best[chosen]);
    grid.for_each_near(best[chosen].place, 0, [&](CellGrid<3>::Id k) {
      squared_apart[k] = std::min(squared_apart[k],
                                  boundary.minimum_image(best[k].place - best[chosen].place).squaredNorm());
    });
  }
  return holes;
}

}  // namespace

std::vector<Hole> holes_for(std::span<const double> radii, const Container& container, const Places& places,
                            const Spheres<3>& of_places, std::size_t probes, Random& random) {
  if (radii.empty()) return {};
  // Of several parts every one has random numbers of its own, and its best go to the best of all in order.
  const std::size_t parts = std::clamp<std::size_t>(probes / probes_a_part, 1, most_parts);
  const std::uint64_t seed = parts > 1 ? random() : 0;
  const Rows rows(container.bounds(), of_places);
  const Spheres<3> sorted = parts > 1 ? in_rows(of_places, rows) : Spheres<3>();
  const Spheres<3>& spheres = parts > 1 ? sorted : of_places;

  const auto [least, most] = std::ranges::minmax(spheres.r);
  const Boundary<3>& boundary = container.boundary();
  CellGrid<3> grid(container.bounds(), boundary, least, most, spheres.size());
  std::vector<Ball> balls;
  balls.reserve(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    balls.push_back({spheres.center(i), spheres.r[i]});
    grid.insert(static_cast<CellGrid<3>::Id>(i), balls[i].center, balls[i].r);
  }

  // Of a hole a sphere needs to clear the wall first of all; the roomiest places may all be too near to it.
  std::vector<Group> none;
  for (std::size_t g = 0; g < most_groups; ++g) {
    const std::size_t first = radii.size() * g / most_groups, last = radii.size() * (g + 1) / most_groups;
    if (last > first) none.push_back({radii[first], candidates_a_hole * (last - first)});
  }
  // A centre stays clear of the wall, as it will not pass it; that is the last resort.
  none.push_back({0.5 * radii.back(), none.back().candidates});

  std::vector<Group> none_of_part = none;
  if (parts > 1)
    for (Group& group : none_of_part)
      group.candidates = static_cast<std::size_t>(
          few_of_part + share_of_part * static_cast<double>(group.candidates) / static_cast<double>(parts));

  std::vector<std::vector<Group>> found(parts, none_of_part);
  parallel_for(parts, [&](std::size_t part) {
    std::vector<Group>& groups = found[part];
    Random of_part(seed, part);
    Random& own = parts > 1 ? of_part : random;
    std::vector<Vector<3>> points;
    for (std::size_t n = probes * part / parts; n < probes * (part + 1) / parts; ++n)
      points.push_back(places.draw(own));
    if (parts > 1) put_in_rows(points, rows);
    for (const Vector<3>& p : points) {
      double enough = most;
      for (const Group& group : groups) enough = std::min(enough, group.enough(-most));
      const double room = room_between_spheres(grid, p, enough, most, 0, [&](CellGrid<3>::Id j) {
        return Nearby{boundary.minimum_image(balls[j].center - p).squaredNorm(), balls[j].r};
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
  std::vector<Hole> best;
  std::vector<Group> groups = none;
  for (const std::vector<Group>& of_part : found)
    for (std::size_t g = 0; g < groups.size(); ++g)
      for (const Hole& hole : of_part[g].best) groups[g].take(hole);
  for (const Group& group : groups) best.insert(best.end(), group.best.begin(), group.best.end());
  std::ranges::sort(best, roomier);
  return deal(radii, best, least, container);
}

template <int D>
void move_to_holes(Spheres<D>& spheres, const Vector<D>& edges, std::vector<std::uint32_t> ids,
                   Random& random, const std::vector<bool>& walls) {
  constexpr double probes_a_sphere = 2, least_probes = 1000;
  const Boundary<D> boundary{edges};
  const Bounds<D> box{Vector<D>::Zero(), edges};
  const auto [least, most] = std::ranges::minmax(spheres.r);
  sort_largest_first(ids, spheres.r);
  std::vector<bool> moves(spheres.size(), false);
  for (const std::uint32_t i : ids) moves[i] = true;
  CellGrid<D> grid(boundary, least, most, spheres.size());
  for (std::uint32_t i = 0; i < spheres.size(); ++i)
    if (!moves[i]) grid.insert(i, spheres.center(i), spheres.r[i]);

  std::vector<Vector<D>> places;
  std::vector<double> rooms;
  const auto probes =
      static_cast<std::size_t>(least_probes + probes_a_sphere * static_cast<double>(spheres.size()));
  for (std::size_t n = 0; n < probes; ++n) {
    const Vector<D> p = uniform_point(random, box);
    double room = most;
    for (int k = 0; k < D && !walls.empty(); ++k)
      if (walls[static_cast<std::size_t>(k)]) room = std::min({room, p[k], edges[k] - p[k]});
    places.push_back(p);
    rooms.push_back(room_between_spheres(grid, p, -most, room, 0, [&](std::uint32_t j) {
      return Nearby{boundary.minimum_image(spheres.center(j) - p).squaredNorm(), spheres.r[j]};
    }));
  }
  const std::vector<std::uint32_t> roomiest_first = largest_first(rooms);
  auto hole = roomiest_first.begin();
  for (const std::uint32_t i : ids) {
    const double r = spheres.r[i], apart = 0.5 * (r + least);
    const auto taken = [&] {
      const Vector<D>& place = places[*hole];
      return grid.any_near(place, r, [&](std::uint32_t j) {
        return moves[j] && boundary.minimum_image(place - spheres.center(j)).squaredNorm() < apart * apart;
      });
    };
    while (hole != roomiest_first.end() && taken()) ++hole;
    spheres.set_center(i, hole != roomiest_first.end() ? places[*hole++] : uniform_point(random, box));
    grid.insert(i, spheres.center(i), r);
  }
}

#define BERNAL_INSTANTIATE(D)                                                                        \
  template void move_to_holes<D>(Spheres<D>&, const Vector<D>&, std::vector<std::uint32_t>, Random&, \
                                 const std::vector<bool>&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
