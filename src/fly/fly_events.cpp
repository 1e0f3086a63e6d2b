#include "fly/fly_events.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bernal/core/dimension.hpp"
#include "core/every_dimension.hpp"
#include "fly/fly_run.hpp"

namespace bernal {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
/// How often a new centre is pushed before it is given up.
constexpr int pushes = 12;
/// A list that leaves a sphere less than this share of its way is made anew before the next stretch.
constexpr double worn = 0.3;

}  // namespace

template <int D>
EventFlight<D>::EventFlight(FlyingSpheres<D>& spheres, const Fly& options, Random random)
    : spheres_(spheres),
      batch_(options.batch > 0 ? static_cast<std::size_t>(options.batch)
                               : std::max<std::size_t>(1, spheres.wanted() / 2)),
      dt_(*options.dt * 2 * spheres.mean_radius()),
      random_(random),
      small_(spheres.is_small()) {
  from_.resize(static_cast<Eigen::Index>(spheres.wanted()), D);
  list_pairs();
}

template <int D>
void EventFlight<D>::list_pairs() {
  spheres_.wrap_all();
  spheres_.sort();
  near_.assign(spheres_.size(), {});
  listed_ = 0;
  list_new_pairs();
  from_ = spheres_.x;
}

template <int D>
void EventFlight<D>::list_new_pairs() {
  for (; listed_ < spheres_.pairs().size(); ++listed_) {
    const auto [i, j] = spheres_.pairs()[listed_];
    near_[i].push_back(j);
    near_[j].push_back(i);
  }
}

template <int D>
std::size_t EventFlight<D>::insert() {
  if (spheres_.is_worn()) {
    list_pairs();
  } else {
    spheres_.update();
  }
  const std::size_t accepted = spheres_.insert(
      batch_, random_, [&](Vector<D>& c, double r) { return spheres_.push_into_room(c, r, pushes); },
      [&](const Vector<D>& c) {
        spheres_.set_row(from_, static_cast<Id>(spheres_.size() - 1), c);
        near_.emplace_back();
        if (spheres_.is_worn()) list_pairs();
      });
  list_new_pairs();
  return accepted;
}

template <int D>
void EventFlight<D>::move_to(Id i, double t) {
  const double dt = t - time_[i];
  time_[i] = t;
  if (dt <= 0) return;
  for (int k = 0; k < D; ++k) spheres_.x(i, k) += dt * spheres_.v(i, k);
  room_[i] -= dt * std::sqrt(spheres_.squared_norm(spheres_.v, i));
}

template <int D>
double EventFlight<D>::time_to_meet(const Vector<D>& d, const Vector<D>& w, double contact) const {
  const double b = d.dot(w);
  if (b >= 0) return never;
  const double c = d.squaredNorm() - contact * contact;
  if (c <= 0) return 0;  // rounding left them at contact
  const double root = b * b - w.squaredNorm() * c;
  return root > 0 ? c / (-b + std::sqrt(root)) : never;
}

template <int D>
double EventFlight<D>::time_to_meet(Id i, Id j, Vector<D>& way) const {
  const Vector<D> w = spheres_.velocity(i) - spheres_.velocity(j);
  const double contact = spheres_.contact(i, j);
  const double t = std::max(time_[i], time_[j]);
  const Vector<D> d =
      spheres_.nearest(spheres_.center(i) - spheres_.center(j) + (t - time_[i]) * spheres_.velocity(i) -
                       (t - time_[j]) * spheres_.velocity(j));
  if (!small_) {
    way = d;
    return time_to_meet(d, w, contact);
  }
  // Every image that may come near enough: axis by axis, as its distance is nowhere less than along an axis.
  const double reach = contact + 2 * spheres_.skin();
  std::array<std::array<double, 3>, D> images;
  std::array<int, D> count, at{};
  for (int k = 0; k < D; ++k) {
    count[k] = 0;
    images[k][count[k]++] = d[k];
    for (const double image : {d[k] - spheres_.edge(k), d[k] + spheres_.edge(k)})
      if (spheres_.repeats(k) && std::abs(image) < reach) images[k][count[k]++] = image;
  }
  double first = never;
  for (;;) {
    Vector<D> image;
    for (int k = 0; k < D; ++k) image[k] = images[k][at[k]];
    if (const double time = time_to_meet(image, w, contact); time < first) {
      first = time;
      way = image;
    }
    int k = 0;
    while (k < D && ++at[k] == count[k]) at[k++] = 0;
    if (k == D) return first;
  }
}

