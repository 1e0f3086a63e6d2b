#include "scene/porosity.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "scene/scene_entries.hpp"
#include "scene/stage_table.hpp"

namespace bernal {

bool has_fixed_walls(const PeriodicBox& box) {
  return !box.walls.empty() && box.dimension == 3 && !box.scalable;
}

/// Where [spheres] says no more of a bed than how much of it is left free: whether something makes a bed.
static bool may_be_bed(const Scene& scene) {
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  const bool has_floor = scene.dimension() == 3 && (!box || has_fixed_walls(*box));
  const auto makes_bed = [](const Stage& stage) { return table_of(stage).traits.makes_bed; };
  return has_floor && (scene.stages.empty() || std::ranges::any_of(scene.stages, makes_bed));
}

std::string doubt_of_density(std::string_view key, double density) {
  constexpr double densest = 23;  // in g/cm³: osmium has 22.6
  if (density >= densest) return {};
  return fmt::format("\"{}\" = {:g} is in kg/m3; write \"{:g} g/cm3\" where that is meant", key, density,
                     density);
}

void take_porosity(Scene& scene) {
  Target& target = scene.target;
  BedTarget& bed = target.bed;
  const auto fail = [&](const std::string& why) { throw Error(ErrorCode::bad_scene, why, target.where); };
  const auto rounded = [](double of) { return std::stod(fmt::format("{:.15g}", of)); };  // 0.58 = 1 - 0.42
  if (target.bulk_density) {
    const schema::Range range = schema::spheres_entry().find("porosity")->range;
    const double solid = *target.bulk_density / *scene.material_density;
    if (bed.porosity || bed.density)
      fail("\"bulk_density\" in [spheres] says how dense the bed is: leave \"bed\" and \"porosity\" out");
    if (!range.contains(1 - solid)) {
      const std::string doubt = solid < 0.5 ? doubt_of_density("bulk_density", *target.bulk_density)
                                            : doubt_of_density("material_density", *scene.material_density);
      fail(fmt::format(
          "a \"bulk_density\" of {:g} kg/m3 with a \"material_density\" of {:g} leaves a porosity "
          "of {:.3g}, and spheres leave one between {:g} and {:g}{}",
          *target.bulk_density, *scene.material_density, 1 - solid, range.min, range.max,
          !doubt.empty() ? "; " + doubt
          : solid > 0.5  ? ": is it the density of the material?"
                         : ""));
    }
    bed.porosity = rounded(1 - solid);
    target.bulk_density_asked = std::exchange(target.bulk_density, std::nullopt);
  }
  if (!bed.porosity || bed.top || bed.gives_height() || may_be_bed(scene)) return;
  if (target.has_packing_fraction())
    fail("a porosity and a \"packing_fraction\" in [spheres] say the same; give one of them");
  target.packing_fraction = rounded(1 - *std::exchange(bed.porosity, std::nullopt));
}

}  // namespace bernal
