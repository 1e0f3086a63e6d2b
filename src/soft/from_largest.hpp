#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "core/order.hpp"
#include "near/cell_grid.hpp"
#include "soft/growing_box.hpp"
#include "soft/relax.hpp"
#include "soft/relax_wide.hpp"
#include "soft/soft_packing.hpp"
#include "work/holes.hpp"

namespace bernal {

// A kind is the spheres of one octave of radii.

/// A last kind with at most this share of the spheres joins the kind before it.
inline constexpr double least_of_kind = 0.02;
/// The number of random places that are tried for a sphere.
inline constexpr int trials_a_sphere = 30;
/// The monitor is asked once for so many spheres.
inline constexpr std::size_t spheres_a_question = 4096;
/// The most cycles of sweeps after each kind. They go on as long as the mean overlap falls below the share
/// `helps` of its last value.
inline constexpr int most_cycles_of_kind = 20;
inline constexpr double helps = 0.97;
/// Largest overlap ratio at which a kind counts as settled.
inline constexpr double settled = 3e-3;
/// If the largest kind has few spheres, they are packed several times, about `spheres_in_starts` spheres in
/// all, and the densest packing is kept: packing fractions of few spheres differ by 0.02.
inline constexpr std::size_t spheres_in_starts = 1000, most_starts_of_few = 20;
/// Packing fraction at the start of each.
inline constexpr double start_of_few = 0.75;
/// Fewer spheres have as many sweeps as this number: they cost nothing.
inline constexpr std::size_t sweeps_grow_from = 1000;
/// The usual number of cycles of a kind, and of a packing of few spheres.
inline constexpr double usual_cycles_of_kind = 4, usual_cycles_of_few = 60;
/// The usual mean overlap when growths begin to be predicted.
inline constexpr double last_mean = 5e-4;
/// After this number of cycles only the largest overlap ratio counts; before, its share grows with this
/// power.
inline constexpr double cycles_of_means = 200, power_of_cycles = 4;

inline int sweeps_of_wide(const Relax& options, std::size_t spheres) {
  const int sweeps = sweeps_a_cycle(options, std::clamp(spheres, sweeps_grow_from, enough_for_sweeps));
  return std::max(1, static_cast<int>(std::lround(share_of_cycle * sweeps)));
}

/// The mean over the spheres, or over their volume if that is larger, of the root of `squeeze`, the sum of
/// squared overlap ratios.
template <int D>
double mean_overlap(const std::vector<float>& squeeze, const std::vector<double>& radii) {
  double sum = 0, weighted = 0, volume = 0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double overlap = std::sqrt(squeeze[i]), weight = std::pow(radii[i], D);
    sum += overlap;
    weighted += weight * overlap;
    volume += weight;
  }
  return std::max(sum / static_cast<double>(radii.size()), weighted / volume);
}

inline GrowingBox box_of_wide(const Relax& options, std::size_t spheres, double stop) {
  return {.stop = stop,
          .sweeps = sweeps_of_wide(options, spheres),
          .beta = options.beta,
          .last_overlap = last_mean};
}

/// The overlap by which the box grows, as `grow_apart` asks for it. The radii outlive it.
template <int D>
auto overlap_by_means(const std::vector<double>& radii) {
  return [&radii](int cycle, double largest, const std::vector<float>& squeeze) {
    const double share = std::min(1.0, std::pow(cycle / cycles_of_means, power_of_cycles));
    return std::min(largest, std::max(mean_overlap<D>(squeeze, radii), share * largest));
  };
}

// What follows is for a domain `Where`, a box or a container:
//   boundary(), bounds()         its metric, and what centres lie in
//   any_place(r, random, m)      a random place where a sphere of this radius clears the walls, if there is
//   one trial(r, random)             the same, or nothing where the first place that it tries does not
//   engine(spheres)              a SoftPacking of them
//   pack(spheres, growing, growth, dense, random, report)
//                                packs them by themselves, from random places and `start_of_few` on; the
//                                larger `dense`, the denser

