#include "fly/fly_patent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bernal/core/dimension.hpp"
#include "core/every_dimension.hpp"
#include "fly/fly_run.hpp"

namespace bernal {
namespace {

/// Of all spheres, one is tried for so many in a batch where nothing is said. 2,000 to 0.42 in three
/// dimensions take 8.7 s, with batches of a hundredth 22 s. With half of all, in two dimensions, so many
/// places are tried between two short steps that the box counts as full at 0.622; with a tenth it takes 0.64
/// in 6 s.
constexpr std::size_t spheres_for_each_tried = 10;
/// So often Δt is halved before what is left of it counts as no time.
constexpr int most_halvings = 40;

}  // namespace

template <int D>
PatentFlight<D>::PatentFlight(FlyingSpheres<D>& spheres, const Fly& options, Random random)
    : spheres_(spheres),
      batch_(options.batch > 0 ? static_cast<std::size_t>(options.batch)
                               : std::max<std::size_t>(1, spheres.wanted() / spheres_for_each_tried)),
      dt_(*options.dt * 2 * spheres.mean_radius()),
      random_(random) {
  next_.resize(static_cast<Eigen::Index>(spheres.wanted()), D);
}

template <int D>
std::size_t PatentFlight<D>::insert() {
  return spheres_.insert(
      batch_, random_, [&](const Vector<D>& c, double r) { return spheres_.is_free(c, r); },
      [&](const Vector<D>&) {
        if (spheres_.is_worn()) spheres_.sort();
      });
}

template <int D>
void PatentFlight<D>::turn_back_at_faces() {
  for (int k = 0; k < D; ++k) {
    if (!spheres_.repeats(k)) continue;
    for (Id i = 0; i < spheres_.size(); ++i) {
      const double x = spheres_.x(i, k);
      double& v = spheres_.v(i, k);
      if (x < 0) v = std::abs(v);
      if (x > spheres_.edge(k)) v = -std::abs(v);
    }
  }
}

template <int D>
int PatentFlight<D>::hits(const typename FlyingSpheres<D>::Columns& x, Hit (&found)[2]) const {
  int count = 0;
  // What rounding left too near and separates will be all right by itself.
  const double tolerated = 1 - 0.5 * spheres_.margin();
  for (const auto& [i, j] : spheres_.pairs()) {
    const double contact = spheres_.contact(i, j);
    const Vector<D> d = spheres_.nearest(spheres_.row(x, i) - spheres_.row(x, j));
    const double squared = d.squaredNorm();
    if (squared >= contact * contact) continue;
    const bool separate = d.dot(spheres_.velocity(i) - spheres_.velocity(j)) >= 0;
    if (separate && squared >= tolerated * tolerated * contact * contact) continue;
    found[count++] = {i, j, -1};
    if (count == 2) return count;
  }
  for (int k = 0; k < D; ++k) {
    if (spheres_.repeats(k)) continue;
    for (Id i = 0; i < spheres_.size(); ++i) {
      const double r = spheres_.radius(i), v = spheres_.v(i, k);
      const double beyond = std::max(spheres_.low(r) - x(i, k), x(i, k) - spheres_.high(k, r));
      if (beyond <= 0) continue;
      const bool separate = (x(i, k) < 0.5 * spheres_.edge(k)) == (v > 0);
      if (separate && beyond <= 0.5 * spheres_.margin() * r) continue;
      found[count++] = {i, i, k};
      if (count == 2) return count;
    }
  }
  return count;
}

/// When those that overlap after Δt touch, seen from where they were before; 0 where they do so already.
template <int D>
double PatentFlight<D>::time_to(const Hit& hit) const {
  if (hit.wall >= 0) {
    const double r = spheres_.radius(hit.first), v = spheres_.v(hit.first, hit.wall);
    const double x = spheres_.x(hit.first, hit.wall);
    if (v == 0) return 0;
    return std::max(0.0, ((v < 0 ? spheres_.low(r) : spheres_.high(hit.wall, r)) - x) / v);
  }
  const Vector<D> d = spheres_.nearest(spheres_.center(hit.first) - spheres_.center(hit.second));
  const Vector<D> w = spheres_.velocity(hit.first) - spheres_.velocity(hit.second);
  const double contact = spheres_.contact(hit.first, hit.second);
  const double b = d.dot(w), c = d.squaredNorm() - contact * contact;
  if (c <= 0 || b >= 0) return 0;
  const double root = b * b - w.squaredNorm() * c;
  return root > 0 ? c / (-b + std::sqrt(root)) : 0;
}

template <int D>
void PatentFlight<D>::collide(const Hit& hit) {
  ++collisions_;
  if (hit.wall >= 0) {
    double& v = spheres_.v(hit.first, hit.wall);
    v = spheres_.x(hit.first, hit.wall) < 0.5 * spheres_.edge(hit.wall) ? std::abs(v) : -std::abs(v);
    return;
  }
  spheres_.collide(hit.first, hit.second);
}

template <int D>
void PatentFlight<D>::step() {
  ++steps_;
  if (spheres_.size() == 0) return;
  const auto n = static_cast<Eigen::Index>(spheres_.size());
  turn_back_at_faces();
  const double fastest = std::sqrt(spheres_.velocities().square().rowwise().sum().maxCoeff());
  double dt = std::min(dt_, 0.5 * std::min(spheres_.smallest_radius(), 0.5 * spheres_.skin()) / fastest);
  if (flown_ + fastest * dt > 0.5 * spheres_.skin()) {
    spheres_.sort();
    flown_ = 0;
  }
  for (int halvings = 0; halvings < most_halvings; ++halvings, dt /= 2) {
    next_.topRows(n) = spheres_.places() + spheres_.velocities() * dt;
    Hit found[2];
    const int overlapping = hits(next_, found);
    if (overlapping > 1) continue;
    double taken = dt;
    if (overlapping == 1) {
      taken = std::min(dt, time_to(found[0]));
      next_.topRows(n) = spheres_.places() + spheres_.velocities() * taken;
      const Vector<D> v[2] = {spheres_.velocity(found[0].first), spheres_.velocity(found[0].second)};
      std::swap(spheres_.x, next_);
      collide(found[0]);
      Hit other[2];
      if (hits(spheres_.x, other) > 0) {  // a third one, or another image
        std::swap(spheres_.x, next_);
        spheres_.set_velocity(found[0].first, v[0]);
        spheres_.set_velocity(found[0].second, v[1]);
        --collisions_;
        continue;
      }
    } else {
      std::swap(spheres_.x, next_);
    }
    flown_ += fastest * taken;
    spheres_.update();
    return;
  }
  // Several at the same time: one after the other, without a move.
  Hit found[2];
  if (hits(next_, found) > 0) collide(found[0]);
}

StageEnd fly_by_patent(SpheresInBox& in_box, Reporter& report, const Fly& options) {
  return with_dimension(in_box.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    return fly_until_full<PatentFlight<D>, D>(in_box, report, options);
  });
}

#define BERNAL_INSTANTIATE(D) template class PatentFlight<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
