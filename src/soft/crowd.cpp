#include "soft/crowd.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/every_dimension.hpp"

namespace bernal {
namespace {

/// Of the margin, what single precision leaves to rely on.
constexpr double share_of_margin = 0.97;
/// After so many sweeps it is looked at how far things are.
constexpr int sweeps_a_look = 25;
/// Stuck: at so many looks in a row the mean squeeze is more than this share of the least so far.
constexpr double hardly_freer = 0.85;
constexpr int most_slow_looks = 2;
constexpr int burst_sweeps = 50;
/// Sum of squared overlap ratios of a sphere that will not find its way by itself.
constexpr float severe_squeeze = 0.05f;

}  // namespace

template <class Ground>
Crowd<Ground>::Crowd(Ground ground, Spheres<D> spheres)
    : ground_(std::move(ground)), spheres_(std::move(spheres)) {
  ground_.place(spheres_);
}

template <class Ground>
void Crowd<Ground>::measure() {
  const Pace pace = pace_for(0);
  ground_.wear_lists(pace.wear);
  largest_overlap_ = ground_.sweep_and_measure(pace.omega);
  squeeze_ = ground_.squeeze();
  ++sweeps_;
  double sum = 0;
  severe_ = 0;
  for (const float s : squeeze_) {
    sum += std::sqrt(s);
    if (s > severe_squeeze) ++severe_;
  }
  mean_squeeze_ = sum / static_cast<double>(size());
}

template <class Ground>
typename Crowd<Ground>::Rest Crowd<Ground>::settle(const Monitor& monitor,
                                                   const std::function<void()>& milestone,
                                                   double most_sweeps) {
  Rest rest = Rest::stuck;
  double least_squeeze = 1e300;
  for (int slow = 0; slow < most_slow_looks;) {
    const Pace pace = pace_for(largest_overlap_);
    ground_.wear_lists(pace.wear);
    bool cancelled = false;
    for (int k = 1; k < sweeps_a_look && !cancelled; ++k) {
      ground_.sweep(pace.omega);
      ++sweeps_;
      cancelled = monitor.stop();
    }
    if (cancelled) {
      rest = Rest::cancelled;
      break;
    }
    measure();
    if (milestone) milestone();
    if (largest_overlap_ < share_of_margin * margin()) rest = Rest::free;
    if (rest == Rest::stuck && sweeps_ > most_sweeps) rest = Rest::over;
    if (rest != Rest::stuck) break;
    slow = mean_squeeze_ > hardly_freer * least_squeeze ? slow + 1 : 0;
    // May swing: only a new low counts, so that this ends.
    least_squeeze = std::min(least_squeeze, mean_squeeze_);
  }
  ground_.read_places(spheres_);
  return rest;
}

template <class Ground>
void Crowd<Ground>::burst() {
  ground_.swell(Ground::burst_swelling);
  for (int k = 0; k < burst_sweeps; ++k) ground_.sweep(pace_for(0).omega);
  sweeps_ += burst_sweeps;
  ground_.swell(1);
}

/// The largest first, of equal ones the first.
template <class Ground>
std::vector<std::uint32_t> Crowd<Ground>::most_squeezed(std::size_t count) const {
  std::vector<std::uint32_t> ids(squeeze_.size());
  std::iota(ids.begin(), ids.end(), 0u);
  count = std::min(count, ids.size() - Ground::always_stay);
  std::ranges::partial_sort(ids, ids.begin() + static_cast<std::ptrdiff_t>(count), [&](auto a, auto b) {
    return squeeze_[a] != squeeze_[b] ? squeeze_[a] > squeeze_[b] : a < b;
  });
  ids.resize(count);
  return ids;
}

template <class Ground>
void Crowd<Ground>::relocate(double share, Random& random) {
  const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(size())));
  ground_.read_places(spheres_);
  ground_.move_to_holes(spheres_, most_squeezed(std::max(count, severe_)), random);
}

template <class Ground>
void Crowd<Ground>::drop_last(std::size_t count, Random& random) {
  count = std::min(count, size() - 1);
  ground_.read_places(spheres_);
  spheres_.resize(size() - count);
  squeeze_.resize(size());
  ground_.place(spheres_);
  ground_.move_to_holes(spheres_, most_squeezed(count), random);
}

template <class Ground>
std::size_t Crowd<Ground>::add(std::span<const double> radii, Random& random) {
  ground_.read_places(spheres_);
  std::vector<std::size_t> order(radii.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return radii[i]; });
  std::vector<double> descending;
  for (const std::size_t i : order) descending.push_back(radii[i]);
  const std::vector<Vector<D>> holes = ground_.holes_for(descending, spheres_, random);
  if (holes.size() < radii.size()) return 0;
  std::vector<Vector<D>> place(radii.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = holes[k];
  for (std::size_t i = 0; i < radii.size(); ++i) spheres_.push_back(place[i], radii[i]);
  ground_.place(spheres_);
  return radii.size();
}

template <class Ground>
void Crowd<Ground>::restore(Spheres<D> spheres) {
  spheres_ = std::move(spheres);
  ground_.place(spheres_);
}

template class Crowd<ContainerGround>;
#define BERNAL_INSTANTIATE(D)                                                                           \
  template Crowd<BoxGround<D>>::Crowd(BoxGround<D>, Spheres<D>);                                        \
  template Crowd<BoxGround<D>>::Rest Crowd<BoxGround<D>>::settle(const Monitor&,                        \
                                                                 const std::function<void()>&, double); \
  template void Crowd<BoxGround<D>>::burst();                                                           \
  template void Crowd<BoxGround<D>>::relocate(double, Random&);                                         \
  template void Crowd<BoxGround<D>>::drop_last(std::size_t, Random&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
