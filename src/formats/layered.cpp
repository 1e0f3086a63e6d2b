#include "formats/layered.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "scene/sphere_matter.hpp"

namespace bernal {

bool shows_layers(const Exported& file) { return file.output.layers && has_layers(file.packing.scene); }

BallsOfLayer balls_of_layer(const Exported& file, const std::string& name) {
  const LayeredSpheres layers = layered(file);
  const std::vector<std::vector<Layer>> of_class = layers_by_class(file.packing.scene);
  BallsOfLayer made{.balls = Spheres<dynamic>(file.dimension())};
  const auto add = [&](std::size_t i, double radius) {
    for (std::size_t k = 0; k < made.balls.x.size(); ++k) made.balls.x[k].push_back(file.spheres.x[k][i]);
    made.balls.r.push_back(radius);
  };
  std::vector<std::pair<std::size_t, double>> holes;
  for (std::size_t i = 0; i < file.size(); ++i) {
    const std::vector<Layer>& of = of_class[file.packing.classes.empty() ? 0 : file.packing.classes[i]];
    const auto found = std::ranges::find(of, name, &Layer::name);
    if (found == of.end()) continue;
    const auto k = static_cast<std::size_t>(found - of.begin());
    add(i, layers.of(i)[k]);
    if (k > 0) holes.emplace_back(i, layers.of(i)[k - 1]);
  }
  made.outer = made.balls.size();
  for (const auto& [i, radius] : holes) add(i, radius);
  return made;
}

LayeredSpheres layered(const Exported& file) {
  const Packing& packing = file.packing;
  const SphereLayers layers = layers_of(packing);
  const std::vector<std::vector<SphereMatter>> matter = matter_by_class(packing.scene);
  const std::vector<SphereClass> classes = classes_of(packing.scene);
  LayeredSpheres made;
  made.materials = materials_of(packing.scene);
  const auto is_twice = [&](const std::string& name) {
    return 1 < std::ranges::count_if(matter, [&](const std::vector<SphereMatter>& of_class) {
             return std::ranges::any_of(
                 of_class, [&](const SphereMatter& of) { return of.is_layer && of.name == name; });
           });
  };
  std::vector<std::uint32_t> first_kind;  // of each class
  for (std::size_t c = 0; c < matter.size(); ++c) {
    first_kind.push_back(static_cast<std::uint32_t>(made.kinds.size()));
    for (const SphereMatter& of : matter[c]) {
      const auto material = std::ranges::find(made.materials, of.material) - made.materials.begin();
      made.kinds.push_back(
          {of.is_layer && is_twice(of.name) ? fmt::format("{} of {}", of.name, classes[c].name) : of.name,
           static_cast<std::uint32_t>(material)});
    }
  }
  made.first.push_back(0);
  for (std::size_t i = 0; i < file.size(); ++i) {
    const std::uint32_t of_class = packing.classes.empty() ? 0 : packing.classes[i];
    const double radius = file.spheres.r[i], factor = radius / packing.spheres.r[i];
    const std::span<const double> outer = layers.empty() ? std::span<const double>() : layers.of(i);
    for (std::size_t k = 0; k + 1 < outer.size(); ++k) made.outer.push_back(outer[k] * factor);
    made.outer.push_back(radius);
    for (std::uint32_t k = 0; k < std::max<std::size_t>(1, outer.size()); ++k)
      made.kind.push_back(first_kind[of_class] + k);
    made.first.push_back(made.outer.size());
  }
  return made;
}

}  // namespace bernal
