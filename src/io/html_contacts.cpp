#include <cmath>

#include "bernal/core/text.hpp"
#include "io/chart.hpp"
#include "io/html_text.hpp"
#include "io/page.hpp"

namespace bernal {
namespace {

void write_backbone(Page& page, const Contacts& c) {
  page.row("backbone", grouped(c.backbone), "spheres that are no rattlers");
  page.row("contacts of the backbone", grouped(c.backbone_pairs),
           fmt::format("a coordination of {:.3f}", c.backbone_coordination));
  if (!c.isostatic) return;
  const double ratio = static_cast<double>(c.backbone_pairs) / static_cast<double>(*c.isostatic);
  page.row("isostatic", grouped(*c.isostatic),
           fmt::format("contacts would just hold the backbone; there are {:.3g} % {}",
                       100 * std::abs(ratio - 1), ratio < 1 ? "fewer" : "more"));
}

void write_by_gap(Page& page, const Measurements& measured) {
  page.raw(
      "<div class=\"wide\"><table><caption>How the counts depend on the gap that counts as touching</caption>"
      "<tr><th>gap</th><th class=\"n\">contacts</th><th class=\"n\">coordination</th>"
      "<th class=\"n\">rattlers</th><th class=\"n\">backbone contacts</th></tr>\n");
  for (const Contacts& c : measured.by_gap) {
    page.add(
        "<tr><td>{:.0e}</td><td class=\"n\">{}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td></tr>\n",
        c.contact_gap, grouped(c.pairs), c.coordination, grouped(c.rattlers), grouped(c.backbone_pairs));
  }
  page.raw("</table></div>\n");
}

void write_radial(Page& page, const RadialDistribution& radial) {
  page.add("<h2>Where the neighbours are</h2>\n<div class=\"pair\"><div>{}</div><div>\n",
           radial_chart(radial));
  page.raw(
      "<p>The radial distribution function g(r): how many centres lie at a distance from a centre, compared "
      "with as many spread by chance. The band is the standard error of the count.</p>\n");
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

}  // namespace

void write_contacts(Page& page, const Report& report) {
  const Contacts& c = report.measured.contacts;
  const bool walls = has_walls(report.packing.domain);
  page.add(
      "<h2>Contacts</h2>\n<p>Two spheres count as touching when the gap between them is below {:g} times the "
      "sum of their radii{}.</p>\n",
      c.contact_gap,
      walls ? fmt::format("; a sphere and the wall when it is below {:g} of the radius", c.contact_gap) : "");
  page.raw("<div class=\"pair\"><div class=\"wide\"><table>\n");
  page.row("between spheres", grouped(c.pairs), "pairs that touch");
  if (walls)
    page.row("with the wall", grouped(c.walls), "counted once for each face, edge or corner that is touched");
  page.row("coordination", fmt::format("{:.3f}", c.coordination),
           "how many spheres touch a sphere, on average");
  page.row(
      "rattlers", grouped(c.rattlers),
      fmt::format(
          "spheres that fewer than {} contacts hold, taken out one after the other until none is left{}",
          report.packing.spheres.dimension() + 1,
          walls ? "; where nothing is wedged in, as in a bed that was only let settle, that can be nearly all"
                : ""));
  if (c.backbone > 0) write_backbone(page, c);
  page.raw("</table></div>\n");
  write_by_gap(page, report.measured);
  page.raw("</div>\n");
  if (report.measured.radial) write_radial(page, *report.measured.radial);
}

}  // namespace bernal
