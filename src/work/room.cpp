#include "work/room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "bernal/core/tolerance.hpp"
#include "work/linear_programme.hpp"

namespace bernal {
namespace {

constexpr int most_steps = 100;
/// Obstacles that are looked at in a step: of a mesh thousands of facets may be near, most of them no limit.
constexpr std::size_t most_obstacles = 200;
/// A step that does not get as far as hoped is tried again with this share of its length.
constexpr double shorter = 0.3, longer = 2;
/// A straight way that is shorter than this share of a step goes round what is there; and what is that much
/// across the way does not limit it.
constexpr double hardly = 0.01, tangent = 1e-9;
/// A way up whose steps are that short a share of what is missing does not get there.
constexpr double hopeless = 1e-4;
/// Of lengths: what is less is rounding.
constexpr double least_step = 1e-16, rounding = 1e-13;

std::vector<Obstacle> obstacles_near(const Surroundings& surroundings, const Vector<3>& place, double reach) {
  std::vector<Obstacle> obstacles;
  surroundings(place, reach, obstacles);
  const auto nearer = [](const Obstacle& a, const Obstacle& b) { return a.distance < b.distance; };
  std::ranges::stable_sort(obstacles, nearer);
  if (obstacles.size() > most_obstacles) obstacles.resize(most_obstacles);
  return obstacles;
}

/// Of the facets nearer than `reach` all, or at least the nearest of those that are looked at: around a place
/// in a fine mesh a step reaches many thousands.
std::vector<NearFacet> nearest_facets(const Container& container, const Vector<3>& place, double reach) {
  constexpr int most_tries = 12;
  std::vector<NearFacet> facets;
  double few = 0, many = reach;
  for (int k = 0; k < most_tries; ++k) {
    const double tried = k == 0 ? reach : 0.5 * (few + many);
    facets.clear();
    const bool all_of_them = container.few_facets_near(place, tried, 4 * most_obstacles, facets);
    if (all_of_them && (tried == reach || facets.size() >= most_obstacles)) return facets;
    (all_of_them ? few : many) = tried;
  }
  facets.clear();  // hundreds are as near as each other
  container.facets_near(place, reach, facets);
  return facets;
}

/// The step, in units of its greatest length, that leaves the most room beyond what there is.
Vector<3> uphill(const std::vector<Obstacle>& obstacles, double room, double step, int dimension) {
  std::vector<Constraint<4>> spaces;
  for (const Obstacle& o : obstacles) {
    Vector<4> a;
    a << -o.away, 1;
    spaces.push_back({a, (o.distance - room) / step});
  }
  const double across = dimension == 2 ? 0 : 1;  // the plane
  return optimum<4>(Vector<4>::Unit(3), spaces, {Vector<4>(-1, -1, -across, -1), Vector<4>(1, 1, across, 2)})
      .head<3>();
}

/// The step, in units of its greatest length, that goes farthest along the direction and keeps the room.
Vector<3> along(const Vector<3>& direction, const std::vector<Obstacle>& obstacles, double room, double step,
                int dimension) {
  std::vector<Constraint<3>> spaces;
  for (const Obstacle& o : obstacles) spaces.push_back({-o.away, std::max(0.0, o.distance - room) / step});
  const Vector<3> most(1, 1, dimension == 2 ? 0 : 1);
  return optimum<3>(direction, spaces, {-most, most});
}

/// Of a round wall the nearest tangent plane, and others all around, so that a step does not end beyond the
/// far side: between these the roomiest place is that of the round wall.
void append_tangents(const Facet& facet, const Vector<3>& place, std::vector<Obstacle>& obstacles) {
  const bool round = facet.kind == Facet::Kind::sphere;
  Vector<3> out = place - facet.a;
  if (!round) out -= out.dot(facet.b) * facet.b;
  const double distance = out.norm();
  const Vector<3> first = distance > 0 ? Vector<3>(out / distance)
                          : round      ? Vector<3>(Vector<3>::UnitX())
                                       : facet.b.unitOrthogonal();
  const Vector<3> second = round ? first.unitOrthogonal() : facet.b.cross(first);
  const Vector<3> third = round ? first.cross(second) : Vector<3>((first + second).normalized());
  std::vector<Vector<3>> normals = {first, second, third};
  if (!round) normals.push_back((first - second).normalized());
  for (const Vector<3>& n : normals)
    for (const double side : {1.0, -1.0}) obstacles.push_back({-side * n, facet.radius - side * n.dot(out)});
}

/// Of the inner side of a frustum the tangent planes all around, too: of the edge's nearest point.
void append_tangents_of_frustum(const Facet& facet, const Vector<3>& place, double distance,
                                const Vector<3>& away, std::vector<Obstacle>& obstacles) {
  Vector<3> out = place - facet.a;
  out -= out.dot(facet.b) * facet.b;
  const double inwards = -away.dot(out);
  if (!(inwards > 0)) return;
  const double r = out.norm();
  out /= r;
  const Vector<3> along = away + (inwards / r) * out, across = facet.b.cross(out);
  constexpr double third = 0.5, height = 0.8660254037844386;
  for (const auto& [c, s] :
       {std::pair{third, height}, {third, -height}, {-third, height}, {-third, -height}, {-1.0, 0.0}}) {
    const Vector<3> turned = c * out + s * across, normal = along - (inwards / r) * turned;
    // The plane has the same distance from the axis point; r·(out - turned) is how much nearer it is.
    obstacles.push_back({normal, distance + normal.dot(r * (out - turned))});
  }
}

}  // namespace

Surroundings walls_of(const Container& container) {
  const double outside = std::max(0.0, -container.inset());
  return [&container, outside](const Vector<3>& place, double reach, std::vector<Obstacle>& obstacles) {
    const double asked = std::max(reach, 2 * outside);
    if (const double clearance = container.clearance_within(place, asked); !(clearance > outside)) {
      obstacles.push_back({Vector<3>::Zero(), clearance});
      return;
    }
    for (const NearFacet& near : nearest_facets(container, place, reach)) {
      if (near.facet.kind == Facet::Kind::cylinder || near.facet.kind == Facet::Kind::sphere) {
        append_tangents(near.facet, place, obstacles);
        continue;
      }
      const Vector<3> offset = place - closest_point(near.facet, place);
      const double distance = offset.norm();
      if (!(distance > 0)) continue;
      obstacles.push_back({offset / distance, near.distance});
      if (near.facet.kind == Facet::Kind::frustum)
        append_tangents_of_frustum(near.facet, place, near.distance, offset / distance, obstacles);
    }
  };
}

Room room_at(const Vector<3>& place, double reach, const Surroundings& surroundings) {
  std::vector<Obstacle> obstacles;
  surroundings(place, reach, obstacles);
  for (const Obstacle& o : obstacles) reach = std::min(reach, o.distance);
  return {place, reach};
}

namespace {

/// The same, sooner where the room is about as large as expected: what is farther away is not asked for.
Room room_at(const Vector<3>& place, double reach, const Surroundings& surroundings, double expected) {
  for (double near = 2 * expected; near > 0 && near < reach; near *= 4)
    if (const Room room = room_at(place, near, surroundings); room.radius < near) return room;
  return room_at(place, reach, surroundings);
}

}  // namespace

Room climb(Room from, double enough, double step, const Surroundings& surroundings, int dimension) {
  const double least = least_step * std::max(step, from.radius);
  const auto leads_on = [&] {
    return step > least && !(std::isfinite(enough) && step < hopeless * (enough - from.radius));
  };
  for (int k = 0; k < most_steps && from.radius < enough && leads_on(); ++k) {
    // What is farther cannot become the nearest.
    const double reach = from.radius + 2 * std::sqrt(3.0) * step;
    const std::vector<Obstacle> obstacles = obstacles_near(surroundings, from.place, reach);
    const bool beyond = std::ranges::any_of(obstacles, [](const Obstacle& o) { return o.away.isZero(0); });
    if (obstacles.empty() || beyond) return from;
    const Room to = room_at(from.place + step * uphill(obstacles, from.radius, step, dimension),
                            reach + 2 * step, surroundings, from.radius);
    if (to.radius > from.radius) {
      from = to;
      step *= longer;
    } else {
      step *= shorter;
    }
  }
  return from;
}

Room slide(Room from, double room, const Vector<3>& direction, double step, const Surroundings& surroundings,
           int dimension) {
  const double least = 1e-12 * room;
  for (int k = 0; k < most_steps && step > least; ++k) {
    const double reach = room + std::sqrt(3.0) * step;
    const std::vector<Obstacle> obstacles = obstacles_near(surroundings, from.place, reach);
    double straight = step;
    for (const Obstacle& o : obstacles)
      if (const double closing = -o.away.dot(direction); closing > tangent)
        straight = std::min(straight, std::max(0.0, o.distance - (1 + rounding) * room) / closing);
    const Vector<3> way = straight > hardly * step
                              ? Vector<3>(straight * direction)
                              : Vector<3>(step * along(direction, obstacles, room, step, dimension));
    const Room to = room_at(from.place + way, reach, surroundings, room);
    if (way.dot(direction) > least && to.radius >= room)
      from = to;
    else
      step *= shorter;
  }
  return from;
}

LargestRoom largest_room(const Container& container, int most_cells) {
  struct Cell {
    Vector<3> center, half;
    double clearance;
    double bound() const { return clearance + half.norm(); }
  };
  const auto lower = [](const Cell& a, const Cell& b) { return a.bound() < b.bound(); };
  std::priority_queue<Cell, std::vector<Cell>, decltype(lower)> open(lower);
  const Bounds<3> bounds = container.bounds();
  const double extent = bounds.size().maxCoeff();
  const Surroundings walls = walls_of(container);
  LargestRoom largest;
  const auto look = [&](const Vector<3>& center, const Vector<3>& half) {
    const Cell cell{center, half, container.clearance(center)};
    // The roomiest so far is a good place to climb from.
    if (cell.clearance > largest.radius) {
      const Room top = climb({center, cell.clearance}, std::numeric_limits<double>::infinity(),
                             0.5 * cell.clearance, walls, container.dimension());
      largest.place = top.place;
      largest.radius = top.radius;
    }
    open.push(cell);
  };
  look(bounds.center(), 0.5 * bounds.size());
  const double roundings = 64 * tolerance::roundoff * extent;
  int cells = 0;
  while (open.top().bound() > largest.radius + roundings && cells < most_cells) {
    const Cell cell = open.top();
    open.pop();
    int axis;
    cell.half.maxCoeff(&axis);
    Vector<3> half = cell.half;
    half[axis] *= 0.5;
    for (const double side : {-1.0, 1.0}) {
      look(cell.center + side * half[axis] * Vector<3>::Unit(axis), half);
      ++cells;
    }
  }
  largest.bound = std::max(largest.radius, open.top().bound());
  return largest;
}

}  // namespace bernal
