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

/// Up to this number of spheres the sweeps between two growths increase as the paper says. Beyond it they
/// need not increase for the packing fraction to stay what it is.
inline constexpr std::size_t enough_for_sweeps = 10000;

/// The largest overlap ratio at which spheres in a growing box count as relaxed. It is far below
/// `options.stop`, because a few more growths are cheap, and because the exact growth at the end lowers the
/// packing fraction by three times the overlap that is left. Single precision resolves 4e-6.
inline double least_overlap(const Relax& options, double allowed) {
  return std::max({0.05 * options.stop, std::min(allowed, options.stop), 4e-6});
}

/// Does the sweeps of a cycle from number `done` on, at the pace for the largest overlap ratio `molr`, and
/// sets `done` to 0. Calls `stop` after each sweep but the last. Returns the largest overlap ratio that the
/// last sweep met, or nothing if `stop` said so. With `each` the engine's `squeeze` is then known.
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

/// Largest overlap ratio below which growths of the box are predicted.
inline constexpr double predictable = 3e-3;

struct GrowingBox {
  double stop;  ///< largest overlap ratio to end with
  int sweeps;   ///< between two growths
  double beta;
  /// The overlap by which the box grows, about, when growths begin to be predicted.
  double last_overlap = predictable;
};

/// How far `grow_apart` has come.
struct BoxGrowth {
  using ArchivedAsBytes = void;
  double molr = 1;  ///< the largest overlap ratio
  double last_molr = 0, least_molr = 1;
  double growth = 0;
  int cycle = 1, sweeps = 0;              ///< sweeps that are over in this cycle
  double first_overlap = 0, overlap = 0;  ///< by which the box grew first and last, without prediction
};

/// The number of sweeps so far.
inline std::uint64_t sweeps_of(const BoxGrowth& growth, const GrowingBox& box, StageEnd end) {
  const int cycles = end == StageEnd::converged ? growth.cycle : growth.cycle - 1;
  return static_cast<std::uint64_t>(cycles) * static_cast<std::uint64_t>(box.sweeps) +
         static_cast<std::uint64_t>(growth.sweeps);
}

/// Counts what a growth took.
template <class Engine>
void count_growth(Reporter& report, const Engine& packing, const BoxGrowth& growth, const GrowingBox& box,
                  StageEnd end) {
  report.effects["neighbour lists"] += packing.lists_built();
  report.effects["relaxation"].calls += sweeps_of(growth, box, end);
}

/// The share of the work that is over. Until growths are predicted, it is a function of the logarithm of the
/// overlap.
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

/// Spheres push each other apart while their box grows. After each cycle of sweeps the edges grow by the
/// share `overlap_of(cycle, least)` / beta, or `overlap_of(cycle, least, squeeze)` / beta with the engine's
/// `squeeze`. `least` is the smallest value that molr, the largest overlap ratio, has had so far: molr rises
/// only if, among very many spheres, a few pairs met before they were in each other's lists, and these part
/// without more room. (Growth by molr itself costs 0.0004 of packing fraction with 10^4 to 10^6 spheres,
/// 0.0012 if such a pair meets early, and once cost 0.017, with blocks of 3,000 spheres.)
///
/// When molr < 0.003 it falls in proportion to the growth of the box. Then the next growth is 0.9 of what the
/// last two predict, at most molr / 6. Earlier, prediction costs contacts. `on_growth` receives the factor of
/// each growth, and molr. Returns when molr < box.stop or `stop` says so.
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

/// Reports to a run how its box grows.
class GrowthTeller {
 public:
  /// `growth` outlives this. The share `before` of the run was over when the growth began. Precondition:
  /// radii stay. O(N).
  GrowthTeller(SpheresInBox& in_box, const Reporter& report, const GrowingBox& box, const BoxGrowth& growth,
               double before = 0)
      : in_box_(in_box),
        report_(report),
        volume_(in_box.volume_of_spheres()),
        box_(box),
        growth_(growth),
        before_(before) {}

  /// Call it at each growth.
  void grown(double factor) {
    in_box_.edges *= factor;
    tell(true);
  }
  /// Call it after each sweep: with very many spheres minutes pass between two growths.
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

/// Gives the memory of the places back: very many spheres need it elsewhere.
template <class Columns>
void forget_places(Columns& columns) {
  for (std::vector<double>& column : columns) std::vector<double>().swap(column);
}
/// Makes room for the places again, after `forget_places`.
template <int D>
void have_places(Spheres<D>& spheres) {
  spheres.resize(spheres.r.size());
}

/// `grow_apart` as part of a run: it reports, counts effects and may stop and be resumed. `packing` is an
/// engine that has the places of the spheres; meanwhile `spheres` have none, in a checkpoint neither. On
/// return `spheres` and `edges` are those of the end. `begin` says what is known at the start; the share
/// `before` of the run is over then.
template <int D, class Engine, class OverlapOf>
StageEnd let_box_grow(Engine& packing, Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box,
                      Reporter& report, const GrowingBox& box, const BoxGrowth& begin, double before,
                      OverlapOf&& overlap_of) {
  forget_places(spheres.x);
  BoxGrowth growth = begin;
  const Resumable part(report, "growing box", [&](Archive& a) { a(growth, in_box.edges, packing); });
  GrowthTeller teller(in_box, report, box, growth, before);
  const auto stop = [&] {
    teller.swept();
    return report.stop();
  };
  const StageEnd end = grow_apart<D>(packing, box, growth, stop, overlap_of,
                                     [&](double factor, double) { teller.grown(factor); });
  count_growth(report, packing, growth, box, end);
  have_places(spheres);
  packing.write_to(spheres, edges);
  return end;
}

}  // namespace bernal
