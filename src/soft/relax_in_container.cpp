#include "soft/relax_in_container.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "bernal/core/dimension.hpp"
#include "settle/insert.hpp"
#include "soft/crowd.hpp"

namespace bernal {
namespace {

/// The share of the spheres that is put elsewhere at a time.
constexpr double relocated = 0.002;
/// What is taken out, in mean squeezes times spheres.
constexpr double taken_out = 0.7;
/// The factor from one time to the next, and that of the patience.
constexpr double taken_out_faster = 1.25, less_patience = 0.7;
/// Stirring helps as long as the mean squeeze falls below this share of the least so far.
constexpr double progress = 0.9;
/// Mean squeeze at which there are so many spheres too many that stirring is of no use.
constexpr double hopeless = 0.02;
constexpr double patience_when_hopeless = 1;
/// Largest overlap ratio, in mean squeezes, above which it is only a few spheres that are stuck.
constexpr double local_jam = 40;
/// What is pushed in at a time, first and at last.
constexpr double pushed_in = 0.004, least_pushed_in = 2e-4;
/// More than what is likely to fit, in shares of it, is not tried at once.
constexpr double most_of_attainable = 1.1;
/// Spheres that fill less than this share of what is likely to fit find places free of overlap by themselves.
constexpr double dilute = 0.3;
constexpr InsertOptions insertion = {.attempts = 1000, .packing_fraction = 1};
constexpr int most_hand_overs = 20;
/// Tries to find a place where a sphere clears the wall.
constexpr int tries = 100;

/// Overlap ratio of spheres that are as good as free.
constexpr double small_overlap = 1e-4;

class Relaxation {
 public:
  Relaxation(Work& work, const RelaxInContainerOptions& options)
      : work_(work),
        options_(options),
        random_(work.random(Stream::relax)),
        crowd_(ContainerGround(work.bed().container(), work.bed().places()), spheres_to_start_from()),
        target_count_(std::max(crowd_.size(), target_count())) {}

  StageEnd run() {
    bool free = relax(options_.patience);
    for (double share = taken_out, patience = options_.patience; !free && !cancelled_ && crowd_.size() > 1;) {
      const double count = share * crowd_.mean_squeeze() * static_cast<double>(crowd_.size());
      crowd_.drop_last(std::max<std::size_t>(1, static_cast<std::size_t>(count)), random_);
      share *= taken_out_faster;
      patience = over_ ? 0 : less_patience * patience;
      free = relax(patience);
    }
    const bool limited = over_;  // what is added after that is as much as there is time for
    if (free && !over_) push_in();
    // Single precision saw them free of overlap in motion; a few more sweeps bring all of them there.
    bool all_there = hand_over();
    for (int k = 0; !all_there && free && !cancelled_ && k < most_hand_overs; ++k) {
      cancelled_ = crowd_.settle(work_.monitor, [this] { report(); }) == CrowdInContainer::Rest::cancelled;
      all_there = hand_over();
    }
    log_effects();
    if (cancelled_) return StageEnd::cancelled;
    if (crowd_.size() >= target_count_) return StageEnd::converged;
    return limited ? StageEnd::hit_limit : StageEnd::full;
  }

 private:
  /// So many of the drawn sequence fill this share of the container.
  std::size_t count_for(double packing_fraction) const {
    return work_.supply->count_filling(packing_fraction * work_.bed().container().volume());
  }

  std::size_t target_count() const {
    if (work_.target.is_open() && !work_.target.fill) return count_for(work_.attainable);
    return work_.supply->wanted();
  }

  /// The first of the drawn sequence, those in the bed where they are and the others at random: as many as
  /// are asked for, or a few more than are likely to fit.
  Spheres<3> spheres_to_start_from() {
    const Bed& bed = work_.bed();
    const Supply& supply = *work_.supply;
    const double most = work_.target.fill ? 1 : most_of_attainable;
    std::size_t count =
        std::max<std::size_t>(1, std::min(target_count(), count_for(most * work_.attainable)));
    for (Bed::Id i = 0; i < bed.size(); ++i) count = std::max<std::size_t>(count, bed.tag(i) + 1);
    Spheres<3> spheres;
    for (std::uint32_t tag = 0; tag < count; ++tag) {
      const double r = supply.radius(tag);
      spheres.push_back(Vector<3>::Zero(), r);
    }
    std::vector<bool> placed(count, false);
    for (Bed::Id i = 0; i < bed.size(); ++i) {
      spheres.set_center(bed.tag(i), bed[i].center);
      placed[bed.tag(i)] = true;
    }
    for (std::size_t i = 0; i < count; ++i)
      if (!placed[i]) spheres.set_center(i, place_for(spheres.r[i]));
    return spheres;
  }

