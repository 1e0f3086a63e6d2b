#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bernal/domain/domain.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/scene.hpp"
#include "bernal/sizes/size_distribution.hpp"
#include "work/work.hpp"

namespace bernal {

// Every name that a scene can use, and what makes the thing behind it. A new container, size distribution
// or stage is one line in one of these tables (and one entry in the schema of scene/ for its parameters).

struct ContainerEntry {
  std::string_view name;
  /// The domain in the scene's unit; an importer says in `notes` what it did to the file.
  Domain (*make)(const Scene&, std::string& notes);
};

struct SizesEntry {
  std::string_view name;
  /// The distribution of *radii*; `half` is 0.5 where the scene speaks of diameters and 1 where of radii.
  std::unique_ptr<SizeDistribution> (*make)(const Spec&, double half);
};

struct StageEntry {
  std::string_view name;
  /// On spheres in a bed; null where it cannot.
  StageEnd (*run)(const Spec&, Work&);
  /// On spheres in a box; null where it cannot.
  StageEnd (*run_periodic)(const Spec&, Work&);
  /// Effects that it brings with it in a container and in a periodic box, for `Plan::items`.
  std::span<const PlanItem> effects, periodic_effects = {};
  /// Of a stage that chooses among methods in a periodic box: those of its effects that the plan calls for.
  std::vector<PlanItem> (*chosen_effects)(const Spec&, const Plan&) = nullptr;
  /// Whether it places as many spheres as are expected to fit where the scene says nothing.
  bool meets_expectation = false;
  /// Of a stage that works in a bed and in a box: where walls leave it the choice.
  bool prefers_bed = false;

  std::span<const PlanItem> effects_in(const Scene& scene) const {
    return scene.is_periodic() ? periodic_effects : effects;
  }
};

std::span<const ContainerEntry> container_catalogue();
std::span<const SizesEntry> sizes_catalogue();
std::span<const StageEntry> stage_catalogue();

/// Whether the stage works on spheres that stand in a bed: in containers, and between walls of a box of three
/// dimensions and given size where it does not need a box that scales.
bool works_in_bed(const Spec& stage, const Plan& plan);

/// What a stage that fills a box of given edges has to do, by the plan's box, sizes and target.
FillTask fill_task_of(const Plan& plan);

/// The entry of that name. Throws Error{bad_scene} at the spec's place for an unknown one, which only a scene
/// made in C++ can contain.
template <class Entry>
const Entry& find_entry(std::span<const Entry> catalogue, const Spec& spec) {
  for (const Entry& entry : catalogue) {
    if (entry.name == spec.name) return entry;
  }
  throw Error(ErrorCode::bad_scene, "nothing is called \"" + spec.name + "\"", spec.where);
}

}  // namespace bernal
