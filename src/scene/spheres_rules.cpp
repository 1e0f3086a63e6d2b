#include "scene/spheres_rules.hpp"

#include <string_view>

#include <fmt/format.h>

#include "bernal/scene/sphere_layers.hpp"
#include "scene/sphere_matter.hpp"

namespace bernal::schema {

bool is_sha256(const std::string& digest) {
  return digest.size() == 64 && digest.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
}

void amounts_rule(const Scene& scene, const Section& section) {
  for (const std::string_view amount : {"mass", "bulk_density"}) {
    const bool is_mass = amount == "mass";
    if (scene.material_density || !(is_mass ? scene.target.mass : scene.target.bulk_density)) continue;
    if (is_mass && layers_have_densities(scene)) continue;
    section.fail(amount,
                 fmt::format("\"{}\" in {} needs the \"material_density\" of the spheres, in kg/m3, such "
                             "as 2500 for glass{}",
                             amount, section.name,
                             is_mass && has_layers(scene) ? ", or of each of their layers" : ""));
  }
}

void start_rule(const Scene& scene, const Section& section) {
  const auto& [file, unit, box, sha256, packing] = scene.start;
  const auto* periodic = std::get_if<PeriodicBox>(&scene.container);
  if (!file && (unit || !box.empty() || !sha256.empty()))
    section.fail(unit           ? "start_unit"
                 : !box.empty() ? "start_box"
                                : "start_sha256",
                 "what is said of a start needs the \"start\" itself, the file of its spheres");
  if (!box.empty() && !periodic) section.refuse("start_box", "is for periodic boxes; leave it out");
  if (!box.empty() && static_cast<int>(box.size()) != periodic->dimension)
    section.refuse("start_box", fmt::format("must have a length for each of {} dimensions, but it has {}",
                                            periodic->dimension, box.size()));
  if (sha256.size() > 1) section.refuse("start_sha256", "must be one");
  for (const std::string& digest : sha256)
    if (!is_sha256(digest))
      section.refuse("start_sha256", "must have 64 hexadecimal digits, as sha256sum prints them");
}

}  // namespace bernal::schema
