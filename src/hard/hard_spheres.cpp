#include "hard/hard_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bernal/core/boundary.hpp"
#include "bernal/core/tolerance.hpp"
#include "hard/place_on_curve.hpp"
#include "hard/prefetch.hpp"

namespace bernal {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Per sphere. With fewer, starting periods costs more; with more, velocities drift from their unit.
constexpr double collisions_a_period = 16;
/// A period after one that gained more kinetic energy than this is shorter.
constexpr double most_heating = 0.1;
constexpr double fastest_change_of_duration = 4;
/// The first period in mean diameters per sphere: a few collisions in all. One alone looks like pressure.
constexpr double first_duration = 1;
/// The longest period, in shortest edges at thermal speed: paths of many edges would cost digits.
constexpr double longest_flight = 4;
/// The largest growth of the size in a period.
constexpr double most_growth = 0.1;
/// Per sphere, thirty times the usual number: a few spheres that jam within a period would never reach its
/// end.
constexpr std::uint64_t most_events_a_period = 400;
/// Events between two questions whether to stop.
constexpr std::uint64_t events_a_look = 4096;
/// The least change of velocity in a collision, as a share of the thermal speed.
constexpr double least_kick = 1e-14;
/// Events in the calendar per collision, with renewed searches and departures from shells.
constexpr double events_a_collision = 1.8;
/// Above this number the caches do not hold all spheres; then data are prefetched `step_ahead` events ahead.
constexpr std::size_t few_spheres = 3000, step_ahead = 2;

/// Width of the shells in mean diameters: at first, and its limits where lists are longer than `short_list`.
constexpr double first_freedom = 0.15, least_freedom = 0.02, most_freedom = 1.0, short_list = 4;
/// The shells are as wide as they should be while departures per collision are between these; else their
/// width changes by a factor.
constexpr double few_departures = 0.06, many_departures = 0.15, change_of_freedom = 1.3;
/// The share of the shells that lists leave for growth.
constexpr double room_to_grow = 0.25;

}  // namespace

template <int D>
HardSpheres<D>::HardSpheres(const Spheres<D>& spheres, const Vector<D>& edges, Random random,
                            HardSphereOptions<D> options)
    : spheres_(spheres.size()),
      original_(spheres.size()),
      edges_(edges),
      kernel_(options.kernel ? *options.kernel : collision_kernels<D>().front()),
      walls_(std::move(options.walls), edges, options.facets),
      room_at_walls_(options.room_at_walls) {
  const std::size_t n = spheres.size();
  if (options.masses == Masses::by_volume) {
    density_ = 1;
    double volumes = 0;
    for (const double r : spheres.r) volumes += mass(r);
    density_ = static_cast<double>(n) / volumes;
  }
  Vector<D> momentum = Vector<D>::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    FlyingSphere<D>& s = spheres_[i];
    s.r = spheres.r[i];
    const double speed = 1 / std::sqrt(mass(s.r));
    for (int k = 0; k < D; ++k) {
      s.x0[k] = spheres.x[static_cast<std::size_t>(k)][i];
      s.v[k] = speed * random.uniform(-1, 1);
      momentum[k] += mass(s.r) * s.v[k];
    }
  }
  std::iota(original_.begin(), original_.end(), 0u);
  if (walls_.empty() && n > 1)
    for (FlyingSphere<D>& s : spheres_)
      for (int k = 0; k < D; ++k) s.v[k] -= momentum[k] / static_cast<double>(n);
  rescale_velocities();
  mean_diameter_ = 2 * std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) / static_cast<double>(n);
  largest_radius_ = std::ranges::max(spheres.r);
  freedom_ = first_freedom * mean_diameter_;
  for (int k = 0; k < D; ++k) {
    scan_.edges[k] = edges[k];
    scan_.inverse_edges[k] = 1 / edges[k];
  }
}

template <int D>
double HardSpheres<D>::kinetic_energy() const {
  double sum = 0;
  for (const FlyingSphere<D>& s : spheres_)
    for (int k = 0; k < D; ++k) sum += mass(s.r) * s.v[k] * s.v[k];
  return 0.5 * sum;
}

template <int D>
void HardSpheres<D>::rescale_velocities() {
  const double factor = std::sqrt(0.5 * D * static_cast<double>(spheres_.size()) / kinetic_energy());
  for (FlyingSphere<D>& s : spheres_)
    for (int k = 0; k < D; ++k) s.v[k] *= factor;
}

