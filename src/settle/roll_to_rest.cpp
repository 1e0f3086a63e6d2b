#include "settle/roll_to_rest.hpp"

#include <vector>

#include "settle/roller.hpp"

namespace bernal {
namespace {

/// Room around a sphere, in mean radii.
constexpr double room = 0.5;
/// Between two buildings of the lists.
constexpr int rolling_sweeps = 50;

/// Returns whether any sphere has moved.
bool sweep_until_still(Bed& bed, const Vector<3>& direction, const RollToRest& options) {
  const auto& [still, friction, held, most] = options;
  Roller roller(bed, direction, friction);
  std::vector<char> awake(bed.size());
  for (Bed::Id i = 0; i < bed.size(); ++i) awake[i] = bed.tag(i) >= held;
  bool moved = false, moves = true;
  for (int k = 0; k < rolling_sweeps && moves; ++k) {
    moves = false;
    for (Bed::Id i = 0; i < bed.size(); ++i) {
      if (!awake[i]) continue;
      awake[i] = 0;
      if (roller.roll(i) <= still * bed[i].r) continue;
      moves = moved = true;
      for (const Bed::Id j : bed.neighbors(i)) awake[j] = bed.tag(j) >= held;
    }
  }
  return moved;
}

}  // namespace

StageEnd roll_to_rest(Bed& bed, Reporter& report, const Vector<3>& direction, const RollToRest& options) {
  int iteration = 0;
  const Resumable part(report, "roll to rest", [&](Archive& a) { a(iteration); });
  if (!part.resumed()) bed.sort_by_height(direction);
  for (; iteration < options.most_iterations; ++iteration) {
    if (report.stop()) return StageEnd::cancelled;
    bed.enclose(room * bed.mean_radius());
    if (!sweep_until_still(bed, direction, options)) return StageEnd::converged;
    report.milestone("settle", bed);
  }
  return StageEnd::hit_limit;
}

}  // namespace bernal
