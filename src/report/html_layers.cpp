#include <algorithm>
#include <set>
#include <string_view>

#include "bernal/core/text.hpp"
#include "report/page.hpp"

namespace bernal {

/// What there is of each layer that the scene names, and of each material.
void write_layers(Page& page, const Report& report) {
  const auto& [layers, materials] = report.layers;
  if (layers.empty()) return;
  const std::string unit = escaped(name_of(report.packing.scene.unit));
  std::set<std::string_view> classes;
  for (const LayerAmount& layer : layers) classes.insert(layer.of_class);
  const bool has_classes = classes.size() > 1;
  const bool has_mass =
      std::ranges::any_of(layers, [](const LayerAmount& of) { return of.mass.has_value(); });
  const auto mass_cell = [&](const std::optional<double>& mass) {
    return !has_mass ? std::string()
                     : fmt::format("<td class=\"n\">{}</td>", mass ? fmt::format("{:.4g}", *mass) : "");
  };
  const std::string_view mass_head = has_mass ? "<th class=\"n\">mass (kg)</th>" : "";
  page.add(
      "<h2>Layers</h2>\n<table><tr>{}<th>layer</th><th>material</th><th class=\"n\">spheres</th>"
      "<th class=\"n\">volume ({}³)</th><th class=\"n\">of the container</th>{}</tr>\n",
      has_classes ? "<th>class</th>" : "", unit, mass_head);
  for (const LayerAmount& of : layers)
    page.add(
        "<tr>{}<td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{:.6g}</td>"
        "<td class=\"n\">{:.5f}</td>{}</tr>\n",
        has_classes ? fmt::format("<td>{}</td>", escaped(of.of_class)) : "", escaped(of.name),
        escaped(of.material), grouped(of.spheres), of.volume, of.packing_fraction, mass_cell(of.mass));
  page.raw("</table>\n");
  if (materials.size() == layers.size()) return;
  page.add(
      "<table><tr><th>material</th><th class=\"n\">volume ({}³)</th><th class=\"n\">of the container</th>{}"
      "</tr>\n",
      unit, mass_head);
  for (const MaterialAmount& of : materials)
    page.add("<tr><td>{}</td><td class=\"n\">{:.6g}</td><td class=\"n\">{:.5f}</td>{}</tr>\n",
             escaped(of.name), of.volume, of.packing_fraction, mass_cell(of.mass));
  page.raw("</table>\n");
}

}  // namespace bernal
