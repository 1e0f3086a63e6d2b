#include "run/run_zones.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "plan/fitting.hpp"
#include "plan/plan_zones.hpp"
#include "run/begin_packing.hpp"
#include "scene/layers_of_scene.hpp"
#include "work/effect_log.hpp"
#include "work/supply.hpp"

namespace bernal {
namespace {

class ZonedRun {
 public:
  ZonedRun(const Plan& plan, const RunOptions& options)
      : plan_(plan),
        options_(options),
        classes_(classes_of(plan.scene)),
        packing_(begin_packing(plan, options.seed, options.threads)) {
    packing_.domain = plan.domain;
    packing_.container = plan.container;
    packing_.volume = volume_of(plan.domain);
    packing_.spheres = Spheres<dynamic>(3);
  }

  Packing packed() {
    for (std::size_t k = 0; k < plan_.parts.size(); ++k) require_layers_of_part(k);
    if (options_.checkpoints.resume && options_.checkpoints.tell)
      options_.checkpoints.tell("a packing of zones has no checkpoints; it starts anew");
    for (std::size_t k = 0; k < plan_.parts.size(); ++k)
      if (packing_.outcome != Outcome::cancelled)
        pack(k);
      else
        packing_.reason += fmt::format("; {}: not begun", classes_[plan_.parts[k].sphere_class].name);
    wrap(packing_.spheres, packing_.domain);
    packing_.effects = effects_.all();
    return std::move(packing_);
  }

 private:
  /// No part waits for the others to hear that its sizes are too small for its layers. They are drawn as its
  /// run will draw them.
  void require_layers_of_part(std::size_t k) const {
    const Plan& plan = plan_.parts[k].plan;
    if (plan.scene.layers.empty()) return;
    Supply::Source source{*plan.radii, 3, seed_of_run(packing_.seed, k), *plan.scene.draw};
    if (!std::isfinite(source.radii.max()))
      source.cut = tail_cut(plan.scene, plan.domain, *plan.radii, plan.container);
    const Supply supply(source, volume_of(plan.domain), plan.scene.target);
    require_layers_fit(plan.scene, supply.smallest(), supply.largest());
  }

  void pack(std::size_t k) {
    const PlannedPart& part = plan_.parts[k];
    const std::size_t below = packing_.spheres.size();
    const bool onto = part.on_others && below > 0;
    Packing packed = onto ? run(plan_of_layer(plan_, part, packing_.spheres), sub_options(k))
                          : run(part.plan, sub_options(k));
    take_spheres(packed.spheres, part, onto ? below : 0);
    packing_.classes.resize(packing_.spheres.size(), part.sphere_class);
    take_account(packed, part, onto ? 0 : below);
  }

  /// Those of a layer come after those that it lies on, which it holds too.
  void take_spheres(Spheres<dynamic>& spheres, const PlannedPart& part, std::size_t below) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (double& x : spheres.x[axis]) x += part.shift[static_cast<Eigen::Index>(axis)];
    if (below > 0 && spheres.size() >= below) {
      packing_.spheres = std::move(spheres);
      return;
    }
    for (std::size_t i = 0; i < spheres.size(); ++i)
      packing_.spheres.push_back(spheres.center(i), spheres.r[i]);
  }

  void take_account(const Packing& packed, const PlannedPart& part, std::size_t before) {
    const std::size_t n = packing_.spheres.size();
    const double share = packed.volume / packing_.volume;
    const double filled_before = before > 0 ? filled_ : 0;
    for (Milestone milestone : packed.history) {
      milestone.stage = fmt::format("{}: {}", classes_[part.sphere_class].name, milestone.stage);
      milestone.spheres += before;
      milestone.packing_fraction = filled_before + share * milestone.packing_fraction;
      milestone.seconds += packing_.seconds;
      packing_.history.push_back(std::move(milestone));
    }
    for (const Effect& effect : packed.effects) effects_[effect.name] += effect;
    filled_ = packing_.packing_fraction();
    packing_.seconds += packed.seconds;
    Outcome outcome = packed.outcome;
    if (n == told_ && is_packed(outcome)) outcome = Outcome::full;
    packing_.outcome = std::max(packing_.outcome, outcome);  // they stand in the order of what is missing
    packing_.reason += fmt::format("{}{}, {} spheres: {}", packing_.reason.empty() ? "" : "; ",
                                   classes_[part.sphere_class].name, grouped(n - told_), packed.reason);
    told_ = n;
  }

  RunOptions sub_options(std::size_t k) const {
    RunOptions options{
        .seed = seed_of_run(packing_.seed, k),
        .threads = options_.threads,
        .monitor = {[this, k](const Progress& progress) { tell(progress, k); }, options_.monitor.cancelled},
        .checkpoints = {},
        .engine_folder = {}};
    return options;
  }

  /// What is told of a part is told of the whole.
  void tell(Progress progress, std::size_t k) const {
    double before = 0, all = 0;
    for (std::size_t other = 0; other < plan_.parts.size(); ++other) {
      const double seconds = std::max(1e-9, plan_.parts[other].plan.expected_seconds);
      if (other < k) before += seconds;
      all += seconds;
    }
    const double own = std::max(1e-9, plan_.parts[k].plan.expected_seconds);
    progress.fraction = (before + own * progress.fraction) / all;
    const std::string detail =
        fmt::format("{}: {}", classes_[plan_.parts[k].sphere_class].name, progress.detail);
    progress.detail = detail;
    options_.monitor.report(progress);
  }

  const Plan& plan_;
  const RunOptions& options_;
  const std::vector<SphereClass> classes_;
  Packing packing_;
  EffectLog effects_;
  double filled_ = 0;
  std::size_t told_ = 0;  // spheres of the zones that the reason tells of
};

}  // namespace

Packing run_zones(const Plan& plan, const RunOptions& options) { return ZonedRun(plan, options).packed(); }

}  // namespace bernal
