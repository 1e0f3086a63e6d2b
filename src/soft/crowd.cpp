#include "soft/crowd.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "core/every_dimension.hpp"
#include "core/order.hpp"

namespace bernal {
namespace {

/// The largest overlap ratio of free spheres, over the margin: below 1 for the errors of single precision.
constexpr double share_of_margin = 0.97;
/// From the overlap ratio `crowded` on, lists in a container are worn by `wear_of_crowd`. The walls find near
/// spheres without these lists, and a pair that they miss only overlaps for some sweeps more. N = 300,000 in
/// two CAD parts: 28 lists in place of 41, and of 107.
constexpr double crowded = 0.06, wear_of_crowd = 3;
/// Sweeps from one look at the overlaps to the next.
constexpr int sweeps_a_look = 25;
/// Stirring helps as long as the mean squeeze falls below this share of its least value.
constexpr double enough_progress = 0.9;
/// From this mean squeeze on there are far too many spheres, and stirring is of no use.
constexpr double hopeless = 0.02;
/// The share of the spheres that is put into holes at a time. In a container it is `relocated_by_squeeze`
/// times the mean squeeze, at most `most_relocated`, and only spheres whose squeeze is at least
/// `squeezed_as_well` of the largest: in the end hardly any of very many spheres are stuck, and one that
/// moves needlessly is stuck in its hole.
constexpr double relocated = 0.002;
constexpr double relocated_by_squeeze = 1, most_relocated = 0.03;
constexpr float squeezed_as_well = 0.05f;
/// Only a few spheres are stuck if the largest overlap ratio is more than this many mean squeezes, or if some
/// need a hole while the mean squeeze is below `SweepPolicy::crowded_everywhere`.
constexpr double local_jam = 40;
constexpr int burst_sweeps = 50;
/// Sum of squared overlap ratios from which on a sphere needs a hole.
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
  const auto look = [&] {
    largest_overlap_ = ground_.engine().sweep_and_measure(over_relaxation(pace));
    ++sweeps_;
  };
  const bool worn = Ground::crowds_wear_lists && largest_overlap_ >= crowded;
  if (worn) look();  // on worn lists this only says whether they are still crowded
  if (!worn || largest_overlap_ < crowded) {
    ground_.engine().wear_lists(pace.wear);
    look();
  }
  squeeze_ = ground_.engine().squeeze();
  double sum = 0;
  severe_ = 0;
  for (const float s : squeeze_) {
    sum += std::sqrt(s);
    if (s > severe_squeeze) ++severe_;
  }
  mean_squeeze_ = sum / static_cast<double>(size());
}

template <class Ground>
bool Crowd<Ground>::is_free() const {
  return largest_overlap_ < share_of_margin * ground_.margin();
}

template <class Ground>
StageEnd Crowd<Ground>::settle(const Monitor& monitor, const std::function<void()>& milestone,
                               double most_sweeps) {
  Settling so_far;
  return settle(
      so_far, [&] { return monitor.stop(); }, milestone, most_sweeps);
}

template <class Ground>
StageEnd Crowd<Ground>::settle(Settling& so_far, const std::function<bool()>& stop,
                               const std::function<void()>& milestone, double most_sweeps) {
  StageEnd end = StageEnd::full;
  auto& [slow, sweeps, least_squeeze] = so_far;
  while (slow < ground_.policy().most_slow_looks) {
    const Pace pace = pace_for(largest_overlap_);
    ground_.engine().wear_lists(Ground::crowds_wear_lists && largest_overlap_ >= crowded ? wear_of_crowd
                                                                                         : pace.wear);
    while (sweeps + 1 < sweeps_a_look && end != StageEnd::cancelled) {
      ground_.engine().sweep(over_relaxation(pace));
      ++sweeps_;
      ++sweeps;
      if (stop()) end = StageEnd::cancelled;
    }
    if (end == StageEnd::cancelled) break;
    sweeps = 0;
    measure();
    if (milestone) milestone();
    if (is_free())
      end = StageEnd::converged;
    else if (sweeps_ > most_sweeps)
      end = StageEnd::hit_limit;
    if (end != StageEnd::full) break;
    slow = mean_squeeze_ > ground_.policy().hardly_freer * least_squeeze ? slow + 1 : 0;
    // The squeeze may oscillate: only a new least value counts, so that this ends.
    least_squeeze = std::min(least_squeeze, mean_squeeze_);
  }
  ground_.read_places(spheres_);
  return end;
}

template <class Ground>
double Crowd<Ground>::exchange(SizeExchange& sizes, double done) {
  if (sizes.widen(widening(done))) ground_.engine().resize(sizes.radii());
  ground_.engine().exchange(sizes.deal(ground_.engine().forces(), exchange_step(done)));
  for (int k = 1; k < sweeps_an_exchange; ++k) ground_.engine().sweep(over_relaxation(pace_for(0)));
  sweeps_ += sweeps_an_exchange - 1;
  measure();
  return energy_of(squeeze_);
}

template <class Ground>
StageEnd Crowd<Ground>::relax(const Stirring& how, const Monitor& monitor, Random& random) {
  double least_squeeze = 1e300;
  int failures = 0;
  Settling settling;
  std::optional<Checkpoints::Part> part;
  if (how.checkpoints)
    part.emplace(*how.checkpoints, "crowd",
                 [&](Archive& a) { a(least_squeeze, failures, settling, random, *this); });
  const auto stop = [&] { return how.checkpoints ? how.checkpoints->stop() : monitor.stop(); };
  for (;; settling = {}) {
    const StageEnd end = settle(settling, stop, how.milestone, how.most_sweeps);
    if (end == StageEnd::cancelled || (end == StageEnd::converged && how.is_free())) return end;
    if (how.is_over()) return StageEnd::hit_limit;
    if (mean_squeeze_ < enough_progress * least_squeeze) {
      least_squeeze = mean_squeeze_;
      failures = 0;
    } else if (mean_squeeze_ > hopeless || !ground_.narrow_margin()) {
      if (++failures > (mean_squeeze_ > hopeless ? how.hopeless_patience : how.patience))
        return StageEnd::full;
    }
    // Bursts do most. Spheres that they do not help have no room, or are in the wrong chamber.
    const bool local = (severe_ > 0 && mean_squeeze_ < ground_.policy().crowded_everywhere) ||
                       largest_overlap_ > local_jam * mean_squeeze_;
    if (failures % how.failures_a_burst == 0 && !local)
      burst();
    else
      relocate(Ground::crowds_wear_lists ? std::min(relocated_by_squeeze * mean_squeeze_, most_relocated)
                                         : relocated,
               random);
  }
}

template <class Ground>
void Crowd<Ground>::burst() {
  ground_.swell(Ground::burst_swelling);
  if (Ground::crowds_wear_lists) ground_.engine().wear_lists(wear_of_crowd);
  for (int k = 0; k < burst_sweeps; ++k) ground_.engine().sweep(over_relaxation(pace_for(0)));
  sweeps_ += burst_sweeps;
  ground_.swell(1);
}

/// In descending order of squeeze; equal ones in the order of their numbers.
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
  auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(size())));
  if (Ground::crowds_wear_lists) {
    const float least = squeezed_as_well * *std::ranges::max_element(squeeze_);
    count = std::min(count, static_cast<std::size_t>(
                                std::ranges::count_if(squeeze_, [&](float s) { return s >= least; })));
  }
  ground_.read_places(spheres_);
  ground_.move_to_holes(spheres_, most_squeezed(std::max(count, severe_)), random);
}

