#include "settle/shake.hpp"

namespace bernal {
namespace {

constexpr int sweeps_a_round = 10;

}  // namespace

StageEnd shake(Work& work, const ShakeOptions& options) {
  Bed& bed = work.bed();
  const Vector<3>& direction = options.compress.direction;
  require_support(bed.container().boundary(), direction);
  for (int round = 0; round < options.rounds; ++round) {
    if (work.monitor.stop()) return StageEnd::cancelled;
    {
      const EffectTimer timer(work.effects["shaking"]);
      const double radius = bed.mean_radius();
      Random random = work.random(Stream::shake);
      bed.sort_by_height(direction);
      bed.enclose(options.compress.buffer * radius);
      for (int k = 0; k < sweeps_a_round; ++k) {
        sweep_at_random(bed, Vector<3>::Zero(), 1, direction, options.amplitude * radius, random);
      }
    }
    const StageEnd end = compress(work, options.compress);
    work.milestone("shake");
    if (end == StageEnd::cancelled) return end;
  }
  return StageEnd::converged;
}

}  // namespace bernal
