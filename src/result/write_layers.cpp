#include "result/write_layers.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace bernal {
namespace {

const std::vector<Layer>& layers_of_sphere(const SphereLayers& layers, const Packing& packing,
                                           std::size_t sphere) {
  return layers.of_class[packing.classes.empty() ? 0 : packing.classes[sphere]];
}

}  // namespace

void write_layers_csv(OutputFile& file, const SphereLayers& layers, const Packing& packing) {
  file.append(fmt::format("# unit: {}\n{}\n", name_of(packing.scene.unit), header_of_layers));
  constexpr std::size_t block = 1 << 16;
  std::string text;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    double inner = 0;
    const std::vector<Layer>& of = layers_of_sphere(layers, packing, i);
    const auto outer = layers.of(i);
    for (std::size_t k = 0; k < outer.size(); ++k) {
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", i, of[k].name, material_of(of[k]), inner,
                     outer[k]);
      inner = outer[k];
    }
    if (text.size() < block) continue;
    file.append(text);
    text.clear();
  }
  file.append(text);
}

std::vector<NamedColumn> columns_of_layers(const SphereLayers& layers, const Packing& packing) {
  std::vector<NamedColumn> columns;
  const auto column_of = [&](const std::string& name) {
    return std::ranges::find(columns, "outer_" + name, &NamedColumn::name);
  };
  const std::vector<double> without(packing.spheres.size(), std::numeric_limits<double>::quiet_NaN());
  for (const std::vector<Layer>& of_class : layers.of_class)
    for (const Layer& layer : of_class)
      if (column_of(layer.name) == columns.end()) columns.push_back({"outer_" + layer.name, without});
  for (std::size_t i = 0; !columns.empty() && i < packing.spheres.size(); ++i) {
    const std::vector<Layer>& of = layers_of_sphere(layers, packing, i);
    const auto outer = layers.of(i);
    for (std::size_t k = 0; k < outer.size(); ++k) column_of(of[k].name)->values[i] = outer[k];
  }
  return columns;
}

}  // namespace bernal