/// Puts the spheres from `first` on between those before them.
template <int D, class Where>
void place_between(Spheres<D>& spheres, std::size_t first, const Where& where, Random& random,
                   const Monitor& monitor) {
  if (first == 0) {
    for (std::size_t i = 0; i < spheres.size(); ++i)
      spheres.set_center(i, where.any_place(spheres.r[i], random, monitor));
    return;
  }
  const Boundary<D> boundary = where.boundary();
  CellGrid<D> grid(where.bounds(), boundary, spheres.r[first - 1], spheres.r[0], first);
  for (std::uint32_t i = 0; i < first; ++i) grid.insert(i, spheres.center(i), spheres.r[i]);
  int trials = trials_a_sphere;
  for (std::size_t i = first; i < spheres.size(); ++i) {
    if (i % spheres_a_question == 0 && monitor.stop()) trials = 1;  // they have places at least
    const double r = spheres.r[i];
    constexpr double none = -std::numeric_limits<double>::infinity();
    double best = none;
    for (int trial = 0; trial < trials && best < r; ++trial) {
      const std::optional<Vector<D>> p = where.trial(r, random);
      if (!p) continue;
      const double room =
          room_between_spheres(grid, *p, std::max(best, -spheres.r[0]), r, 0, [&](std::uint32_t j) {
            return Nearby{boundary.minimum_image(spheres.center(j) - *p).squaredNorm(), spheres.r[j]};
          });
      if (room <= best) continue;
      best = room;
      spheres.set_center(i, *p);
    }
    if (best == none) spheres.set_center(i, where.any_place(r, random, monitor));
  }
}

/// Where each kind ends in the order of descending radii.
inline std::vector<std::size_t> ends_of_kinds(const std::vector<double>& descending) {
  std::vector<std::size_t> ends;
  const std::size_t count = descending.size();
  for (std::size_t first = 0, last = 0; first < count; first = last) {
    while (last < count && descending[last] > 0.5 * descending[first]) ++last;
    if (static_cast<double>(count - last) <= least_of_kind * static_cast<double>(count)) last = count;
    ends.push_back(last);
  }
  return ends;
}

inline std::size_t starts_of(std::size_t few) {
  return std::clamp<std::size_t>(spheres_in_starts / few, 1, most_starts_of_few);
}

/// Reports to a run how far the kinds are, in the usual number of cycles.
class KindsTeller {
 public:
  /// `tell` takes the largest overlap ratio and the share of the placing that is over.
  KindsTeller(std::function<void(double, double)> tell, const std::vector<std::size_t>& ends, bool has_starts)
      : tell_(std::move(tell)) {
    if (has_starts)
      of_starts_ = usual_cycles_of_few * static_cast<double>(starts_of(ends.front()) * ends.front());
    all_ = before_ = of_starts_;
    for (const std::size_t end : ends) all_ += usual_cycles_of_kind * static_cast<double>(end);
  }

  /// This number of the packings of few spheres is done.
  void started(std::size_t starts, std::size_t of_all, double largest) {
    tell(of_starts_ * static_cast<double>(starts) / static_cast<double>(of_all), largest);
  }
  /// This number of cycles of a kind is done; with the kind there are `spheres` in all.
  void cycled(int cycles, std::size_t spheres, double largest) {
    tell(before_ + std::min<double>(cycles, usual_cycles_of_kind) * static_cast<double>(spheres), largest);
  }
  void settled(std::size_t spheres) { before_ += usual_cycles_of_kind * static_cast<double>(spheres); }

 private:
  void tell(double cycles, double largest) { tell_(largest, cycles / all_); }

  const std::function<void(double, double)> tell_;
  // In cycles times spheres that are swept.
  double of_starts_ = 0, all_ = 0;
  double before_ = 0;  // before the present kind
};

