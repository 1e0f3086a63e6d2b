#include "layer_text.hpp"

#include <set>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/layer_amounts.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

std::string amount(double volume, double share, const std::optional<double>& mass, std::string_view unit) {
  return fmt::format("{:.6g} {}^3, {:.4f} of the volume{}", volume, unit, share,
                     mass ? fmt::format(", {:.6g} kg", *mass) : std::string());
}

}  // namespace

void print_layers(std::FILE* where, const Packing& packing) {
  const LayerAmounts amounts = layer_amounts(packing);
  if (amounts.layers.empty()) return;
  const std::string_view unit = name_of(packing.scene.unit);
  std::set<std::string> classes;
  for (const LayerAmount& of : amounts.layers) classes.insert(of.of_class);
  for (const LayerAmount& of : amounts.layers)
    say(where, "layer      {}{} in {} sphere{}: {}\n",
        classes.size() > 1 ? fmt::format("{} of {}", of.name, of.of_class) : of.name,
        of.material == of.name ? std::string() : fmt::format(" ({})", of.material), grouped(of.spheres),
        of.spheres == 1 ? "" : "s", amount(of.volume, of.packing_fraction, of.mass, unit));
  if (amounts.materials.size() == amounts.layers.size()) return;
  for (const MaterialAmount& of : amounts.materials)
    say(where, "material   {}: {}\n", of.name, amount(of.volume, of.packing_fraction, of.mass, unit));
}
