#include "soft/tap.hpp"

#include <algorithm>
#include <cmath>

#include "soft/soft_packing.hpp"
#include "work/clear_place.hpp"

namespace bernal {
namespace {

constexpr double last_tap = 0.1 * first_tap;
constexpr int sweeps_a_tap = 10;
/// Without taps in the end, as a share of all.
constexpr double quiet_share = 0.05;
/// Of a sphere's radius: no nearer to a wall does a tap bring its centre.
constexpr double least_clearance = 0.5;
constexpr float tapped_omega = 5;
constexpr double tapped_wear = 3, tapped_swelling = 1.0005;
/// More than what is likely to fit, in shares of it, is not tried.
constexpr double most_to_tap = 1.1;
constexpr int taps_a_look = 16;

/// The first of the sequence where they stand, the others at random.
Spheres<3> spheres_to_tap(const SpheresInBed& in_bed, Random& random, const Monitor& monitor) {
  const Task& task = in_bed.task;
  const std::size_t count =
      std::min(in_bed.target_count(), in_bed.count_filling(most_to_tap * task.attainable));
  auto [spheres, placed] = in_bed.drawn(std::max<std::size_t>(1, count));
  const Spheres<3>& begun = in_bed.crowded_start;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (placed[i]) continue;
    const double r = spheres.r[i];
    const bool stands =
        i < begun.size() && task.container->clearance_within(begun.center(i), r) >= least_clearance * r;
    spheres.set_center(i, stands ? Vector<3>(begun.center(i))
                                 : clear_place(r, *task.container, in_bed.bed().places(), random, monitor));
  }
  return spheres;
}

}  // namespace

void tap(SpheresInBed& in_bed, Reporter& report, int taps, double first) {
  const EffectTimer timer(report.effects["tapping"]);
  const Made made("tapping");
  Random random = report.random(Stream::shake);
  Spheres<3> spheres = spheres_to_tap(in_bed, random, report.monitor);
  const Container& container = *in_bed.task.container;
  SoftPacking packing(spheres, container, soft_kernels().front());
  packing.swell(tapped_swelling);
  packing.wear_lists(tapped_wear);
  const int quiet_taps = static_cast<int>(std::ceil(quiet_share * taps));
  std::vector<SoftPacking::Move> moves;
  for (int k = 0; k < taps + quiet_taps; ++k) {
    if (k % taps_a_look == 0 && report.monitor.stop()) break;
    if (k < taps) {
      const double length = first * std::pow(last_tap / first, static_cast<double>(k) / taps);
      packing.write_to(spheres);
      moves.clear();
      for (std::uint32_t i = 0; i < spheres.size(); ++i) {
        const double r = spheres.r[i];
        Vector<3> to = spheres.center(i);
        for (int c = 0; c < 3; ++c) to[c] += random.uniform(-length * r, length * r);
        if (container.clearance_within(to, r) >= least_clearance * r) moves.push_back({i, to});
      }
      packing.put(moves);
    }
    for (int s = 0; s < sweeps_a_tap; ++s) packing.sweep(tapped_omega);
  }
  packing.write_to(spheres);
  report.effects["neighbour lists"] += packing.lists_built();
  in_bed.crowded_start = std::move(spheres);
}

}  // namespace bernal