/// Sweeps in a domain of fixed size until that no longer helps.
template <int D, class Where>
StageEnd settle_kind(Spheres<D>& spheres, const Where& where, Reporter& report, const Relax& options,
                     KindsTeller& teller) {
  SoftPacking packing = where.engine(spheres);
  const int sweeps = sweeps_of_wide(options, spheres.size());
  StageEnd end = StageEnd::converged;
  double largest = 1, mean = std::numeric_limits<double>::infinity();
  int cycle = 0, done = 0;
  const Resumable part(report, "kind", [&](Archive& a) { a(largest, mean, cycle, done, packing); });
  while (cycle < most_cycles_of_kind) {
    const std::optional<double> met =
        sweep_cycle<D, true>(packing, sweeps, done, largest, [&] { return report.stop(); });
    if (!met) end = StageEnd::cancelled;
    if (!met) break;
    ++cycle;
    largest = *met;
    const double before = mean;
    mean = mean_overlap<D>(packing.squeeze(), spheres.r);
    teller.cycled(cycle, spheres.size(), largest);
    if (mean > helps * before || largest < settled) break;
  }
  report.effects["neighbour lists"] += packing.lists_built();
  report.effects["relaxation"].calls += static_cast<std::uint64_t>(cycle * sweeps + done);
  packing.write_to(spheres);
  return end;
}

/// Packs few spheres several times, and takes the densest packing.
template <int D, class Where>
StageEnd place_few(Spheres<D>& spheres, const Where& where, Reporter& report, const Relax& options,
                   Random& random, KindsTeller& teller) {
  const std::size_t starts = starts_of(spheres.size());
  const GrowingBox growing = box_of_wide(options, spheres.size(), options.stop);
  Spheres<D> start = spheres;
  double most = 0;
  StageEnd end = StageEnd::converged;
  for (std::size_t n = 0; n < starts && end == StageEnd::converged; ++n) {
    BoxGrowth growth;
    double dense = 0;
    end = where.pack(start, growing, growth, dense, random, report);
    teller.started(n + 1, starts, growth.molr);
    if (!(dense > most)) continue;
    most = dense;
    spheres.x = start.x;
  }
  return end;
}

/// Gives all spheres places, kind by kind. `tell` takes the largest overlap ratio and the share that is over.
template <int D, class Where>
StageEnd place_kinds(Spheres<D>& spheres, const Where& where, Reporter& report, const Relax& options,
                     Random& random, const std::function<void(double, double)>& tell) {
  const std::vector<std::uint32_t> order = largest_first(spheres.r);
  Spheres<D> descending;
  for (const std::size_t i : order) descending.push_back(Vector<D>::Zero(), spheres.r[i]);

  const std::vector<std::size_t> ends = ends_of_kinds(descending.r);
  KindsTeller teller(tell, ends, ends.front() < spheres_in_starts);
  StageEnd end = StageEnd::converged;
  std::size_t first = 0, kind = 0;
  const Resumable part(report, "from the largest", [&](Archive& a) { a(first, kind, descending, random); });
  for (std::size_t k = 0; k < kind; ++k) teller.settled(ends[k]);
  for (bool goes_on = part.resumed(); kind < ends.size(); first = ends[kind++]) {
    Spheres<D> there = descending;
    there.resize(ends[kind]);
    const bool are_few = first == 0 && there.size() < spheres_in_starts;
    if (std::exchange(goes_on, false))
      ;  // they have their places
    else if (are_few)
      end = place_few<D>(there, where, report, options, random, teller);
    else
      place_between(there, first, where, random, report.monitor);
    if (end == StageEnd::converged) end = settle_kind<D>(there, where, report, options, teller);
    teller.settled(there.size());
    for (std::size_t i = 0; i < there.size(); ++i) descending.set_center(i, there.center(i));
  }
  for (std::size_t i = 0; i < spheres.size(); ++i) spheres.set_center(order[i], descending.center(i));
  return end;
}

}  // namespace bernal
