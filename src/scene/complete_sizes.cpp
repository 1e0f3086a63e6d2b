#include "scene/complete_sizes.hpp"

#include <cmath>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "scene/scene_entries.hpp"
#include "scene/size_kinds.hpp"

namespace bernal {
namespace {

constexpr std::string_view or_draw = "or draw from the list, with draw = \"resample\" in it";

void refuse_each_in_parts(const SceneSizes& sizes) {
  const auto* mixture = std::get_if<Mixture>(&sizes);
  if (!mixture) return;
  for (const SceneSizes& part : mixture->of) {
    if (each_once(part))
      throw Error(
          ErrorCode::bad_scene,
          "a list in a mixture is drawn from: say draw = \"resample\" in it, or leave the mixture out",
          part.locations.whole);
    refuse_each_in_parts(part);
  }
}

}  // namespace

void complete_density(Scene& scene) {
  const auto* classes = std::get_if<Classes>(&scene.sizes);
  const std::optional<double> mean = classes ? mean_density(*classes) : std::nullopt;
  if (!mean) return;
  constexpr double rounding = 1e-9;
  if (!scene.material_density) scene.material_density = mean;
  if (std::abs(*scene.material_density / *mean - 1) > rounding)
    throw Error(ErrorCode::bad_scene,
                fmt::format("the classes have densities of their own, {:.6g} kg/m3 together: leave "
                            "\"material_density\" out of [spheres]",
                            *mean),
                scene.locations.of("material_density"));
}

void complete_list(Scene& scene) {
  if (!scene.draws()) return;
  refuse_each_in_parts(scene.sizes);
  const ListedSizes* list = each_once(scene.sizes);
  if (!list) return;
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  const Target& target = scene.target;
  const bool box_follows = box && (box->scalable || (box->size.empty() && !box->edge));
  if (target.fill || target.mass || target.bed.gives_height() ||
      (target.has_packing_fraction() && !box_follows))
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("the list says how many spheres there are, {}, each exactly once: leave \"fill\", "
                    "\"packing_fraction\" and the height of a bed out of [spheres], {}",
                    grouped(list->values.size()), or_draw),
        target.where);
  if (scene.draw && *scene.draw == Draw::random)
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("draw = \"random\" in [spheres] would take some sizes of the list twice and others "
                    "not at all: leave it out, {}",
                    or_draw),
        scene.locations.of("draw"));
  scene.draw = Draw::quantiles;  // which deals every size as often as it is there
  if (!scene.start.file) complete_count_of_list(scene, 0);
}

void complete_count_of_list(Scene& scene, std::size_t there) {
  const ListedSizes* list = each_once(scene.sizes);
  if (!list) return;
  std::optional<std::int64_t>& count = scene.target.count;
  const auto all = static_cast<std::int64_t>(there + list->values.size());
  if (count && *count != all)
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("\"count\" in [spheres] says {}, but the list has {} sizes, each exactly once{}: "
                    "leave it out, {}",
                    grouped(static_cast<std::uint64_t>(*count)), grouped(list->values.size()),
                    there > 0 ? fmt::format(", and the start {} spheres", grouped(there)) : "", or_draw),
        scene.locations.of("count"));
  count = all;
}

}  // namespace bernal
