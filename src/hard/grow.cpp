#include "hard/grow.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "hard/growth_schedule.hpp"
#include "hard/hard_spheres.hpp"
#include "jam/finish_in_periodic_box.hpp"
#include "work/free_of_overlap.hpp"
#include "work/random_insertion.hpp"
#include "work/resize_box.hpp"

namespace bernal {
namespace {

/// Random places tried for a sphere before the insertion counts as stuck.
constexpr int most_trials = 100000;
/// Spheres grow by this much beyond the size that was asked for, so that the box has room for rounding.
constexpr double room_for_rounding = 1e-12;
/// A milestone for each growth by this much of the logarithm of the compressibility.
constexpr double milestone_every = 0.1;

/// Random sequential insertion between the walls. Returns whether all have found places.
template <int D>
bool insert_at_random(Spheres<D>& spheres, const Vector<D>& edges, const std::vector<bool>& walls,
                      Random random) {
  const Boundary<D> boundary{edges_around_walls(edges, walls)};
  const auto between_walls = [&](double r) {
    Bounds<D> bounds{Vector<D>::Zero(), edges};
    for (int k = 0; k < D; ++k)
      if (!walls.empty() && walls[static_cast<std::size_t>(k)]) bounds.lower[k] += r, bounds.upper[k] -= r;
    return uniform_point(random, bounds);
  };
  return bernal::insert_at_random<D>(spheres, std::vector<bool>(spheres.size(), false), 1,
                                     {Vector<D>::Zero(), boundary.edges}, boundary, most_trials,
                                     between_walls, [](const Vector<D>&, double) { return true; });
}

/// Tells the run how far it has come, now and then.
class Milestones {
 public:
  Milestones(PeriodicWork& work, double pressure) : work_(work), pressure_(pressure) {}

  void pass(const Vector<dynamic>& edges, double filled, const FlightPeriod& period) {
    work_.edges = edges;
    const double squeezed = std::log(std::max(1.0, period.compressibility));
    const double done = std::max(filled, squeezed / std::log(pressure_));
    if (squeezed < next_ && filled < next_filled_) return;
    next_ = squeezed + milestone_every;
    next_filled_ = filled + 0.01;
    work_.milestone("grow", std::clamp(done, 0.0, 0.99), 0);
  }

 private:
  PeriodicWork& work_;
  double pressure_;
  double next_ = 0, next_filled_ = 0;
};

/// Those of the box, in its coordinates.
template <int D>
std::vector<Wall<D>> walls_of(const PeriodicWork& work, const Vector<D>& edges) {
  std::vector<Wall<D>> walls;
  for (int k = 0; k < D; ++k) {
    if (!work.has_wall(k)) continue;
    walls.push_back({.along = -Vector<D>::Unit(k), .extent = 0});
    walls.push_back({.along = Vector<D>::Unit(k), .extent = edges[k]});
  }
  return walls;
}

template <int D>
void require_room(const Spheres<D>& spheres, const Vector<D>& box, const std::vector<bool>& walls) {
  const Vector<D> edges = edges_around_walls(box, walls);
  const double diameters = edges.minCoeff() / (2 * std::ranges::max(spheres.r));
  if (diameters < HardSpheres<D>::smallest_edge)
    throw Error(ErrorCode::bad_scene,
                fmt::format("grow needs a box at least {} of the largest diameters wide; {} spheres of these "
                            "sizes make one of {:.2f}. Take more spheres, or relax instead",
                            HardSpheres<D>::smallest_edge, spheres.size(), diameters));
}

template <int D>
void start(Spheres<D>& spheres, Vector<D>& edges, PeriodicWork& work, double phi_init) {
  if (work.placed) {
    if (work.allowed_overlap > 0) {  // other stages may leave some
      const Vector<D> free = edges_free_of_overlap<D>(spheres, edges, 0, work.walls);
      if (free[0] > edges[0]) resize_box<D>(spheres, edges, free);
    }
    require_room<D>(spheres, edges, work.walls);
    return;
  }
  const EffectTimer timer(work.effects["insertion"]);
  double volume = work.volume_of_spheres() / phi_init;
  if (work.target_edges) volume = std::max(volume, work.target_edges->prod());
  edges *= std::pow(volume / edges.prod(), 1.0 / D);
  require_room<D>(spheres, edges, work.walls);
  if (!insert_at_random<D>(spheres, edges, work.walls, work.random(Stream::grow)))
    throw Error(ErrorCode::bad_scene,
                fmt::format("grow cannot start at phi_init = {}: random insertion found no place for one of "
                            "the spheres; take a smaller one",
                            phi_init));
}

template <int D>
StageEnd grow_in(PeriodicWork& work, const GrowOptions& options) {
  if (options.polish > 0 && !work.walls.empty())
    throw Error(ErrorCode::bad_scene, "\"polish\" knows no walls; leave it out");
  Spheres<D> spheres = work.spheres.in<D>();
  Vector<D> edges = work.edges;
  start<D>(spheres, edges, work, options.phi_init);

  HardSpheres<D> flight(spheres, edges_around_walls(edges, work.walls), work.random(Stream::grow),
                        {.walls = walls_of(work, edges), .masses = options.masses});
  const double volume = edges.prod();
  double largest = std::numeric_limits<double>::infinity();
  if (work.target_edges)
    largest = std::max(1.0, std::pow(volume / work.target_edges->prod(), 1.0 / D)) * (1 + room_for_rounding);
  const GrowthSchedule<D> schedule(spheres, volume, options);

  Effect& collisions = work.effects["collisions"];
  Effect& shells = work.effects["neighbour shells"];
  Milestones milestones(work, options.pressure);
  StageEnd end = StageEnd::converged;
  FlightPeriod period;
  while (flight.size() < largest && period.compressibility < options.pressure) {
    if (!flight.has_room()) {
      end = StageEnd::hit_limit;
      break;
    }
    period = flight.fly(schedule.at(period.compressibility), largest, work.monitor);
    collisions.calls += period.collisions;
    shells.calls += period.departures + period.builds;
    if (period.reflections > 0) work.effects["reflections"].calls += period.reflections;
    if (period.stopped) {
      end = StageEnd::cancelled;
      break;
    }
    const double filled = std::isfinite(largest) ? std::pow(flight.size() / largest, D) : 0;
    milestones.pass(edges / flight.size(), filled, period);
  }
  flight.write_to(spheres);
  free_of_overlap<D>(spheres, edges, work);
  return finish_in_periodic_box<D>(std::move(spheres), edges, end, options.polish, work);
}

}  // namespace

StageEnd grow(PeriodicWork& work, const GrowOptions& options) {
  EffectTimer timer(work.effects["growth"]);
  return with_dimension(work.dimension(), std::integer_sequence<int, 2, 3, 4, 5, 6>{},
                        [&](auto dimension) { return grow_in<decltype(dimension)::value>(work, options); });
}

}  // namespace bernal