template <class Ground>
void Crowd<Ground>::drop_last(double most, Random& random) {
  const std::size_t count = std::min(std::max<std::size_t>(1, static_cast<std::size_t>(most)), size() - 1);
  ground_.read_places(spheres_);
  spheres_.resize(size() - count);
  squeeze_.resize(size());
  ground_.place(spheres_);
  ground_.move_to_holes(spheres_, most_squeezed(count), random);
}

template <class Ground>
void Crowd<Ground>::drop_last_dealing(double most) {
  const std::size_t count = std::min(std::max<std::size_t>(1, static_cast<std::size_t>(most)), size() - 1);
  ground_.read_places(spheres_);
  std::vector<bool> emptied(size(), false);
  for (const std::uint32_t i : most_squeezed(count)) emptied[i] = true;
  const std::vector<std::uint32_t> ascending = smallest_first(spheres_.r);
  Spheres<D> left = spheres_;
  left.resize(size() - count);
  for (auto place = ascending.begin(); const std::uint32_t i : ascending) {
    if (i >= left.size()) continue;
    while (emptied[*place]) ++place;
    left.set_center(i, spheres_.center(*place++));
  }
  restore(std::move(left));
}

template <class Ground>
bool Crowd<Ground>::add(std::span<const double> radii, Random& random) {
  ground_.read_places(spheres_);
  const std::vector<std::uint32_t> order = largest_first(radii);
  std::vector<double> descending;
  for (const std::size_t i : order) descending.push_back(radii[i]);
  const std::vector<Vector<D>> holes = ground_.holes_for(descending, spheres_, random);
  if (holes.size() < radii.size()) return false;
  const std::size_t before = size();
  for (const double r : radii) spheres_.push_back(Vector<D>::Zero(), r);
  for (std::size_t k = 0; k < order.size(); ++k) spheres_.set_center(before + order[k], holes[k]);
  ground_.place(spheres_);
  return true;
}

template <class Ground>
void Crowd<Ground>::restore(Spheres<D> spheres) {
  spheres_ = std::move(spheres);
  ground_.place(spheres_);
}

template class Crowd<ContainerGround>;
#define BERNAL_INSTANTIATE(D)                                                             \
  template Crowd<BoxGround<D>>::Crowd(BoxGround<D>, Spheres<D>);                          \
  template StageEnd Crowd<BoxGround<D>>::relax(const Stirring&, const Monitor&, Random&); \
  template void Crowd<BoxGround<D>>::drop_last(double, Random&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
