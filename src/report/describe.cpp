#include "bernal/report/describe.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "report/describe.hpp"
#include "scene/scene_entries.hpp"
#include "scene/sphere_matter.hpp"

namespace bernal {
namespace {

/// "cylinder of 2 x 2 x 2 m, volume 6.28319 m³".
std::string describe_container(const Plan& plan) {
  const std::string_view unit = name_of(plan.scene.unit);
  const Vector<dynamic> size = bounds_of<dynamic>(plan.domain).size();
  std::string text(is_periodic(plan.domain) && has_walls(plan.domain)
                       ? name_of(plan.domain)
                       : std::string(schema::word_of(plan.scene.container, plan.domain)));
  if (const auto* mesh = std::get_if<MeshFile>(&plan.scene.container))
    text += fmt::format(" {}", plain_text(mesh->file.string()));
  if (plan.box_follows) text += ", as large as the packing needs";
  return fmt::format("{}{} {:.6g} {}{}, {} {:.6g} {}^{}", text, plan.box_follows ? ": about" : ",",
                     fmt::join(size, " x "), unit, tilt_in_words(plan.domain),
                     size.size() == 2 ? "area" : "volume", volume_of(plan.domain), unit, size.size());
}

/// "lammps.data, for lammps, in m"; precondition: the output is complete.
std::string describe_output(const Output& output) {
  return fmt::format("{}, for {}, in {}", plain_text(output.file.string()), output.format,
                     name_of(output.unit.value_or(Unit::m)));
}

/// A line for each zone and for each piece of what lies in none.
std::string describe_parts(const Plan& plan) {
  const std::vector<SphereClass> classes = classes_of(plan.scene);
  std::string text;
  for (const PlannedPart& part : plan.parts) {
    const bool is_zone = part.sphere_class < plan.scene.zones.size();
    std::string place;
    if (is_zone) {
      const Zone& zone = plan.scene.zones[part.sphere_class];
      place =
          zone.mesh ? plain_text(zone.mesh->file.string()) : fmt::format("{}", fmt::join(zone.place, ", "));
    }
    text += fmt::format("{:<9}  {}{}: {}; {}; {}\n", is_zone ? "zone" : "the rest",
                        classes[part.sphere_class].name, place.empty() ? "" : ", " + place,
                        describe_target(part.plan), describe_sizes(part.plan.scene),
                        spheres_in_words(part.plan.expected_count));
  }
  return text;
}

}  // namespace

std::string tilt_in_words(const Domain& domain) {
  if (!is_tilted(domain)) return {};
  const auto& [xy, xz, yz] = std::get<Box>(domain).tilt;
  return dimension_of(domain) == 2 ? fmt::format(", tilt {:.10g}", xy)
                                   : fmt::format(", tilt {:.10g}, {:.10g}, {:.10g}", xy, xz, yz);
}

std::string spheres_in_words(double count) {
  const double whole = std::max(1.0, std::round(count));
  return fmt::format("about {:.3g} sphere{}", whole, whole == 1 ? "" : "s");
}

std::string describe(const Plan& plan) {
  std::string text = fmt::format("container  {}\n", describe_container(plan));
  if (!plan.container_notes.empty()) text += fmt::format("           {}\n", plan.container_notes);
  if (const std::size_t n = plan.start.spheres.size(); n > 0)
    text += fmt::format("start      {} of {}; \"{}\" begins from {}\n",
                        n == 1 ? "1 sphere" : grouped(n) + " spheres", plain_text(plan.start.file),
                        plan.scene.stages.front().name(), n == 1 ? "it" : "them");
  if (plan.parts.empty())
    text += fmt::format("spheres    {}; {}\n", describe_target(plan), describe_sizes(plan.scene));
  else
    text += describe_parts(plan);
  if (!plan.caution.empty()) text += fmt::format("caution    {}\n", plan.caution);
  for (const std::string& hint : plan.hints) text += fmt::format("note       {}\n", hint);
  if (plan.scene.asks_for_gaps())
    text += fmt::format(
        "gaps       at least {:g} {} between spheres{}\n", plan.scene.gap, name_of(plan.scene.unit),
        has_walls(plan.domain) ? fmt::format(" and {:g} from walls", plan.scene.wall_gap) : std::string());
  for (const Output& output : plan.scene.outputs)
    text += fmt::format("output     {}\n", describe_output(output));
  return in_dimension(plan.scene.dimension(), text);
}

std::string describe_sizes(const Scene& scene) {
  if (!scene.draws()) return "the sizes are those of the start";
  if (const auto& cells = scene.cells)
    return cells->volume
               ? fmt::format("cells, volume in {}³: {}", name_of(scene.unit), sizes_in_words(*cells->volume))
               : fmt::format("cells, diameter of the ball of their volume in {}: {}", name_of(scene.unit),
                             sizes_in_words(*cells->diameter));
  const bool is_one = std::holds_alternative<Constant>(scene.sizes);
  std::string scale;
  if (scene.largest && !is_one) scale = "; all on the largest scale on which they fit";
  if (!scene.largest && scene.scale != 1) scale = fmt::format("; all times {:.6g}", scene.scale);
  return fmt::format("{} in {}: {}{}{}", scene.sizes_are_diameters ? "diameter" : "radius",
                     name_of(scene.unit),
                     scene.largest && is_one ? "as large as fit" : sizes_in_words(scene.sizes), scale,
                     each_once(scene.sizes)          ? ""
                     : scene.draw == Draw::quantiles ? "; drawn by quantiles"
                                                     : "");
}

std::string cells_in_words(const PackedCells& cells) {
  const auto& median = cells.quantiles[cells.quantiles.size() / 2];
  return fmt::format(
      "median volume {:.4g}, {:.4g} wanted; Kolmogorov distance {:.2g}, {:.2g} by the radii alone; mean "
      "sphericity {:.3f}; {} Newton step{}",
      median.reached, median.wanted, cells.distance, cells.distance_by_radii, cells.mean_sphericity,
      cells.steps, cells.steps == 1 ? "" : "s");
}

std::string amount_in_words(const Scene& scene, double diameter, bool are_equal, std::uint64_t count) {
  const Target& target = scene.target;
  const double density = scene.material_density.value_or(0);
  if (target.mass_counted)
    return fmt::format(
        "{:.6g} kg of {} in spheres {} {:.4g} {}: {} sphere{}", *target.mass_counted,
        layers_have_densities(scene) ? std::string("their layers") : fmt::format("{:.6g} kg/m3", density),
        are_equal ? "of" : "whose mean volume is that of", diameter, name_of(scene.unit), grouped(count),
        count == 1 ? "" : "s");
  if (target.bulk_density_asked)
    return fmt::format("{:.6g} kg/m3 of spheres of {:.6g} kg/m3: {} {:.4g}", *target.bulk_density_asked,
                       density, target.bed.porosity ? "porosity" : "packing fraction",
                       target.bed.porosity ? *target.bed.porosity : target.packing_fraction.value_or(0));
  return {};
}

std::string describe_target(const Plan& plan) {
  const Scene& scene = plan.scene;
  std::string fraction;
  const std::string amount =
      amount_in_words(scene, 2 * std::cbrt(plan.radii->moment(3)), plan.radii->min() == plan.radii->max(),
                      static_cast<std::uint64_t>(scene.target.count.value_or(0)));
  if (!amount.empty()) return amount;
  if (scene.target.packing_fraction)
    fraction = fmt::format("packing fraction {}{}", *scene.target.packing_fraction,
                           scene.target.predicted ? ", the predicted one less its error" : "");
  if (scene.target.count) {
    const std::string count = grouped(static_cast<std::uint64_t>(*scene.target.count));
    return fraction.empty() ? count : count + " at " + fraction;
  }
  if (!fraction.empty()) return "up to " + fraction;
  if (scene.target.fill) return "as many as can be made to fit";
  if (const BedTarget& bed = plan.scene.target.bed; bed.gives_height())
    return fmt::format("as many as make a bed {:.6g} {} high{}", bed.above_ground, name_of(plan.scene.unit),
                       bed.layers ? fmt::format(", {:g} mean diameters of {:.4g}", *bed.layers,
                                                bed.above_ground / *bed.layers)
                                  : "");
  return plan.places_expected ? "as many as are expected to fit" : "as many as fit";
}

}  // namespace bernal
