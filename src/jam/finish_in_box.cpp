#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/tolerance.hpp"
#include "core/every_dimension.hpp"
#include "jam/held.hpp"
#include "jam/polish.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace {

/// How often a gap that is closed may be as wide as the box grows to outweigh rounding: so much it does, and
/// what measures gaps rounds, too.
constexpr double roundings = 2;

/// Polishes, and judges by the spheres as they lie then.
template <int D>
StageEnd close_contacts_in_box(Spheres<D>& spheres, Vector<D>& edges, double polish_to,
                               const SpheresInBox& in_box, Reporter& report) {
  const EffectTimer timer(report.effects["polish"]);
  const StageEnd end = polish<D>(spheres, edges, polish_to, in_box, report);
  free_of_overlap<D>(spheres, edges, in_box.task, report);
  if (end == StageEnd::cancelled) return end;
  const double gap =
      polish_to + roundings * tolerance::growth(edges.maxCoeff() / std::ranges::min(spheres.r));
  const std::vector<bool>& walls = in_box.task.walls;
  const int symmetries = D - static_cast<int>(std::ranges::count(walls, true));
  const auto open =
      what_is_open(gap, D, spheres.size(), symmetries, contacts_at<D>(gap, spheres, edges, walls));
  return end_of_polish(end, polish_to, open, report);
}

}  // namespace

StageEnd end_of_polish(StageEnd end, double polish, const std::optional<std::string>& open,
                       Reporter& report) {
  if (open)
    report.missed = "not polished to the end: " + *open;
  else if (end == StageEnd::hit_limit)
    report.missed = fmt::format("the contacts could not be closed to {:g}", polish);
  return open ? StageEnd::hit_limit : end;
}

StageEnd end_in_larger_box(StageEnd end, double polish, Reporter& report) {
  if (!(polish > 0) || end != StageEnd::converged) return end;
  report.missed =
      "the contacts that \"polish\" closes are open, because the box that is asked for is larger than the "
      "spheres need to hold each other: leave its size, or the packing fraction, out";
  return StageEnd::hit_limit;
}

template <int D>
bool lies_within(const Spheres<D>& spheres, const Vector<D>& edges, const Vector<D>& target) {
  const double rounding = tolerance::growth(target.maxCoeff() / std::ranges::min(spheres.r));
  return (target.array() >= edges.array() * (1 + rounding)).all();
}

template <int D>
StageEnd finish_in_periodic_box(Spheres<D> spheres, Vector<D> edges, StageEnd end, double polish_to,
                                SpheresInBox& in_box, Reporter& report) {
  if (polish_to > 0 && end == StageEnd::converged && !spheres.empty())
    end = close_contacts_in_box<D>(spheres, edges, polish_to, in_box, report);
  in_box.needed_volume = edges.prod();
  if (in_box.task.target_edges && lies_within<D>(spheres, edges, *in_box.task.target_edges)) {
    const double wider = in_box.task.target_edges->maxCoeff() / edges.maxCoeff() - 1;
    resize_box<D>(spheres, edges, *in_box.task.target_edges, is_tilted(in_box.task.domain));
    if (wider > polish_to) end = end_in_larger_box(end, polish_to, report);
  }
  in_box.spheres = std::move(spheres);
  in_box.edges = edges;
  in_box.placed = true;
  return end;
}

#define BERNAL_INSTANTIATE(D)                                                                         \
  template StageEnd finish_in_periodic_box<D>(Spheres<D>, Vector<D>, StageEnd, double, SpheresInBox&, \
                                              Reporter&);                                             \
  template bool lies_within<D>(const Spheres<D>&, const Vector<D>&, const Vector<D>&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
