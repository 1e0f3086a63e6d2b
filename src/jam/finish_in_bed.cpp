#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "bernal/core/tolerance.hpp"
#include "jam/held.hpp"
#include "jam/polish.hpp"

namespace bernal {
namespace {

/// Of the gaps that are asked for: what overlaps may be left to the solver, before all are made gaps.
constexpr double share_of_solver = 0.25;
/// No overlap ratio is smaller than this, whatever is asked for: the skin is ten times that.
constexpr double least_overlap = 1e-10;
/// How often the skin is allowed for, each time twice as generously.
constexpr int most_tries = 8;

/// A bed with these spheres and all radii times `size`, or null if there is not room for all.
std::shared_ptr<Bed> bed_of(const Spheres<3>& spheres, const std::vector<std::uint32_t>& tags, double size,
                            Work& work) {
  const Boundary<3>& boundary = work.container->boundary();
  for (int k = 0; k < 3; ++k)
    if (boundary.repeats(k) && boundary.edges[k] < Bed::least_period * 2 * size * work.supply->largest())
      return nullptr;
  const auto bed = std::make_shared<Bed>(*work.container, size * work.supply->smallest(),
                                         size * work.supply->largest(), spheres.size(), work.effects);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (!bed->fits(spheres.center(i), size * spheres.r[i])) return nullptr;
    bed->insert(spheres.center(i), size * spheres.r[i], tags[i]);
  }
  return bed;
}

}  // namespace

StageEnd finish_in_bed(StageEnd end, double polish, Work& work) {
  const Bed& bed = work.bed();
  if (!(polish > 0) || end == StageEnd::cancelled || bed.size() == 0) return end;
  const EffectTimer timer(work.effects["polish"]);
  const Spheres<3> spheres = bed.spheres();
  std::vector<std::uint32_t> tags;
  for (Bed::Id i = 0; i < bed.size(); ++i) tags.push_back(bed.tag(i));
  std::ranges::sort(tags);
  const double closest = std::max(least_overlap, share_of_solver * polish);
  const int symmetries = symmetries_of(work.domain);
  const Jammed jammed = polish_in_container(
      spheres, bed.container(), symmetries, closest, work.monitor,
      [&](double done, double overlap) {
        work.crowd_milestone("polish", spheres.size(), volume_of(spheres), overlap, done);
      },
      work.checkpoints);
  if (jammed.end == StageEnd::cancelled) return jammed.end;
  if (jammed.too_loose) {
    work.missed = fmt::format(
        "the spheres are not polished, because they would have to grow by more than {:g} % to hold each "
        "other: ask for more of them",
        100 * (Jammed::most_growth - 1));
    return StageEnd::hit_limit;
  }
  const double skin = bed.skin() / work.supply->smallest();
  for (int k = 0; k < most_tries; ++k) {
    const double room = std::ldexp(skin, k);  // for the skin
    const double size = jammed.growth * (1 - room);
    const std::shared_ptr<Bed> polished = bed_of(jammed.spheres, tags, size, work);
    if (!polished) continue;
    work.supply->multiply_by(size);
    work.size_scale *= size;
    work.bed_ = polished;
    if (jammed.held_volume < 0.5) {
      work.missed = fmt::format(
          "only {} of {} spheres hold each other: some are wedged in, mostly where the container is about as "
          "narrow as they are large, before sizes have grown so far that the others touch",
          jammed.held, spheres.size());
      return StageEnd::hit_limit;
    }
    const double gap = std::max(polish, closest + 2 * room);
    const Spheres<3> now = polished->spheres();
    const std::optional<std::string> open =
        what_is_open(gap, 3, now.size(), symmetries, contacts_at(gap, now, polished->container()));
    return end_of_polish(jammed.end == StageEnd::converged ? end : jammed.end, polish, open, work);
  }
  work.missed = "the spheres could not be polished";
  return StageEnd::hit_limit;
}

}  // namespace bernal