template <int D>
void HardSpheres<D>::write_to(Spheres<D>& spheres) const {
  const Boundary<D> boundary{edges_};
  for (std::size_t i = 0; i < spheres_.size(); ++i)
    spheres.set_center(original_[i], boundary.wrap(spheres_[i].position(0)));
}

template <int D>
double HardSpheres<D>::duration(double growth, double largest) const {
  double time = first_duration * mean_diameter_ * size_ / static_cast<double>(count());
  if (period_.time > 0) {
    const double rate = static_cast<double>(2 * period_.collisions + period_.reflections) /
                        (static_cast<double>(count()) * period_.time);
    time = rate > 0 ? collisions_a_period / rate : infinite;
    if (period_.heating > 0) time = std::min(time, period_.time * most_heating / period_.heating);
    time = std::clamp(time, period_.time / fastest_change_of_duration,
                      period_.time * fastest_change_of_duration);
  }
  time = std::min(time, longest_flight * edges_.minCoeff());
  if (growth > 0)
    time = std::min(
        {time, (largest - size_) * mean_diameter_ / growth, most_growth * size_ * mean_diameter_ / growth});
  return time;
}

/// Shells that are left too often cost renewals, those that are hardly left cost long lists.
template <int D>
double HardSpheres<D>::wanted_freedom() const {
  if (2 * (listed_collisions_ + listed_departures_) < count()) return freedom_;
  const double departures = static_cast<double>(listed_departures_) / static_cast<double>(listed_collisions_);
  if (departures > many_departures) {
    const double larger = std::min(freedom_ * change_of_freedom, edges_.minCoeff());
    return shells_.mean_list() < short_list
               ? larger
               : std::max(freedom_, std::min(larger, most_freedom * mean_diameter_));
  }
  if (departures < few_departures)
    return std::max(freedom_ / change_of_freedom, least_freedom * mean_diameter_);
  return freedom_;
}

/// So that spheres which meet lie near each other in memory.
template <int D>
void HardSpheres<D>::sort_along_curve() {
  const Boundary<D> boundary{edges_};
  std::vector<std::pair<std::uint64_t, Id>> places(count());
  for (Id i = 0; i < count(); ++i)
    places[i] = {place_on_curve<D>(boundary.wrap(spheres_[i].position(0)), edges_), i};
  std::ranges::sort(places);
  const LargePageVector<FlyingSphere<D>> spheres = spheres_;
  const std::vector<Id> original = original_;
  for (Id i = 0; i < count(); ++i) {
    spheres_[i] = spheres[places[i].second];
    original_[i] = original[places[i].second];
  }
}

template <int D>
void HardSpheres<D>::build_shells(double freedom, double largest) {
  const EventClock::Seconds timed(times_.builds);
  sort_along_curve();
  freedom_ = freedom;
  listed_collisions_ = listed_departures_ = 0;
  largest_listed_ = std::max(
      largest, std::min(size_ + room_to_grow * freedom_ / mean_diameter_, (1 + most_growth) * size_));
  std::vector<Vector<D>> homes(count());
  std::vector<double> radii(count()), freedoms(count());
  // Two spheres whose shells touch are still nearer than half an edge.
  const double most = (edges_.minCoeff() / 2 - 2 * largest_radius_ * largest_listed_) / 4;
  const Boundary<D> boundary{edges_};
  for (std::size_t i = 0; i < count(); ++i) {
    homes[i] = boundary.wrap(spheres_[i].position(0));
    spheres_[i].set_course(0, homes[i], spheres_[i].velocity());
    radii[i] = spheres_[i].r * largest_listed_;
    freedoms[i] = std::min(most, freedom_ / std::sqrt(2 * spheres_[i].r / mean_diameter_));
  }
  shells_.build(homes, radii, freedoms, edges_);
  if (walls_.empty()) return;
  walls_.start(count(), largest_radius_ * listed_at_walls() + std::ranges::max(freedoms));
  for (Id i = 0; i < count(); ++i) settle_at_walls(i, homes[i], freedoms[i]);
}

