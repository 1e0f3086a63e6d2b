#include "soft/shrink_in_container.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "soft/from_largest.hpp"
#include "work/clear_place.hpp"

namespace bernal {
namespace {

/// Of what a packing has reached, this share less is placed the next time, and so much less again each time:
/// so it comes free of overlap at the sizes that are asked for. What packings of one count reach scatters by
/// 0.003.
constexpr double less_than_reached = 0.002;
/// The share of more spheres that has to find room for another packing to be worth it.
constexpr double worth_another = 0.004;
constexpr int most_packings = 6;
/// Spheres are larger than asked for by at least this share when they count as free of overlap, for rounding.
constexpr double margin = 1e-4;
/// How much larger they are at most when they begin to shrink: the engine knows no more.
constexpr double largest_start = 1.04;
/// Where they would have to become smaller than this, some are stuck where a part is too thin for them, and
/// say nothing of how many fit.
constexpr double stuck_below = 0.95;

/// An engine in a container, as `grow_apart` knows one: spheres shrink where a box would grow.
class ShrinkingSpheres {
 public:
  ShrinkingSpheres(SoftPacking& packing, double& factor) : packing_(packing), factor_(factor) {}

  void wear_lists(double wear) { packing_.wear_lists(wear); }
  void sweep(float omega) { packing_.sweep(omega); }
  double sweep_and_measure(float omega) { return packing_.sweep_and_measure(omega); }
  std::vector<float> squeeze() const { return packing_.squeeze(); }
  void grow(double by) {
    factor_ /= by;
    packing_.swell(factor_);
  }

 private:
  SoftPacking& packing_;
  double& factor_;
};

/// A container, as `place_kinds` knows one. Spheres are `factor` times as large as given.
class KindsInContainer {
 public:
  KindsInContainer(const Container& container, const Places& places, double factor)
      : container_(container), places_(places), factor_(factor) {}

  const Boundary<3>& boundary() const { return container_.boundary(); }
  Bounds<3> bounds() const { return container_.bounds(); }
  Vector<3> any_place(double r, Random& random, const Monitor& monitor) const {
    return clear_place(r, container_, places_, random, monitor);
  }
  std::optional<Vector<3>> trial(double r, Random& random) const {
    const Vector<3> p = places_.draw(random);
    if (container_.clearance_within(p, r) >= r) return p;
    return std::nullopt;
  }
  SoftPacking engine(const Spheres<3>& spheres) const {
    SoftPacking packing(spheres, container_, soft_kernels().front(), true);
    packing.swell(factor_);
    return packing;
  }
  /// Much larger than they are, until they jam.
  StageEnd pack(Spheres<3>& spheres, const GrowingBox& growing, BoxGrowth& growth, double& dense,
                Random& random, Reporter& report) const {
    Spheres<3> larger = spheres;
    const double by = std::cbrt(start_of_few * container_.volume() / volume_of(spheres));
    for (double& r : larger.r) r *= by;
    const KindsInContainer start(container_, places_, 1);
    place_between(larger, 0, start, random, report.monitor);
    SoftPacking packing = start.engine(larger);
    dense = 1;
    ShrinkingSpheres engine(packing, dense);
    const StageEnd end = grow_apart<3>(
        engine, growing, growth, [&] { return report.monitor.stop(); }, overlap_by_means<3>(larger.r),
        [](double, double) {});
    count_growth(report, packing, growth, growing, end);
    packing.write_to(spheres);
    return end;
  }

