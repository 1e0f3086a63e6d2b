#include "settle/compress.hpp"

namespace bernal {
namespace {

constexpr int sweeps_a_round = 10;

}  // namespace

StageEnd shake(const Shake& options, SpheresInBed& in_bed, Reporter& report) {
  Bed& bed = in_bed.bed();
  const Vector<3> direction = direction_of(options.compress.direction);
  require_support(bed.container().boundary(), direction);
  int round = 0;
  bool compressing = false;
  StageEnd end = StageEnd::converged;
  const Resumable part(report, "shake", [&](Archive& a) { a(round, compressing, end); });
  for (; round < options.rounds; ++round) {
    if (!compressing) {
      if (report.stop()) return StageEnd::cancelled;
      const EffectTimer timer(report.effects["shaking"]);
      const double radius = bed.mean_radius();
      Random random = report.random(Stream::shake);
      bed.sort_by_height(direction);
      bed.enclose(options.compress.buffer * radius);
      for (int k = 0; k < sweeps_a_round; ++k) {
        sweep_at_random(bed, Vector<3>::Zero(), 1, direction, options.amplitude * radius, random);
      }
    }
    compressing = true;
    end = compress(options.compress, in_bed, report);
    compressing = false;
    report.milestone("shake", bed);
    if (end == StageEnd::cancelled) return end;
  }
  return end;
}

template <>
const StageEntry& entry_of<Shake>() {
  using namespace schema;
  static const StageEntry entry = {
      .table = stage_table<Shake>(
          {.name = "shake",
           .help = "move spheres across the direction, so that arches break, and compress again",
           .keys = joined(
               {buys_accuracy({1, 2, 5, 10, 20}, integer(&Shake::rounds, "rounds", "how often", {1, 1e9})),
                number(&Shake::amplitude, "amplitude", "longest way in one sweep, in mean radii",
                       above(0, 100))},
               inside(&Shake::compress, compression_keys())),
           .choices = ends_of_compression()},
          {.in_bed = true,
           .in_plane = true,
           .in_repeated_mesh = true,
           .only_moves = true,
           .is_default_in_plane = true}),
      .act_in_bed = of_options(shake),
      .may_bring = {"neighbour lists", "shaking", "compression"},
      .effects = of_options(effects_of_shaking),
      .pressing = of_options(+[](const Shake& o) { return pressing_of_compression(o.compress); }),
      .require = of_options(+[](const Shake& o, const Domain& domain, double, const FillTask&) {
        require_support(boundary_of<3>(domain), direction_of(o.compress.direction));
      })};
  return entry;
}

}  // namespace bernal
