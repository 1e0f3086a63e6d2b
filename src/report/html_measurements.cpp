#include <algorithm>
#include <cmath>

#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "report/chart.hpp"
#include "report/page.hpp"
#include "viewer/html.hpp"

namespace bernal {
namespace {

void write_backbone(Page& page, const Contacts& c, bool walls) {
  page.row("backbone", grouped(c.backbone), "spheres that are no rattlers");
  page.row("contacts of the backbone", grouped(c.backbone_contacts()),
           fmt::format("a coordination of {:.3f}{}", c.backbone_coordination,
                       walls ? fmt::format("; {} are with the wall", grouped(c.backbone_walls)) : ""));
  const double ratio = static_cast<double>(c.backbone_contacts()) / static_cast<double>(*c.isostatic);
  page.row("isostatic", grouped(*c.isostatic),
           fmt::format("contacts would just hold the backbone; there are {:.3g} % {}",
                       100 * std::abs(ratio - 1), ratio < 1 ? "fewer" : "more"));
}

void write_by_gap(Page& page, const Measurements& measured) {
  page.raw(
      "<div class=\"wide\"><table><caption>How the counts depend on the gap that counts as touching</caption>"
      "<tr><th>gap</th><th class=\"n\">contacts</th><th class=\"n\">coordination</th>"
      "<th class=\"n\">rattlers</th><th class=\"n\">backbone contacts</th>");
  const auto& core = measured.core_contacts;
  page.raw(core ? "<th class=\"n\">coordination in the core</th></tr>\n" : "</tr>\n");
  for (std::size_t k = 0; k < measured.by_gap.size(); ++k) {
    const Contacts& c = measured.by_gap[k];
    page.add(
        "<tr><td>{:.0e}</td><td class=\"n\">{}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td>",
        c.contact_gap, grouped(c.pairs), c.coordination, measured.holds(c) ? grouped(c.rattlers) : "–",
        measured.holds(c) ? grouped(c.backbone_contacts()) : "–");
    if (core) page.add("<td class=\"n\">{:.3f}</td>", core->by_gap[k].coordination);
    page.raw("</tr>\n");
  }
  page.raw("</table></div>\n");
}

void write_radial(Page& page, const RadialDistribution& radial) {
  page.add("<h2>Where the neighbours are</h2>\n<div class=\"pair\"><div>{}</div><div>\n",
           radial_chart(radial));
  page.raw(
      "<p>The radial distribution function g(r): how many centres lie at a distance from a centre, compared "
      "with as many spread by chance");
  if (!radial.share.empty()) page.raw(" a mean diameter or more off the walls, and in a bed below its level");
  page.raw(". The band is the standard error.</p>\n");
  if (!radial.peaks.empty()) {
    page.raw("<table><tr><th>peak at, in mean diameters</th><th class=\"n\">g</th></tr>\n");
    for (const auto& peak : radial.peaks)
      page.add("<tr><td>{:.2f} ± {:.2f}</td><td class=\"n\">{:.2f} ± {:.2f}</td></tr>\n",
               peak.r / radial.mean_diameter, 0.5 * radial.bin_width / radial.mean_diameter, peak.g,
               peak.error);
    page.raw("</table>\n");
  }
  page.raw("</div></div>\n");
}

void write_size_correlation(Page& page, const SizeCorrelation& correlation) {
  page.add("<h2>Whether like sizes lie together</h2>\n<div class=\"pair\"><div>{}</div><div>\n",
           size_correlation_chart(correlation));
  page.raw(
      "<p>The correlation C(d) of the sizes of two spheres whose centres are the distance d apart: 0 where "
      "they know nothing of each other, positive far out where like sizes gather. Near by it swings by "
      "itself, for what touches is as far apart as its sizes say, and that of neighbours is somewhat below "
      "0: hold these against another packing of the same sizes. The band, and errors, are those of sizes put "
      "on the places by chance.</p>\n<div class=\"wide\"><table>\n");
  const auto row = [&](const std::string& of, double c, double error, const std::string& what) {
    page.row(of, fmt::format("{:+.4f} ± {:.4f}", c, error), what);
  };
  if (correlation.neighbours)
    row("neighbours", correlation.neighbours->correlation, correlation.neighbours->error,
        fmt::format("nearer than {:g} times the sum of the radii", 1 + BondOrder::widest_gap));
  for (const auto& [from, to] : size_correlation_ranges)
    if (const auto mean = correlation.mean_between(from, to))
      row(fmt::format("{:g} to {:g}", from, to), mean->c, mean->error, "mean diameters apart");
  page.raw("</table></div></div></div>\n");
}

constexpr std::size_t most_rows = 20;  ///< of chambers

void write_chamber_table(Page& page, const Chambers& found, const std::string& unit) {
  page.add(
      "<div class=\"wide\"><table><tr><th class=\"n\">share of the container</th><th class=\"n\">spheres</th>"
      "<th class=\"n\">packing fraction</th><th class=\"n\">clearance ({0})</th><th>at the place ({0})"
      "</th></tr>\n",
      unit);
  const std::size_t rows = std::min(found.chambers.size(), most_rows);
  for (std::size_t k = 0; k < rows; ++k) {
    const Chambers::Chamber& chamber = found.chambers[k];
    page.add(
        "<tr><td class=\"n\">{:.2f} ± {:.2f} %</td><td class=\"n\">{}</td><td class=\"n\">{:.4f}</td>"
        "<td class=\"n\">{:.4g}</td><td>{:.4g}</td></tr>\n",
        100 * chamber.share, 100 * chamber.share_error, grouped(chamber.spheres), chamber.packing_fraction,
        chamber.clearance, fmt::join(chamber.position, ", "));
  }
  page.raw("</table></div>\n");
  if (found.chambers.size() > rows)
    page.add("<p class=\"dim\">And {} smaller ones.</p>\n", grouped(found.chambers.size() - rows));
}

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

/// The side of a column alone, and how its ends compare.
void write_column(Page& page, const ColumnProfile& column, const Report& report) {
  if (!column.side) return;
  const WallProfile& side = column.side->profile;
  page.add(
      "<h2>From the side of the column inwards</h2>\n<p>The same for the side walls alone, between {:.4g} "
      "and "
      "{:.4g} {} above the floor: the ends are left out.</p>\n<div class=\"pair\"><div>{}</div><div "
      "class=\"wide\"><table>\n",
      column.side->from, column.side->to, escaped(name_of(report.packing.scene.unit)), wall_chart(side));
  const auto row = [&](std::string_view of, const std::optional<WallProfile::Minimum>& least) {
    if (least)
      page.row(of, fmt::format("{:.3f}", least->porosity),
               fmt::format("the least porosity, {:.2f} mean diameters from there",
                           least->z / column.mean_diameter));
  };
  row("first minimum at the side", side.first_minimum);
  row("first minimum at the floor", column.floor_minimum);
  row("first minimum at the lid", column.lid_minimum);
  page.row("mean porosity", fmt::format("{:.4f}", side.mean_porosity), "between these heights");
  page.raw("</table></div></div>\n");
}

void write_order(Page& page, const BondOrder& order) {
  const auto row = [&page](std::string_view name, const BondOrder::Count& count, std::string_view what) {
    if (count.spheres > 0)
      page.row(name, fmt::format("{:.2f} %", 100 * count.fraction()),
               fmt::format("of the {} spheres{}", grouped(count.spheres), what));
  };
  if (order.all.spheres > 0)
    page.row("mean q<sub>6</sub>", fmt::format("{:.4f} ± {:.4f}", order.mean_q6, order.q6_error),
             "the bond order of a sphere by itself: 0.574 in fcc, 0.485 in hcp");
  row("crystalline", order.all, "; of a random packing of equal spheres one to three per cent look so");
  if (order.near_wall) row("near the wall", *order.near_wall, " that a mean diameter or less parts from it");
  if (order.core) row("in the core", *order.core, " whose centres are there");
}

}  // namespace

void write_contacts(Page& page, const Report& report) {
  const Contacts& c = report.measured.contacts;
  const bool walls = has_walls(report.packing.domain);
  page.add(
      "<h2>Contacts</h2>\n<p>Two spheres count as touching when the gap between them is below {:g} times the "
      "sum of their radii{}{}.</p>\n",
      c.contact_gap,
      walls ? fmt::format("; a sphere and the wall when it is below {:g} of the radius", c.contact_gap) : "",
      report.packing.scene.asks_for_gaps()
          ? "; here that is beyond the gap that the scene asks for, half of which counts as each sphere’s"
          : "");
  page.raw("<div class=\"pair\"><div class=\"wide\"><table>\n");
  page.row("between spheres", grouped(c.pairs), "pairs that touch");
  if (walls)
    page.row("with the wall", grouped(c.walls), "counted once for each face, edge or corner that is touched");
  page.row("coordination", fmt::format("{:.3f}", c.coordination),
           "how many spheres touch a sphere, on average");
  const Measurements& measured = report.measured;
  if (const auto& core = measured.core_contacts)
    page.row("coordination in the core", fmt::format("{:.3f}", core->by_gap.back().coordination),
             fmt::format("of {} spheres, {}", grouped(core->spheres),
                         measured.walls->has_core ? fmt::format("{:g} mean diameters or more from the walls",
                                                                WallProfile::core_depth)
                                                  : "in the deeper half: it is too narrow for a core"));
  if (measured.holds(c)) {
    page.row(
        "rattlers", grouped(c.rattlers),
        fmt::format("spheres that fewer than {} contacts hold, taken out one after the other until none is "
                    "left",
                    report.packing.spheres.dimension() + 1));
    write_backbone(page, c, walls);
  } else if (!report.packing.spheres.empty()) {
    page.row("rattlers", "–",
             "they tell nothing at this gap: fewer than half of the spheres hold each other");
  }
  // No stage that polishes works on discs between walls.
  const std::string remedy = report.packing.spheres.dimension() == 2 && !is_periodic(report.packing.domain)
                                 ? ""
                                 : "; contacts are closed by \"polish\" of relax and grow";
  if (measured.held_from)
    page.row("contacts tell from", fmt::format("{:g}", *measured.held_from),
             "the least gap of those in the table at which half of the spheres hold each other" + remedy);
  else if (!report.packing.spheres.empty())
    page.row("contacts tell from", "–",
             "at no gap in the table do half of the spheres hold each other" + remedy);
  page.raw("</table></div>\n");
  write_by_gap(page, report.measured);
  page.raw("</div>\n");
  if (report.measured.radial) write_radial(page, *report.measured.radial);
  if (report.measured.size_correlation) write_size_correlation(page, *report.measured.size_correlation);
}

void write_chambers(Page& page, const Report& report) {
  const std::optional<Chambers>& found = report.measured.chambers;
  if (!found) return;
  const std::string unit = escaped(name_of(report.packing.scene.unit));
  const std::size_t n = found->chambers.size();
  page.raw("<h2>Chambers</h2>\n");
  if (n == 1) {
    page.raw("<p>One: the smallest spheres can get from every place to every other. ");
  } else {
    page.add(
        "<p>There are {}: parts of the container that spheres of the smallest radius, {:.4g} {}, cannot "
        "leave, because "
        "what joins them is narrower. The packing fraction of a chamber is that of what such spheres can "
        "cover "
        "there. The search looks at cells of {:.3g} {}; necks and pockets much thinner can be missed. ",
        grouped(n), found->radius, unit, found->resolution, unit);
  }
  page.add(
      "Wedges, tips and thin parts hold {:.2f} ± {:.2f} % of the container, which no sphere of the smallest "
      "radius can cover; none of the mean radius can cover {:.2f} ± {:.2f} %.</p>\n",
      100 * found->by_smallest.share, 100 * found->by_smallest.error, 100 * found->by_mean.share,
      100 * found->by_mean.error);
  if (n > 1) write_chamber_table(page, *found, unit);
  if (found->misplaced > 0)
    page.add("<p class=\"dim\">Spheres that stick out and so are in no chamber: {}.</p>\n",
             grouped(found->misplaced));
}

void write_walls(Page& page, const Report& report) {
  const std::optional<WallProfile>& walls = report.measured.walls;
  const std::optional<BondOrder>& order = report.measured.order;
  if (report.packing.spheres.empty() || (!walls && !order)) return;
  page.raw(walls ? "<h2>From the wall to the core</h2>\n" : "<h2>Order</h2>\n");
  if (walls) {
    const std::string chart = wall_chart(*walls);
    page.add(
        "<p>The porosity at a distance from the wall: of all that is so far from the nearest piece of wall, "
        "the share that no sphere fills{}{}. Lengths are in mean diameters, of {:.4g} {}.</p>\n",
        below_level(report), chart.empty() ? "" : ". The band is its standard error", walls->mean_diameter,
        escaped(name_of(report.packing.scene.unit)));
    page.add("<div class=\"pair\"><div>{}{}</div><div class=\"wide\"><table>\n", chart,
             wall_size_chart(*walls));
    write_profile(page, *walls, escaped(name_of(report.packing.scene.unit)));
    page.raw("</table></div></div>\n");
  }
  if (report.measured.column) write_column(page, *report.measured.column, report);
  if (!order) return;
  page.add(
      "<p>A sphere counts as crystalline where its neighbours lie as those of its neighbours do: at least {} "
      "and {:g} % of its bonds have bond order vectors q<sub>6</sub> whose product is above {:g}. Neighbours "
      "are nearer than {:g} times the sum of the radii.</p>\n<div class=\"wide\"><table>\n",
      BondOrder::fewest_solid, 100 * BondOrder::solid_share, BondOrder::solid_bond,
      1 + BondOrder::widest_gap);
  write_order(page, *order);
  page.raw("</table></div>\n");
  if (order->all.spheres < report.packing.spheres.size())
    page.add("<p class=\"dim\">Looked at: {} spheres that lie together in the middle.</p>\n",
             grouped(order->all.spheres));
}

}  // namespace bernal
