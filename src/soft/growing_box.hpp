#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/soft/relax.hpp"
#include "soft/soft_packing.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// From so many spheres on sweeps a growth need not become more as fast as the paper says for the packing
/// fraction to stay what it is.
inline constexpr std::size_t enough_for_sweeps = 10000;

/// The largest overlap ratio at which spheres in a growing box count as relaxed. Far below `options.stop`: a
/// few more growths are cheap, and the packing fraction that the exact growth of the box at the end takes
/// away is three times the overlap that is left. Single precision shows no less than 4e-6.
inline double least_overlap(const Relax& options, double allowed) {
  return std::max({0.05 * options.stop, std::min(allowed, options.stop), 4e-6});
}

/// Sweeps of a cycle, at the pace for spheres of that largest overlap ratio, of which `done` are over; it is
/// 0 again in the end. After each but the last, asks whether to stop. Returns what the last of them met, or
/// nothing where stopped; `each`: the engine's `squeeze` then tells about each sphere too.
template <int D, bool each, class Engine, class Stop>
std::optional<double> sweep_cycle(Engine& packing, int sweeps, int& done, double molr, Stop&& stop) {
  const Pace pace = pace_for(molr);
  packing.wear_lists(pace.wear);
  const float omega = pace.omega * D / 3;
  while (done + 1 < sweeps) {
    packing.sweep(omega);
    ++done;
    if (stop()) return std::nullopt;
  }
  done = 0;
  if constexpr (each)
    return packing.sweep_and_measure(omega);
  else
    return packing.sweep_to_overlap(omega);
}

/// Largest overlap ratio below which growths of the box are predicted: they are few then.
inline constexpr double predictable = 3e-3;

struct GrowingBox {
  double stop;  ///< largest overlap ratio to end with
  int sweeps;   ///< between two growths
  double beta;
  /// By which it grows, about, when growths begin to be predicted.
  double last_overlap = predictable;
};

/// How far `grow_apart` has come.
struct BoxGrowth {
  using ArchivedAsBytes = void;
  double molr = 1;  ///< the largest overlap ratio
  double last_molr = 0, least_molr = 1;
  double growth = 0;
  int cycle = 1, sweeps = 0;              ///< over in this cycle
  double first_overlap = 0, overlap = 0;  ///< by which it grew at first and last, before prediction
};

/// Of all spheres, so far.
inline std::uint64_t sweeps_of(const BoxGrowth& growth, const GrowingBox& box, StageEnd end) {
  const int cycles = end == StageEnd::converged ? growth.cycle : growth.cycle - 1;
  return static_cast<std::uint64_t>(cycles) * static_cast<std::uint64_t>(box.sweeps) +
         static_cast<std::uint64_t>(growth.sweeps);
}

/// The share of the work that is over: about as much for each factor by which the overlap falls, until
/// growths are predicted.
inline double share_of_work(const BoxGrowth& growth, const GrowingBox& box) {
  constexpr double before_prediction = 0.9, power = 0.6, until_next = 0.03;
  if (growth.overlap == 0) return 0;
  const auto way = [](double from, double at, double to) {
    return from > to ? std::clamp(std::log(from / at) / std::log(from / to), 0.0, 1.0) : 1;
  };
  if (growth.molr < predictable)
    return before_prediction + (1 - before_prediction) * way(predictable, growth.molr, box.stop);
  return before_prediction * std::pow(way(growth.first_overlap, growth.overlap, box.last_overlap), power) +
         until_next * growth.sweeps / box.sweeps;
}

/// Spheres push each other apart while their box grows, each time by `overlap_of(cycle, least)` / beta, or
/// `overlap_of(cycle, least, squeeze)`, which is told of each sphere what the engine's `squeeze` is, for
/// the least that molr, the largest overlap ratio, has been: it rises only where some spheres of very many
/// have come so near each other before they were neighbours, and these part without more room. (Growing by it
/// takes 0.0004 from the packing fraction of 10^4 to 10^6 spheres, 0.0012 where such a pair is met early, and
/// once 0.017, with blocks of 3,000 spheres.) Where molr < 0.003, when it falls in proportion with the growth
/// of the box, the next growth is 0.9 of what the last two predict, at most molr / 6; earlier, prediction
/// costs contacts. `on_growth` is told the factor of each growth, and molr.
template <int D, class Engine, class Stop, class OverlapOf, class OnGrowth>
StageEnd grow_apart(Engine& packing, const GrowingBox& box, BoxGrowth& so_far, Stop&& stop,
                    OverlapOf&& overlap_of, OnGrowth&& on_growth) {
  constexpr bool each = std::is_invocable_v<OverlapOf&, int, double, const std::vector<float>&>;
  constexpr double share_of_prediction = 0.9, longest_predicted = 1.0 / 6;
  auto& [molr, last_molr, least_molr, growth, cycle, sweeps, first_overlap, overlap] = so_far;
  for (;; ++cycle) {
    const std::optional<double> met = sweep_cycle<D, each>(packing, box.sweeps, sweeps, molr, stop);
    if (!met) return StageEnd::cancelled;
    molr = *met;
    if (molr < box.stop) return StageEnd::converged;
    const double predicted = growth * molr / (last_molr - molr);
    least_molr = std::min(least_molr, molr);
    if constexpr (each)
      overlap = overlap_of(cycle, least_molr, packing.squeeze());
    else
      overlap = overlap_of(cycle, least_molr);
    if (first_overlap == 0) first_overlap = overlap;
    growth = overlap / box.beta;
    if (molr < predictable && molr < last_molr)
      growth = std::max(growth, std::min(share_of_prediction * predicted, longest_predicted * molr));
    last_molr = molr;
    packing.grow(1 + growth);
    on_growth(1 + growth, molr);
  }
}

/// Tells a run how its box grows.
class GrowthTeller {
 public:
  /// `growth` is how far that has come, in a run of which the share `before` was over when it began. Radii
  /// stay. O(N).
  GrowthTeller(SpheresInBox& in_box, const Reporter& report, const GrowingBox& box, const BoxGrowth& growth,
               double before = 0)
      : in_box_(in_box),
        report_(report),
        volume_(in_box.volume_of_spheres()),
        box_(box),
        growth_(growth),
        before_(before) {}

  /// To be called on growth.
  void grown(double factor) {
    in_box_.edges *= factor;
    tell(true);
  }
  /// To be called after sweeps: of very many spheres some take minutes until the box grows.
  void swept() {
    if (watch_.seconds() >= told_ + between) tell(false);
  }

 private:
  static constexpr double between = 0.5;  // seconds

  void tell(bool for_history) {
    told_ = watch_.seconds();
    done_ = std::max(done_, before_ + (1 - before_) * share_of_work(growth_, box_));
    report_.milestone("relax", in_box_.spheres.size(), volume_ / in_box_.edges.prod(), growth_.molr, done_,
                      for_history);
  }

  SpheresInBox& in_box_;

  const Reporter& report_;
  const double volume_;  // of the spheres
  const GrowingBox& box_;
  const BoxGrowth& growth_;
  const double before_;
  const Stopwatch watch_;
  double told_ = 0, done_ = 0;
};

}  // namespace bernal
