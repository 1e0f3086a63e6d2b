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
StageEnd close_contacts_in_box(Spheres<D>& spheres, Vector<D>& edges, double polish_to, Work& work) {
  const EffectTimer timer(work.effects["polish"]);
  const StageEnd end = polish<D>(spheres, edges, polish_to, work);
  free_of_overlap<D>(spheres, edges, work);
  if (end == StageEnd::cancelled) return end;
  const double gap =
      polish_to + roundings * tolerance::growth(edges.maxCoeff() / std::ranges::min(spheres.r));
  const auto walls = static_cast<int>(std::ranges::count(work.walls, true));
  return end_of_polish(
      end, polish_to,
      what_is_open(gap, D, spheres.size(), D - walls, contacts_at<D>(gap, spheres, edges, work.walls)), work);
}

}  // namespace

StageEnd end_of_polish(StageEnd end, double polish, const std::optional<std::string>& open, Work& work) {
  if (open)
    work.missed = "not polished to the end: " + *open;
  else if (end == StageEnd::hit_limit)
    work.missed = fmt::format("the contacts could not be closed to {:g}", polish);
  return open ? StageEnd::hit_limit : end;
}

StageEnd end_in_larger_box(StageEnd end, double polish, Work& work) {
  if (!(polish > 0) || end != StageEnd::converged) return end;
  work.missed =
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
                                Work& work) {
  if (polish_to > 0 && end == StageEnd::converged && !spheres.empty())
    end = close_contacts_in_box<D>(spheres, edges, polish_to, work);
  work.needed_volume = edges.prod();
  if (work.target_edges && lies_within<D>(spheres, edges, *work.target_edges)) {
    const double wider = work.target_edges->maxCoeff() / edges.maxCoeff() - 1;
    resize_box<D>(spheres, edges, *work.target_edges);
    if (wider > polish_to) end = end_in_larger_box(end, polish_to, work);
  }
  work.spheres = std::move(spheres);
  work.edges = edges;
  work.placed = true;
  return end;
}

#define BERNAL_INSTANTIATE(D)                                                                  \
  template StageEnd finish_in_periodic_box<D>(Spheres<D>, Vector<D>, StageEnd, double, Work&); \
  template bool lies_within<D>(const Spheres<D>&, const Vector<D>&, const Vector<D>&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
