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
std::unique_ptr<Bed> bed_of(const Spheres<3>& spheres, const std::vector<std::uint32_t>& tags, double size,
                            const SpheresInBed& in_bed, EffectLog& effects) {
  const Boundary<3>& boundary = in_bed.task.container->boundary();
  for (int k = 0; k < 3; ++k)
    if (boundary.repeats(k) && boundary.edges[k] < Bed::least_period * 2 * size * in_bed.supply->largest())
      return nullptr;
  auto bed = std::make_unique<Bed>(*in_bed.task.container, size * in_bed.supply->smallest(),
                                   size * in_bed.supply->largest(), spheres.size(), effects);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (!bed->fits(spheres.center(i), size * spheres.r[i])) return nullptr;
    bed->insert(spheres.center(i), size * spheres.r[i], tags[i]);
  }
  return bed;
}

}  // namespace

StageEnd finish_in_bed(StageEnd end, double polish, SpheresInBed& in_bed, Reporter& report) {
  const Bed& bed = in_bed.bed();
  if (!(polish > 0) || end == StageEnd::cancelled || bed.size() == 0) return end;
  const EffectTimer timer(report.effects["polish"]);
  const Spheres<3> spheres = bed.spheres();
  const std::vector<std::uint32_t> tags = bed.tags();
  const double closest = std::max(least_overlap, share_of_solver * polish);
  const int symmetries = symmetries_of(in_bed.task.domain);
  const Jammed jammed = polish_in_container(
      spheres, bed.container(), symmetries, closest, report.monitor,
      [&](double done, double overlap) {
        const double filled = in_bed.volume_of(spheres) / in_bed.task.container->volume();
        report.milestone("polish", spheres.size(), filled, overlap, done);
      },
      report.checkpoints);
  if (jammed.end == StageEnd::cancelled) return jammed.end;
  if (jammed.too_loose) {
    report.missed = fmt::format(
        "the spheres are not polished, because they would have to grow by more than {:g} % to hold each "
        "other: ask for more of them",
        100 * (Jammed::most_growth - 1));
    return StageEnd::hit_limit;
  }
  const double skin = bed.skin() / in_bed.supply->smallest();
  for (int k = 0; k < most_tries; ++k) {
    const double room = std::ldexp(skin, k);  // for the skin
    const double size = jammed.growth * (1 - room);
    std::unique_ptr<Bed> polished = bed_of(jammed.spheres, tags, size, in_bed, report.effects);
    if (!polished) continue;
    in_bed.supply->multiply_by(size);
    in_bed.replace_bed(std::move(polished));
    if (jammed.held_volume < 0.5) {
      report.missed = fmt::format(
          "{} wedged in, mostly where the container is about as narrow as they are large, before sizes have "
          "grown so far that the others touch",
          jammed.held == 0
              ? fmt::format("none of the {} spheres hold each other: some are", spheres.size())
              : fmt::format("only {} of {} spheres hold each other: some are", jammed.held, spheres.size()));
      return StageEnd::hit_limit;
    }
    const double gap = std::max(polish, closest + 2 * room);
    const Spheres<3> now = in_bed.bed().spheres();
    const std::optional<std::string> open =
        what_is_open(gap, in_bed.bed().dimension(), now.size(), symmetries,
                     contacts_at(gap, now, in_bed.bed().container()));
    if (!open && polish < least_overlap && jammed.end == StageEnd::converged) {
      report.missed = fmt::format(
          "contacts are closed to {:.2g} and not to {:g}: in a container spheres keep "
          "that off each other and the walls",
          gap, polish);
      return StageEnd::hit_limit;
    }
    return end_of_polish(jammed.end == StageEnd::converged ? end : jammed.end, polish, open, report);
  }
  report.missed = "the spheres could not be polished";
  return StageEnd::hit_limit;
}

}  // namespace bernal