 private:
  const Container& container_;
  const Places& places_;
  const double factor_;
};

using Tell = std::function<void(const Spheres<3>&, double, double)>;
using IsOver = std::function<bool(double sweeps)>;

/// Packs the spheres, `factor` times as large as given, from random places; they shrink until they are free
/// of overlap, and then are `factor` times as large. Ends `full` where some are stuck, and `hit_limit` where
/// `is_over` says so of its sweeps of all, which it adds to `sweeps`.
StageEnd pack_once(Spheres<3>& spheres, double& factor, const SpheresInBed& in_bed, Random& random,
                   Reporter& report, const Relax& options, double& sweeps, const IsOver& is_over,
                   const Tell& tell) {
  enum class Step { place, shrink } step = Step::place;
  const KindsInContainer where(in_bed.bed().container(), in_bed.bed().places(), factor);
  const auto tell_share = [&](double largest, double done) { tell(spheres, largest, done); };
  const Resumable part(report, "packing", [&](Archive& a) { a(step, spheres, random); });
  if (step == Step::place) {
    const StageEnd end =
        place_kinds<3>(spheres, where, report, options, random,
                       [&](double largest, double done) { tell_share(largest, share_of_placing * done); });
    if (end != StageEnd::converged) return end;
    step = Step::shrink;
  }
  SoftPacking packing = where.engine(spheres);
  ShrinkingSpheres engine(packing, factor);
  const GrowingBox growing = box_of_wide(options, spheres.size(), least_overlap(options, 0));
  BoxGrowth growth;
  const Resumable shrinking(report, "shrinking", [&](Archive& a) { a(growth, factor, packing); });
  bool is_stopped = false, is_limited = false;
  const auto stop = [&] {
    is_stopped = report.stop();
    is_limited = is_over(static_cast<double>(sweeps_of(growth, growing, StageEnd::cancelled)));
    return is_stopped || is_limited || factor < stuck_below;
  };
  const StageEnd end = grow_apart<3>(
      engine, growing, growth, stop, overlap_by_means<3>(spheres.r), [&](double, double largest) {
        tell_share(largest, share_of_placing + (1 - share_of_placing) * share_of_work(growth, growing));
      });
  sweeps += static_cast<double>(sweeps_of(growth, growing, end));
  count_growth(report, packing, growth, growing, end);
  packing.write_to(spheres);
  if (end != StageEnd::cancelled || is_stopped) return end;
  return is_limited ? StageEnd::hit_limit : StageEnd::full;
}

/// How much larger than asked for spheres that fill this share of the container begin.
double start_of(double packing_fraction, const FillTask& task) {
  return std::clamp(std::cbrt(wide_start(task) / packing_fraction), 1.0, largest_start);
}

}  // namespace

FirstThatFit pack_shrinking(const SpheresInBed& in_bed, std::size_t count, std::size_t most, double larger_by,
                            Random& random, Reporter& report, const Relax& options, const IsOver& is_over,
                            const Tell& tell) {
  const double volume = in_bed.task.container->volume();
  const auto first = [&](std::size_t n) {
    Spheres<3> spheres = in_bed.drawn(n).spheres;
    for (double& r : spheres.r) r += larger_by;
    return spheres;
  };
  FirstThatFit packed{.spheres = first(count)}, best;
  int packings = 0;
  double sweeps = 0;
  std::size_t too_many = most + 1;  // did not come free
  double factor = start_of(volume_of(packed.spheres) / volume, in_bed.task.fill_task);
  const Resumable part(report, "shrinking packings", [&](Archive& a) {
    a(packings, packed.spheres, factor, best.spheres, sweeps, too_many);
  });
  // Each packing is as long as what is still to come.
  double told = 0;
  const Tell tell_of_all = [&](const Spheres<3>& spheres, double largest, double done) {
    told = std::max(told, 1 - std::exp2(-packings) * (1 - 0.5 * done));
    tell(spheres, largest, told);
  };
  for (;;) {
    const double before = sweeps;
    packed.end = pack_once(
        packed.spheres, factor, in_bed, random, report, options, sweeps,
        [&](double now) { return is_over(before + now); }, tell_of_all);
    packed.is_free = packed.end == StageEnd::converged && factor >= 1 + margin;
    if (packed.end != StageEnd::converged) break;
    const std::size_t there = packed.spheres.size();
    if (!packed.is_free) too_many = std::min(too_many, there);
    if (packed.is_free && there > best.spheres.size()) best.spheres = packed.spheres;
    const double reached = volume_of(packed.spheres) * std::pow(factor, 3) / volume;
    ++packings;
    // What the last packing says, if that lies between what has fitted and what has not; else the middle.
    const std::size_t fits = best.spheres.size();
    std::size_t next = std::min(most, in_bed.count_filling((1 - packings * less_than_reached) * reached));
    const bool is_between = next > fits && next < too_many;
    if (!is_between && too_many > most)
      next = fits;
    else if (!is_between)
      next = fits > 0 ? (fits + too_many) / 2 : too_many - 1;
    best.is_full = static_cast<double>(next) < (1 + worth_another) * static_cast<double>(fits);
    if (best.is_full || packings == most_packings) break;
    packed.spheres = first(std::max<std::size_t>(1, next));
    factor = start_of(volume_of(packed.spheres) / volume, in_bed.task.fill_task);
  }
  if (best.spheres.size() == 0) return packed;
  best.is_free = true;
  best.end = packed.end;
  return best;
}

}  // namespace bernal
