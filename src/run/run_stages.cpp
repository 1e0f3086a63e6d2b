#include "run/run_stages.hpp"

#include <string>
#include <utility>

#include "jam/few_spheres.hpp"
#include "plan/few_large.hpp"
#include "plan/stages.hpp"
#include "work/exact_fit.hpp"

namespace bernal {
namespace {

/// What a stage cannot do, only it knows; where the scene asks for it, only the run.
template <class Act, class There>
StageEnd act_on(There& there, const Act& act, const Stage& stage, Reporter& report) {
  try {
    return act(table_of(stage).options(stage), there, report);
  } catch (const Cancelled&) {
    return StageEnd::cancelled;
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    throw Error(error.code(), error.what(), stage.locations.whole);
  }
}

StageEnd run_in_bed(const Stage& stage, SpheresInBed& in_bed, Reporter& report) {
  const BedKeepsake before(in_bed);
  in_bed.bed().update_grid();  // of the places that the stage before left
  const StageEnd end = act_on(in_bed, entry_of(stage).act_in_bed, stage, report);
  if (end == StageEnd::cancelled) before.give_back_if_denser(in_bed);
  return end;
}

/// `bed`: what stood there before, if it did. A box that is larger than the one that was asked for is no
/// place for that.
StageEnd run_in_box(const Stage& stage, const std::optional<BedKeepsake>& bed, SpheresOfRun& spheres,
                    Reporter& report) {
  auto& in_box = std::get<SpheresInBox>(spheres);
  std::optional<SpheresInBox> before;
  if (in_box.placed) before.emplace(in_box);
  const StageEnd end = act_on(in_box, entry_of(stage).act_in_box, stage, report);
  if (end != StageEnd::cancelled) return end;
  if (before && !in_box.may_overlap && in_box.filled() < before->filled())
    spheres.emplace<SpheresInBox>(std::move(*before));
  auto& now = std::get<SpheresInBox>(spheres);
  if (bed && (now.edges != *now.task.target_edges || now.filled() < bed->packing_fraction())) {
    SpheresInBed in_bed(now.task, now.supply, report.effects);
    in_bed.put_back(bed->spheres());
    spheres.emplace<SpheresInBed>(std::move(in_bed));
  } else if (!now.placed) {
    now.leave({});
  }
  return end;
}

}  // namespace

StageEnd run_stages(const Scene& scene, SpheresOfRun& spheres, Reporter& report, Checkpoints& checkpoints,
                    std::optional<Pressing>& pressed) {
  StageEnd end = StageEnd::converged;
  std::size_t n = 0;               // stages that are over
  std::string facts;               // as the present one began
  std::optional<BedKeepsake> bed;  // in a box all may have to start anew
  LastPressed last_pressed(scene);
  const auto archive_facts = [&](Archive& a) {
    a(report);
    std::visit([&](auto& there) { there.archive_facts(a); }, spheres);
  };
  const auto keep_facts = [&] {
    facts.clear();
    ArchiveToBytes now(facts);
    archive_facts(now);
  };
  const auto stand = [&](bool in_bed) {
    in_bed ? stand_in_bed(spheres, report.effects) : stand_in_box(spheres);
  };
  const Checkpoints::Part part(checkpoints, "stages", [&](Archive& a) {
    bool in_bed = bed_of(spheres) != nullptr;
    a(n, end, facts, in_bed, bed);
    last_pressed.archive(a);
    if (a.reads()) {
      stand(in_bed);
      ArchiveFromBytes then(facts);
      archive_facts(then);
    }
    if (auto* there = std::get_if<SpheresInBed>(&spheres))
      there->archive_bed(a, report.effects);
    else if (n > 0)  // the first stage begins with them as they were drawn
      a(std::get<SpheresInBox>(spheres).spheres);
  });
  for (bool goes_on = part.resumed(); n < scene.stages.size() && end != StageEnd::cancelled; ++n) {
    const Stage& stage = scene.stages[n];
    const bool in_bed = table_of(stage).traits.stands_in_bed(scene);
    if (!std::exchange(goes_on, false)) {
      bed.reset();
      const auto* there = std::get_if<SpheresInBed>(&spheres);
      if (!in_bed && there) bed.emplace(*there);
      stand(in_bed);
      report.missed.clear();
      keep_facts();
      last_pressed.before_stage(bed_of(spheres));
    }
    end = in_bed ? run_in_bed(stage, std::get<SpheresInBed>(spheres), report)
                 : run_in_box(stage, bed, spheres, report);
    std::visit([](auto& there) { there.forget_start(); }, spheres);
    last_pressed.after_stage(n, bed_of(spheres));
    if (in_bed) report.milestone(stage.name(), *bed_of(spheres));
  }
  // Discs are relaxed by no stage.
  const auto* in_bed_last = bed_of(spheres);
  const std::size_t settled = in_bed_last ? in_bed_last->size() : 0;
  if (in_bed_last && end != StageEnd::cancelled && scene.dimension() == 2 && packs_few(scene))
    end = place_few(end, std::get<SpheresInBed>(spheres), report, true);
  if (end != StageEnd::cancelled) {
    auto* in_box = std::get_if<SpheresInBox>(&spheres);
    if (in_box && in_box->spheres.size() == in_box->supply->wanted()) fit_exactly(*in_box);
    keep_facts();
    checkpoints.write_if_long();
  }
  pressed = last_pressed.by();
  if (in_bed_last && bed_of(spheres)->size() > settled) pressed.reset();
  if (auto* in_bed = std::get_if<SpheresInBed>(&spheres)) end = leave_out_tail(*in_bed, report, end, pressed);
  return end;
}

}  // namespace bernal
