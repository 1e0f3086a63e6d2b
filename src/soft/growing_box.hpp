#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "bernal/core/monitor.hpp"
#include "bernal/soft/relax.hpp"
#include "soft/soft_packing.hpp"
#include "work/work.hpp"

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
/// nothing where stopped; `each`: that tells about each sphere too.
template <int D, bool each = false, class Engine, class Stop>
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

struct GrowingBox {
  double stop;  ///< largest overlap ratio to end with
  int sweeps;   ///< between two growths
  double beta;
};

/// How far `grow_apart` has come.
struct BoxGrowth {
  double molr = 1;  ///< the largest overlap ratio
  double last_molr = 0, least_molr = 1;
  double growth = 0;
  int cycle = 1, sweeps = 0;  ///< over in this cycle
};

/// Spheres push each other apart while their box grows, each time by `overlap_of(cycle, least)` / beta, for
/// the least that molr, the largest overlap ratio, has been: it rises only where some spheres of very many
/// have come so near each other before they were neighbours, and these part without more room. (Growing by it
/// takes 0.0004 from the packing fraction of 10^4 to 10^6 spheres, 0.0012 where such a pair is met early, and
/// once 0.017, with blocks of 3,000 spheres.) Where molr < 0.003, when it falls in proportion with the growth
/// of the box, the next growth is 0.9 of what the last two predict, at most molr / 6; earlier, prediction
/// costs contacts. `on_growth` is told the factor of each growth, and molr.
template <int D, class Engine, class Stop, class OverlapOf, class OnGrowth>
StageEnd grow_apart(Engine& packing, const GrowingBox& box, BoxGrowth& so_far, Stop&& stop,
                    OverlapOf&& overlap_of, OnGrowth&& on_growth) {
  constexpr double predictable = 3e-3, share_of_prediction = 0.9, longest_predicted = 1.0 / 6;
  auto& [molr, last_molr, least_molr, growth, cycle, sweeps] = so_far;
  for (;; ++cycle) {
    const std::optional<double> met = sweep_cycle<D>(packing, box.sweeps, sweeps, molr, stop);
    if (!met) return StageEnd::cancelled;
    molr = *met;
    if (molr < box.stop) return StageEnd::converged;
    const double predicted = growth * molr / (last_molr - molr);
    least_molr = std::min(least_molr, molr);
    growth = overlap_of(cycle, least_molr) / box.beta;
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
  /// Once `stop` is the largest overlap ratio it is over; `sweeps` are between two growths. Radii stay. O(N).
  GrowthTeller(Work& work, double stop, int sweeps)
      : work_(work), volume_(work.volume_of_spheres()), stop_(stop), sweeps_(sweeps) {}

  /// To be called on growth.
  void grown(double factor, double molr) {
    work_.edges *= factor;
    work_.box_milestone("relax", volume_, std::min(most, share(molr)), molr);
    told_ = watch_.seconds();
  }
  /// To be called after sweeps: of very many spheres some take minutes until the box grows.
  void swept(const BoxGrowth& growth) {
    if (watch_.seconds() < told_ + between) return;
    told_ = watch_.seconds();
    const double done = share(growth.molr) + share_of_a_growth * growth.sweeps / sweeps_;
    work_.box_milestone("relax", volume_, std::clamp(done, 0.0, most), growth.molr, false);
  }

 private:
  static constexpr double most = 0.99, share_of_a_growth = 0.04, between = 0.5;  // seconds

  double share(double molr) const { return std::log(molr) / std::log(stop_); }

  Work& work_;
  const double volume_;  // of the spheres
  const double stop_;
  const int sweeps_;
  const Stopwatch watch_;
  double told_ = 0;
};

}  // namespace bernal