template <int D>
FlightPeriod HardSpheres<D>::fly(double growth, double largest, const Monitor& monitor) {
  if (monitor.stop()) return {.stopped = true};
  if (growth > 0) rescale_velocities();
  growth_ = growth / mean_diameter_;
  horizon_ = duration(growth, largest);
  const double size_then = std::min(largest, size_ + growth_ * horizon_);
  const double freedom = wanted_freedom();
  const bool rebuild = size_then > largest_listed_ || freedom != freedom_;
  if (rebuild) build_shells(freedom, size_then);

  const double energy = kinetic_energy();
  const double expected_collisions =
      period_.time > 0
          ? static_cast<double>(period_.collisions + period_.reflections) * horizon_ / period_.time
          : static_cast<double>(count());
  calendar_.start_period(
      count(), horizon_,
      static_cast<std::size_t>(expected_collisions * events_a_collision + static_cast<double>(count()) / 4));
  period_ = {.builds = rebuild};
  virial_ = 0;
  now_ = 0;
  prefetched_day_ = prefetched_ = 0;
  scan_.size = size_;
  scan_.growth = growth_;
  for (Id i = 0; i < count(); ++i) predict(i);

  std::uint64_t events = 0;
  for (Id i; (i = calendar_.next()) != Calendar::none;) {
    if (events == most_events_a_period * count()) {
      horizon_ = now_;
      break;
    }
    if (++events % events_a_look == 0 && monitor.stop()) {
      horizon_ = now_;
      period_.stopped = true;
      break;
    }
    Id what = calendar_.what(i);
    if (is_partner(what) && !is_mutual(i, what)) what = look_again;
    const EventClock::Event event(clock_of(what));
    if (count() > few_spheres) prefetch();
    now_ = calendar_.time(i);
    if (is_partner(what)) {
      collide(i, what);
      schedule(i, infinite, look_again);
      schedule(what, infinite, look_again);
    } else if (what == leave) {
      ++period_.departures;
      const Vector<D> home = Boundary<D>{edges_}.wrap(spheres_[i].position(now_));
      spheres_[i].set_course(now_, home, spheres_[i].velocity());
      shells_.settle(i, home);
      if (!walls_.empty()) settle_at_walls(i, home, shells_.freedom(i));
    } else if (what == touch_wall) {
      reflect(i);
    }
    predict(i);
    if (is_partner(what)) predict(what);
  }

  for (FlyingSphere<D>& s : spheres_) {
    s.set_course(0, s.position(horizon_), s.velocity());
    s.event = infinite;
  }
  size_ += growth_ * horizon_;
  if (growth > 0 && size_ > largest * (1 - 4 * tolerance::roundoff)) size_ = largest;
  listed_collisions_ += period_.collisions;
  listed_departures_ += period_.departures;
  period_.time = horizon_;
  period_.heating = kinetic_energy() / energy - 1;
  if (horizon_ > 0)
    period_.compressibility_factor = 1 + virial_ / (2 * energy * horizon_);
  else if (period_.collisions + period_.reflections > 0)
    period_.compressibility_factor = infinite;  // they cannot get apart
  return period_;
}

/// With many spheres most of the time goes into waiting for the memory. What the events of today will need is
/// asked for some events ahead, in steps, as each step tells where the next one finds its data.
template <int D>
void HardSpheres<D>::prefetch() {
  if (prefetched_day_ != calendar_.day()) {
    prefetched_day_ = calendar_.day();
    prefetched_ = 0;
  }
  // Both partners of a collision have it for an event, one behind the other.
  const auto ahead = [&](std::size_t steps) {
    const Id id = prefetched_ < steps * step_ahead ? Calendar::none
                                                   : calendar_.of_today(prefetched_ - steps * step_ahead);
    if (id == Calendar::none) return id;
    const Id what = calendar_.what(id);
    return is_partner(what) && what < id && is_mutual(id, what) ? Calendar::none : id;
  };
  const auto prefetch_neighbors = [&](Id i) {
    for (const Id j : shells_.neighbors(i)) bernal::prefetch(&spheres_[j]);
  };
  for (; prefetched_ <= calendar_.over() + 4 * step_ahead; ++prefetched_) {
    if (const Id id = calendar_.of_today(prefetched_); id != Calendar::none)
      if (const Id what = calendar_.what(id); is_partner(what)) calendar_.prefetch(what);
    if (const Id id = ahead(1); id != Calendar::none) {
      bernal::prefetch(&spheres_[id]);
      shells_.prefetch(id);
      if (const Id what = calendar_.what(id); is_partner(what)) {
        bernal::prefetch(&spheres_[what]);
        shells_.prefetch(what);
      }
    }
    if (const Id id = ahead(2); id != Calendar::none) {
      shells_.prefetch_list(id);
      if (const Id what = calendar_.what(id); is_partner(what)) {
        shells_.prefetch_list(what);
      } else if (what == leave) {
        const Vector<D> then = spheres_[id].position(calendar_.time(id));
        shells_.prefetch_settling(id, Boundary<D>{edges_}.wrap(then));
      }
    }
    if (const Id id = ahead(3); id != Calendar::none) {
      prefetch_neighbors(id);
      if (const Id what = calendar_.what(id); is_partner(what)) prefetch_neighbors(what);
    }
  }
}

