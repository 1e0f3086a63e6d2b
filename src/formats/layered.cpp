#include "formats/layered.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"

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
  const std::vector<SphereClass> classes = classes_of(packing.scene);
  LayeredSpheres made;
  made.materials = materials_of(packing.scene);
  const auto material_at = [&](const std::string& name) {
    return static_cast<std::uint32_t>(std::ranges::find(made.materials, name) - made.materials.begin());
  };
  const auto is_twice = [&](const std::string& name) {
    return 1 < std::ranges::count_if(layers.of_class, [&](const std::vector<Layer>& of) {
             return std::ranges::find(of, name, &Layer::name) != of.end();
           });
  };
  std::vector<std::uint32_t> first_kind;  // of each class
  const std::size_t n = std::max<std::size_t>(1, classes.size());
  for (std::size_t c = 0; c < n; ++c) {
    first_kind.push_back(static_cast<std::uint32_t>(made.kinds.size()));
    const std::string of_class = classes.empty() ? "spheres" : classes[c].name;
    if (c >= layers.of_class.size() || layers.of_class[c].empty()) {
      made.kinds.push_back({of_class, material_at(classes.empty() ? of_class : material_of(classes[c]))});
      continue;
    }
    for (const Layer& layer : layers.of_class[c])
      made.kinds.push_back({is_twice(layer.name) ? fmt::format("{} of {}", layer.name, of_class) : layer.name,
                            material_at(material_of(layer))});
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