  /// A random place at which a sphere clears the wall, if there is any to be found, else the best.
  Vector<3> place_for(double r) {
    const Container& container = work_.bed().container();
    Vector<3> best = Vector<3>::Zero();
    double most = 0;
    for (int k = 0; k < tries || !(most > 0); ++k) {
      const Vector<3> p = work_.bed().places().draw(random_);
      const double clearance = container.clearance_within(p, r);
      if (clearance > most) {
        most = clearance;
        best = p;
      }
      if (clearance >= r) break;
    }
    return best;
  }

  /// Settles and stirs. Returns whether the spheres came free of overlap.
  bool relax(double patience) {
    double least_squeeze = 1e300;
    for (double failures = 0;;) {
      const CrowdInContainer::Rest rest = crowd_.settle(work_.monitor, [this] { report(); });
      if (rest == CrowdInContainer::Rest::free) return true;
      cancelled_ = rest == CrowdInContainer::Rest::cancelled;
      over_ = over_ || cancelled_ || crowd_.sweeps() > options_.sweeps ||
              (options_.seconds > 0 && seconds() > options_.seconds);
      if (over_) return false;
      if (crowd_.mean_squeeze() < progress * least_squeeze) {
        least_squeeze = crowd_.mean_squeeze();
        failures = 0;
      } else if (++failures > (crowd_.mean_squeeze() > hopeless ? patience_when_hopeless : patience)) {
        return false;
      }
      // Bursts do most; what they do not help to is in the wrong chamber.
      const bool local =
          crowd_.severely_squeezed() > 0 || crowd_.largest_overlap() > local_jam * crowd_.mean_squeeze();
      if (failures == 0 && !local)
        crowd_.burst();
      else
        crowd_.relocate(relocated, random_);
    }
  }

  /// More and more of the sequence, until even a few find no room.
  void push_in() {
    const Supply& supply = *work_.supply;
    double share = pushed_in;
    while (share >= least_pushed_in && !over_) {
      const Spheres<3> before = crowd_.spheres();
      const std::size_t n = before.size();
      const auto more =
          std::min(target_count_ - n, static_cast<std::size_t>(std::ceil(share * static_cast<double>(n))));
      if (more == 0) return;
      std::vector<double> radii;
      for (std::size_t k = 0; k < more; ++k)
        radii.push_back(supply.radius(static_cast<std::uint32_t>(n + k)));
      if (crowd_.add(radii, random_) == 0) return;
      crowd_.burst();
      if (relax(options_.patience)) continue;
      crowd_.restore(before);
      if (more == 1) return;
      share /= 2;
    }
  }

  void report() {
    double volume = 0;
    for (const double r : crowd_.spheres().r) volume += ball_volume(3, r);
    const double overlap = crowd_.largest_overlap();
    work_.crowd_milestone("relax", crowd_.size(), volume, overlap,
                          std::log(overlap) / std::log(small_overlap));
  }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  /// Into the bed, in the order of the sequence. Returns whether all fit.
  bool hand_over() {
    Bed& bed = work_.bed();
    bed.remove_tags_from(0);
    const Spheres<3>& spheres = crowd_.spheres();
    std::vector<bool> placed(spheres.size(), false);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      placed[i] = bed.fits(spheres.center(i), spheres.r[i]);
      if (placed[i]) bed.insert(spheres.center(i), spheres.r[i], static_cast<std::uint32_t>(i));
    }
    work_.supply->set_placed(placed);
    return bed.size() == spheres.size();
  }

  void log_effects() {
    work_.effects["neighbour lists"].calls += crowd_.list_builds();
    work_.effects["walls"].calls += crowd_.wall_queries();
  }

  Work& work_;
  const RelaxInContainerOptions options_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  Random random_;
  CrowdInContainer crowd_;
  const std::size_t target_count_;
  bool over_ = false;  // there is no more time, or no more patience of the user
  bool cancelled_ = false;
};

/// Whether what is asked for is so little that spheres need not push each other.
bool is_dilute(const Work& work) {
  const double share = dilute * work.attainable;
  if (work.target.is_open()) return false;
  double volume = 0;
  for (std::uint32_t tag = 0; tag < work.supply->wanted(); ++tag) {
    volume += ball_volume(3, work.supply->radius(tag));
    if (volume > share * work.bed().container().volume()) return false;
  }
  return true;
}

}  // namespace

StageEnd relax_in_container(Work& work, const RelaxInContainerOptions& options) {
  if (is_dilute(work)) {
    const StageEnd end = insert(work, insertion);
    if (end != StageEnd::full) return end;
  }
  const EffectTimer timer(work.effects["relaxation"]);
  return Relaxation(work, options).run();
}

}  // namespace bernal
