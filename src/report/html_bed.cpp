// Height and porosity of a bed, and whether it rests.
#include <string>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "report/chart.hpp"
#include "report/page.hpp"
#include "viewer/html.hpp"

namespace bernal {
namespace {

void write_rest(Page& page, const Rest& rest, const std::string& unit) {
  if (rest.held_by_friction > 0)
    page.row("held by friction", grouped(rest.held_by_friction),
             fmt::format("which would roll without it; an angle of {:.3g} degrees holds all of them",
                         rest.friction));
  if (rest.unsettled == 0 && rest.held_by_friction > 0) return;
  if (rest.unsettled == 0) {
    page.row("not at rest", "0",
             "every sphere rests: with all others held it can neither fall nor roll down");
    return;
  }
  page.row("not at rest", grouped(rest.unsettled),
           "spheres that can fall or roll down, with all others held");
  if (rest.hanging > 0)
    page.row("hanging", grouped(rest.hanging),
             fmt::format("of these; the farthest could fall {:.3g} {}", rest.farthest, unit));
}

}  // namespace

std::string below_level(const Report& report) {
  const std::optional<BedProfile>& bed = report.measured.bed;
  if (!bed || !bed->level) return {};
  return fmt::format(", of the bed below {:.4g} {}", *bed->level,
                     escaped(name_of(report.packing.scene.unit)));
}

std::string short_rest_text(const Rest& rest) {
  if (rest.unsettled == 0 && rest.held_by_friction > 0)
    return fmt::format("every sphere rests, {} by friction", grouped(rest.held_by_friction));
  return rest.unsettled == 0 ? "every sphere rests"
                             : fmt::format("{} sphere{} not at rest", grouped(rest.unsettled),
                                           rest.unsettled == 1 ? " is" : "s are");
}

void write_bed(Page& page, const Report& report) {
  const std::optional<BedProfile>& bed = report.measured.bed;
  if (!bed) return;
  const std::string unit = escaped(name_of(report.packing.scene.unit));
  page.add(
      "<h2>The bed</h2>\n<p>The packing fraction over the height above the lowest point of the container. "
      "The "
      "dashed line is the mean height of the surface: the highest point of a sphere over each cell of a "
      "grid, "
      "half a mean diameter wide, {:.3g} {}.{}</p>\n",
      0.5 * bed->mean_diameter, unit,
      bed->level
          ? fmt::format(" Porosity over the distance from the wall and pores, further down, are those of the "
                        "bed below {:.4g} {}, without the empty part above; packing fraction and chambers "
                        "are those of the whole container.",
                        *bed->level, unit)
      : bed->covered < BedProfile::well_covered
          ? fmt::format(" It covers less than {:g} % of the cross-section and so has no level: porosity over "
                        "the distance from the wall, pores and g(r) are those of the whole container, air "
                        "included.",
                        100 * BedProfile::well_covered)
          : "");
  page.add("<div class=\"pair\"><div>{}</div><div class=\"wide\"><table>\n", bed_chart(*bed, unit));
  page.row("height", fmt::format("{:.4g}", bed->height),
           fmt::format("in {}, the mean of the surface; the highest point is at {:.4g}", unit, bed->highest));
  page.row("roughness", fmt::format("{:.3g}", bed->roughness),
           fmt::format("in {}, root mean square of the surface about its mean", unit));
  if (bed->covered < 1)
    page.row("covered", fmt::format("{:.1f} %", 100 * bed->covered),
             "of the cross-section; where no sphere stands there is no surface");
  page.row("porosity", fmt::format("{:.4f} ± {:.4f}", bed->porosity, bed->porosity_error),
           "of what is below the surface, floor and top included");
  if (bed->core)
    page.row("core", fmt::format("{:.4f}", bed->core->porosity),
             fmt::format("porosity from {:.4g} to {:.4g} {}, {:g} mean diameters from floor and surface",
                         bed->core->from, bed->core->to, unit, BedProfile::core_depth));
  write_rest(page, bed->rest, unit);
  page.raw("</table></div></div>\n");
}

}  // namespace bernal