template <int D>
double HardSpheres<D>::time_to_leave(Id i) const {
  const Vector<D> v = spheres_[i].velocity(), q = spheres_[i].position(now_) - shells_.home(i);
  const double freedom = shells_.freedom(i), qv = q.dot(v), vv = v.squaredNorm();
  const double c = q.squaredNorm() - freedom * freedom;
  const double root = std::sqrt(std::max(0.0, qv * qv - vv * c));
  return std::max(0.0, qv > 0 ? -c / (qv + root) : (root - qv) / vv);
}

/// The next event of sphere i. A collision is only taken if the other has nothing earlier to do: otherwise
/// that comes first, and then the other looks again. So does whom the other was to meet, when that comes up:
/// it is found out there, as it would have to be looked up here.
template <int D>
void HardSpheres<D>::predict(Id i) {
  ++period_.predictions;
  const std::span<const Id> neighbors = shells_.neighbors(i);
  if (scratch_.size() < (2 * D + 3) * (shells_.longest_list() + 2 * widest)) {
    scan_.stride = (shells_.longest_list() + 2 * widest) / widest * widest;
    scratch_.resize((2 * D + 3) * (scan_.stride + widest));
  }
  scan_.columns = scratch_.data();
  scan_.delays = scratch_.data() + (2 * D + 2) * scan_.stride;
  scan_.spheres = spheres_.data();
  scan_.self = &spheres_[i];
  scan_.neighbors = neighbors.data();
  scan_.count = neighbors.size();
  period_.scanned += neighbors.size();
  scan_.now = now_;
  const double leaves = time_to_leave(i);
  const double end = std::min(leaves, horizon_ - now_);
  const double touches = walls_.empty() ? infinite : time_to_touch_wall(i, end);
  const double limit = std::min(end, touches);
  for (FirstCollision first = kernel_.scan(scan_); first.delay < limit;) {
    const Id j = neighbors[first.neighbor];
    const double time = now_ + first.delay;
    if (time <= spheres_[j].event) {
      schedule(j, time, i);
      schedule(i, time, j);
      return;
    }
    scan_.delays[first.neighbor] = infinite;
    const double* const next = std::min_element(scan_.delays, scan_.delays + scan_.count);
    first = {*next, static_cast<std::size_t>(next - scan_.delays)};
  }
  if (touches < leaves)
    schedule(i, now_ + touches, touch_wall);
  else
    schedule(i, now_ + leaves, leave);
}

template <int D>
void HardSpheres<D>::collide(Id i, Id j) {
  FlyingSphere<D>&a = spheres_[i], &b = spheres_[j];
  const double radii = a.r + b.r;
  const Vector<D> at_a = a.position(now_), at_b = b.position(now_);
  Vector<D> d = at_b - at_a;
  for (int k = 0; k < D; ++k) d[k] -= edges_[k] * std::nearbyint(d[k] * scan_.inverse_edges[k]);
  const double distance = d.norm(), dw = d.dot(b.velocity() - a.velocity());
  // Half the change of the relative velocity: above 0 exactly where the scan saw them come closer, and never
  // so small that it gets lost in the velocities.
  const double contact = radii * (size_ + growth_ * now_);
  const double kick = std::max(least_kick, (contact * radii * growth_ - dw) / distance);
  const double mass_a = mass(a.r), mass_b = mass(b.r), share_a = 2 * mass_b / (mass_a + mass_b),
               share_b = 2 * mass_a / (mass_a + mass_b);
  ++period_.collisions;
  const Vector<D> along = kick / distance * d;
  a.set_course(now_, at_a, a.velocity() - share_a * along);
  b.set_course(now_, at_b, b.velocity() + share_b * along);
  virial_ += mass_a * share_a * kick * distance;
}

template <int D>
void HardSpheres<D>::reflect(Id i) {
  FlyingSphere<D>& s = spheres_[i];
  const Vector<D> at = s.position(now_);
  Vector<D> v = s.velocity();
  const double kick = walls_.reflect(i, at, v, s.r * growth_at_walls(), 2 * least_kick);
  s.set_course(now_, at, v);
  ++period_.reflections;
  period_.wall_momentum += mass(s.r) * kick;
  virial_ += mass(s.r) * kick * s.r * size_at_walls();
}

#define BERNAL_INSTANTIATE(D) template class HardSpheres<D>;
BERNAL_IN_FLYING_DIMENSIONS(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