template <int D>
void EventFlight<D>::foresee_pair(Id i, Id j) {
  Vector<D> way;
  const double time = std::max(time_[i], time_[j]) + time_to_meet(i, j, way);
  if (time < end_) events_.push({time, i, j, hits_[i], hits_[j]});
}

template <int D>
void EventFlight<D>::foresee_alone(Id i) {
  const double speed = std::sqrt(spheres_.squared_norm(spheres_.v, i));
  if (const double time = time_[i] + std::max(0.0, room_[i]) / speed; time < end_)
    events_.push({time, i, leaves_list, hits_[i], 0});
  for (int k = 0; k < D; ++k) {
    const double v = spheres_.v(i, k), r = spheres_.radius(i);
    if (spheres_.repeats(k) || v == 0) continue;
    const double way = (v < 0 ? spheres_.low(r) : spheres_.high(k, r)) - spheres_.x(i, k);
    if (const double time = time_[i] + std::max(0.0, way / v); time < end_)
      events_.push({time, i, wall + static_cast<Id>(k), hits_[i], 0});
  }
}

template <int D>
void EventFlight<D>::foresee(Id i) {
  foresee_alone(i);
  for (const Id j : near_[i]) foresee_pair(i, j);
}

template <int D>
bool EventFlight<D>::is_stale(const Event& event) const {
  if (hits_[event.first] != event.first_hits) return true;
  return event.second < wall && hits_[event.second] != event.second_hits;
}

template <int D>
void EventFlight<D>::collide(const Event& event) {
  const Id i = event.first, j = event.second;
  ++collisions_;
  ++hits_[i];
  if (j >= wall) {
    double& v = spheres_.v(i, static_cast<int>(j - wall));
    v = -v;
    foresee(i);
    return;
  }
  Vector<D> way = spheres_.nearest(spheres_.center(i) - spheres_.center(j));
  if (small_) time_to_meet(i, j, way);
  spheres_.collide(i, j, way);
  ++hits_[j];
  foresee(i);
  foresee(j);
}

template <int D>
void EventFlight<D>::fly() {
  const std::size_t n = spheres_.size();
  if (n == 0) return;
  const double reach = 0.5 * spheres_.skin();
  const auto measure_room = [&] {
    double least = reach;
    room_.assign(n, reach);
    for (Id i = 0; i < n; ++i) {
      room_[i] -= std::sqrt(spheres_.squared_distance(spheres_.x, from_, i));
      least = std::min(least, room_[i]);
    }
    return least;
  };
  if (measure_room() < worn * reach) {
    list_pairs();
    measure_room();
  }
  time_.assign(n, 0);
  hits_.assign(n, 0);
  end_ = dt_;
  for (Id i = 0; i < n; ++i) foresee_alone(i);
  for (const auto& [i, j] : spheres_.pairs()) foresee_pair(i, j);
  // A cluster that could collide for ever within no time does not.
  const std::uint64_t most = collisions_ + 10000 * static_cast<std::uint64_t>(n);
  while (!events_.empty() && collisions_ < most) {
    const Event event = events_.top();
    events_.pop();
    if (is_stale(event)) continue;
    if (event.second == leaves_list) {
      end_ = event.time;
      break;
    }
    const EventClock::Event timed(times_);
    move_to(event.first, event.time);
    if (event.second < wall) move_to(event.second, event.time);
    collide(event);
  }
  if (collisions_ == most)  // all stand at the latest time that is free of collisions
    end_ = events_.empty() ? end_ : std::min(end_, events_.top().time);
  events_ = {};
  for (Id i = 0; i < n; ++i) move_to(i, end_);
}

StageEnd fly_by_events(SpheresInBox& in_box, Reporter& report, const Fly& options) {
  return with_dimension(in_box.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    return fly_until_full<EventFlight<D>, D>(in_box, report, options);
  });
}

#define BERNAL_INSTANTIATE(D) template class EventFlight<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
