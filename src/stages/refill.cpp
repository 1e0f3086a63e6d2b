#include "stages/refill.hpp"

#include <cmath>
#include <numbers>

namespace bernal {
namespace {

/// A random place and the radius of the largest sphere that fits there between neighbours and walls.
struct Probe {
  Vector<3> place;
  double gap;
};

/// Places for a sphere of radius `smallest` or more, in random order.
std::vector<Probe> probe_free_space(const Bed& bed, double smallest, double largest, std::size_t probes,
                                    Random& random) {
  const Bounds<3> bounds = bed.container().bounds();
  std::vector<Probe> found;
  for (std::size_t k = 0; k < probes; ++k) {
    const Vector<3> place = uniform_point(random, bounds);
    const double gap = bed.gap_to_neighbors(place, smallest, largest);
    if (gap < smallest || !bed.container().contains(place, smallest)) continue;
    const double room = std::min(gap, bed.container().clearance(place) - bed.skin());
    if (room >= smallest) found.push_back({place, room});
  }
  return found;
}

/// Puts spheres of the window into the free space; returns how many.
std::size_t fill_free_space(Work& work, double probes_a_sphere) {
  EffectTimer timer(work.effects, "refilling");
  Bed& bed = work.bed;
  Supply& supply = work.supply;
  Random random = work.random(Stream::refill);
  const Container& container = bed.container();
  const double mean_volume = 4.0 / 3.0 * std::numbers::pi * std::pow(bed.mean_radius(), 3);
  const double capacity = container.bounds().volume() / mean_volume;
  bed.update_grid();
  std::vector<Probe> probes =
      probe_free_space(bed, supply.smallest(), supply.largest(),
                       static_cast<std::size_t>(probes_a_sphere * capacity) + 1000, random);
  const std::size_t before = bed.size();
  std::size_t waiting = 0;
  while (waiting < supply.window().size()) {
    const std::uint32_t tag = supply.window()[waiting];
    const double r = supply.radius(tag);
    bool placed = false;
    for (std::size_t k = 0; k < probes.size() && !placed;) {
      if (probes[k].gap < r) {
        ++k;
        continue;
      }
      placed = bed.fits(probes[k].place, r);
      if (placed) {
        bed.insert(probes[k].place, r, tag);
        supply.take(waiting);
      } else {
        // A sphere has come near since the place was probed.
        probes[k].gap = std::min(std::nextafter(r, 0.0), bed.gap_to_neighbors(probes[k].place, 0, r));
      }
      if (placed || probes[k].gap < supply.smallest()) {
        probes[k] = probes.back();
        probes.pop_back();
      }
    }
    if (!placed) ++waiting;
  }
  return bed.size() - before;
}

}  // namespace

StageEnd refill(Work& work, const RefillOptions& options) {
  for (int round = 0; round < options.max_rounds; ++round) {
    if (work.monitor.stop()) return StageEnd::cancelled;
    if (work.supply.exhausted()) return StageEnd::converged;
    const std::size_t added = fill_free_space(work, options.probes);
    work.milestone("refill");
    const bool full = static_cast<double>(added) <= options.patience * static_cast<double>(work.bed.size());
    if (work.supply.exhausted() && added == 0) return StageEnd::converged;
    if (compress(work, options.shake.compress) == StageEnd::cancelled) return StageEnd::cancelled;
    if (full) return work.supply.exhausted() ? StageEnd::converged : StageEnd::full;
    if (shake(work, options.shake) == StageEnd::cancelled) return StageEnd::cancelled;
  }
  return StageEnd::hit_limit;
}

}  // namespace bernal
