#include "scene/scale_entry.hpp"

#include <cmath>

namespace bernal::schema {
namespace {

constexpr std::string_view largest_word = "largest";

/// It takes that word, too.
Key or_largest(Key key) {
  key.words = {largest_word};
  return key;
}

/// The sizes, as radii or as diameters. The reader has "largest" as an endless length, which stands for
/// spheres of one size on the largest scale.
Member sizes(bool diameters) {
  Member member;
  member.get = [diameters](const void* scene) -> std::optional<Value> {
    const auto& of = *static_cast<const Scene*>(scene);
    if (of.sizes_are_diameters != diameters || !of.draws() || of.cells) return std::nullopt;
    return std::vector<SceneSizes>{of.sizes};
  };
  member.set = [diameters](void* scene, const Value& value) {
    auto& of = *static_cast<Scene*>(scene);
    of.sizes_are_diameters = diameters;
    of.sizes = std::get<std::vector<SceneSizes>>(value).front();
    if (auto* one = std::get_if<Constant>(&of.sizes); one && std::isinf(one->value)) {
      one->value = 1;
      of.largest = true;
    }
  };
  return member;
}

/// A number, or "largest"; said only where it is not 1.
Member scale() {
  Member member;
  member.get = [](const void* scene) -> std::optional<Value> {
    const auto& of = *static_cast<const Scene*>(scene);
    if (of.largest) return std::string(largest_word);
    return of.scale == 1 ? std::nullopt : std::optional<Value>(of.scale);
  };
  member.set = [](void* scene, const Value& value) {
    auto& of = *static_cast<Scene*>(scene);
    of.largest = std::holds_alternative<std::string>(value);
    if (!of.largest) of.scale = std::get<double>(value);
  };
  return member;
}

}  // namespace

Key size_key(bool diameters) {
  return diameters ? or_largest(key(Type::distribution, sizes(true), "diameter",
                                    "lengths are diameters; \"largest\" as for radius"))
                   : or_largest(key(Type::distribution, sizes(false), "radius",
                                    "lengths are radii; \"largest\", with count: as large as so many "
                                    "spheres of one size are found to fit, to 1e-4"));
}

Key scale_key() {
  return or_largest(
      number(scale(), "scale",
             "all sizes are so many times those of radius or diameter; \"largest\", with count: "
             "as many times as so many spheres are found to fit, to 1e-4; if absent 1",
             above(0, largest_length)));
}

void scale_rule(const Scene& scene, const Section& section) {
  if (!scene.largest) return;
  const std::string_view said = section.locations.keys.contains("scale") ? "scale"
                                : scene.sizes_are_diameters              ? "diameter"
                                                                         : "radius";
  if (!scene.target.count || scene.target.has_packing_fraction())
    section.fail(said,
                 "how large spheres can be depends on how many there are: \"largest\" in [spheres] needs "
                 "\"count\", and no \"packing_fraction\" beside it");
  if (scene.start.file || scene.start.packing || scene.engine)
    section.fail(
        said,
        "the largest spheres are found from many beginnings: leave \"start\" and [engine] out, or give "
        "a size in place of \"largest\"");
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (box && (box->scalable || (box->size.empty() && !box->edge)))
    section.fail(said,
                 "a box that grows with its spheres takes them however large they are: give it a \"size\" or "
                 "an \"edge\", or a size in place of \"largest\"");
}

}  // namespace bernal::schema
