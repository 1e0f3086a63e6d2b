#include "bernal/core/text.hpp"
#include "io/chart.hpp"
#include "io/html_text.hpp"
#include "io/page.hpp"

namespace bernal {
namespace {

void write_profile(Page& page, const WallProfile& profile, const std::string& unit) {
  page.row("mean porosity", fmt::format("{:.4f}", profile.mean_porosity),
           "the dashed line; the mean of the layers, weighted with their volumes");
  page.row("near the wall", fmt::format("{:.4f}", profile.near_wall_packing_fraction),
           "packing fraction within a mean diameter of it");
  page.row(
      "core", fmt::format("{:.4f} ± {:.4f}", profile.core_packing_fraction, profile.core_packing_error),
      profile.has_core
          ? fmt::format("packing fraction farther than {:g} mean diameters from it", WallProfile::core_depth)
          : fmt::format("packing fraction farther than {:.3g} {} from it: the container is too narrow "
                        "for a core, this is its deeper half",
                        profile.core_from, unit));
  if (profile.first_minimum)
    page.row("first minimum", fmt::format("{:.3f}", profile.first_minimum->porosity),
             fmt::format("the least porosity, {:.2f} mean diameters from the wall",
                         profile.first_minimum->z / profile.mean_diameter));
  if (profile.segregation)
    page.row("size near the wall",
             fmt::format("{:.3f} ± {:.3f}", profile.segregation->volume_ratio, profile.segregation->error),
             "mean volume of the spheres there over that of all; the error is that of chance");
}

void write_order(Page& page, const BondOrder& order) {
  const auto row = [&page](std::string_view name, const BondOrder::Count& count, std::string_view what) {
    if (count.spheres > 0)
      page.row(name, fmt::format("{:.2f} %", 100 * count.fraction()),
               fmt::format("of the {} spheres{}", grouped(count.spheres), what));
  };
  row("crystalline", order.all,
      "; up to about one per cent of a random packing of equal spheres looks so by chance");
  if (order.near_wall) row("near the wall", *order.near_wall, " that a mean diameter or less parts from it");
  if (order.core) row("in the core", *order.core, " whose centres are there");
}

}  // namespace

void write_walls(Page& page, const Report& report) {
  const std::optional<WallProfile>& walls = report.measured.walls;
  const std::optional<BondOrder>& order = report.measured.order;
  if (report.packing.spheres.empty() || (!walls && !order)) return;
  page.raw(walls ? "<h2>From the wall to the core</h2>\n" : "<h2>Order</h2>\n");
  if (walls) {
    const std::string chart = wall_chart(*walls);
    page.add(
        "<p>The porosity at a distance from the wall: of all that is so far from the nearest piece of wall, "
        "the share that no sphere fills{}. Lengths are in mean diameters, of {:.4g} {}.</p>\n",
        chart.empty() ? "" : ". The band is its standard error", walls->mean_diameter,
        escaped(name_of(report.packing.scene.unit)));
    page.add("<div class=\"pair\"><div>{}</div><div class=\"wide\"><table>\n", chart);
    write_profile(page, *walls, escaped(name_of(report.packing.scene.unit)));
    page.raw("</table></div></div>\n");
  }
  if (!order) return;
  page.add(
      "<p>A sphere counts as crystalline where its neighbours lie as those of its neighbours do: at least {} "
      "and {:g} % of its bonds have bond order vectors q<sub>6</sub> whose product is above {:g}. Neighbours "
      "are nearer than {:g} times the sum of the radii.</p>\n<div class=\"wide\"><table>\n",
      BondOrder::fewest_solid, 100 * BondOrder::solid_share, BondOrder::solid_bond,
      1 + BondOrder::widest_gap);
  write_order(page, *order);
  page.raw("</table></div>\n");
}

}  // namespace bernal
