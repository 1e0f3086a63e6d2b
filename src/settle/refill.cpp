#include "bernal/settle/refill.hpp"

#include <cmath>

#include "bernal/core/dimension.hpp"
#include "settle/compress.hpp"

namespace bernal {
namespace {

/// A random place, its clearance from the wall, and the radius of the largest sphere that fits there now.
struct Probe {
  using ArchivedAsBytes = void;
  Vector<3> place;
  double clearance;
  double room;
};

/// More probes would take more memory than the spheres do.
constexpr double most_probes = 4e6;
/// Where a sphere's centre has hardly any room, only so many places are tried for each probe that is wanted.
constexpr double most_trials = 4;
constexpr double least_trials = 3e5;

/// Places in the container where a sphere of radius `smallest` clears the wall: drawn once a stage, since the
/// wall stays where it is.
std::vector<Probe> draw_probes(SpheresInBed& in_bed, Reporter& report, double probes_a_sphere) {
  const EffectTimer timer(report.effects["refilling"]);
  const Made made("refilling");
  const Bed& bed = in_bed.bed();
  const Container& container = bed.container();
  Random random = report.random(Stream::refill);
  const double radius =
      bed.size() > 0 ? bed.mean_radius() : in_bed.supply->radius(in_bed.supply->window().front());
  const double smallest = in_bed.supply->smallest() + bed.skin();
  const double capacity = container.volume() / ball_volume(bed.dimension(), radius);
  const double wanted = std::min(most_probes, 1000 + probes_a_sphere * capacity);
  std::vector<Probe> probes;
  for (double trial = 0; trial < std::max(least_trials, most_trials * wanted); ++trial) {
    if (static_cast<double>(probes.size()) >= wanted) break;
    const Vector<3> place = bed.places().draw(random);
    if (!container.contains(place, smallest)) continue;
    probes.push_back({place, container.clearance(place) - bed.skin(), 0});
  }
  return probes;
}

/// Puts spheres of the window into the free space.
void fill_free_space(SpheresInBed& in_bed, Reporter& report, std::vector<Probe>& probes) {
  const EffectTimer timer(report.effects["refilling"]);
  Bed& bed = in_bed.bed();
  Supply& supply = *in_bed.supply;
  const double smallest = supply.smallest();
  bed.update_grid();
  std::vector<Probe*> open;
  for (Probe& p : probes) {
    p.room = bed.room_between_spheres(p.place, smallest, std::min(p.clearance, supply.largest()));
    if (p.room >= smallest) open.push_back(&p);
  }

  std::size_t waiting = 0;  // so many at the head of the window found no place
  while (waiting < supply.window().size()) {
    const std::uint32_t tag = supply.window()[waiting];
    const double r = supply.radius(tag);
    bool placed = false;
    for (std::size_t k = 0; k < open.size() && !placed;) {
      Probe& probe = *open[k];
      if (probe.room < r) {
        ++k;
        continue;
      }
      placed = bed.fits(probe.place, r);
      if (placed) {
        bed.insert(probe.place, r, tag);
        supply.take(waiting);
        probe.room = 0;
      } else {
        // A sphere has come near since the place was probed.
        probe.room = std::min(std::nextafter(r, 0.0), bed.room_between_spheres(probe.place, smallest, r));
      }
      if (probe.room < smallest) {
        open[k] = open.back();
        open.pop_back();
      }
    }
    if (!placed) ++waiting;
  }
}

/// Refilling (Han, Feng & Owen 2005, section 2): spheres still to come are put wherever the free space holds
/// them, the bed is compressed and shaken, and so on until the domain is full or the target is reached.
///
/// In a round, random places are probed for the largest sphere that each of them holds; then the spheres to
/// come, in their order, take the first place that is large enough. Cost: O(1) a probe, and that of the
/// compression.
StageEnd refill(const Refill& options, SpheresInBed& in_bed, Reporter& report) {
  require_support(in_bed.bed().container().boundary(), direction_of(options.shake.compress.direction));
  enum class Step { fill, compress, shake } step = Step::fill;
  int round = 0;
  double before = 0, after = 0;
  std::vector<Probe> probes;
  const Resumable part(report, "refill", [&](Archive& a) { a(step, round, before, after, probes); });
  if (!part.resumed()) {
    if (in_bed.supply->exhausted()) return StageEnd::converged;
    probes = draw_probes(in_bed, report, options.probes);
  }
  for (; round < options.max_rounds; ++round) {
    if (step == Step::fill) {
      if (report.stop()) return StageEnd::cancelled;
      before = in_bed.bed().packing_fraction();
      fill_free_space(in_bed, report, probes);
      after = in_bed.bed().packing_fraction();
      report.milestone("refill", in_bed.bed());
      step = Step::compress;
    }
    if (step == Step::compress) {
      const StageEnd end = compress(options.shake.compress, in_bed, report);
      if (end == StageEnd::cancelled) return end;
      if (in_bed.supply->exhausted()) return end;
      if (after - before <= options.patience * after)
        return end == StageEnd::hit_limit ? end : StageEnd::full;
      step = Step::shake;
    }
    if (shake(options.shake, in_bed, report) == StageEnd::cancelled) return StageEnd::cancelled;
    step = Step::fill;
  }
  return StageEnd::hit_limit;
}

}  // namespace

template <>
const StageEntry& entry_of<Refill>() {
  using namespace schema;
  static const StageEntry entry = {
      .table = stage_table<Refill>(
          {.name = "refill",
           .help = "insert into the free space, compress and shake, until the container is full",
           .keys = joined(
               {buys_accuracy({1.5, 5, 15, 50, 150},
                              number(&Refill::probes, "probes",
                                     "random places to look at, for each sphere that would fill the volume",
                                     above(0, 1e6))),
                integer(&Refill::max_rounds, "max_rounds", "after which it stops unfilled", {1, 1e9}),
                buys_accuracy(
                    {0.1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4},
                    number(&Refill::patience, "patience",
                           "full when a round adds less than this share of the spheres' volume", {0, 1}))},
               inside(&Refill::shake,
                      joined({buys_accuracy({0, 1, 2, 5},
                                            integer(&Shake::rounds, "shakes",
                                                    "rounds of shaking after each refilling", {0, 1e9})),
                              number(&Shake::amplitude, "amplitude",
                                     "longest way in one sweep of shaking, in mean radii", above(0, 100))},
                             inside(&Shake::compress, compression_keys())))),
           .choices = ends_of_compression()},
          {.in_bed = true,
           .in_plane = true,
           .in_repeated_mesh = true,
           .is_default_in_plane = true,
           .reaches = Reaches::settled}),
      .act_in_bed = of_options(refill),
      .may_bring = {"refilling", "neighbour lists", "compression", "shaking"},
      .effects = of_options(effects_of_refilling),
      .pressing = of_options(+[](const Refill& o) { return pressing_of_compression(o.shake.compress); }),
      .require = of_options(+[](const Refill& o, const Domain& domain, double, const FillTask&) {
        require_support(boundary_of<3>(domain), direction_of(o.shake.compress.direction));
      })};
  return entry;
}

}  // namespace bernal
