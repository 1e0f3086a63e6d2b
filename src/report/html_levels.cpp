#include "bernal/core/text.hpp"
#include "bernal/scene/nest.hpp"
#include "report/page.hpp"

namespace bernal {

/// What lies inside of spheres, a level below each other.
void write_levels(Page& page, const Report& report) {
  if (report.packing.inside.empty()) return;
  page.raw(
      "<h2>Levels</h2>\n<p>Packings inside of spheres are made once each and stand for many: no file holds "
      "all "
      "of their spheres. <code>nest.json</code> says where each of them lies.</p>\n"
      "<table><tr><th>level</th><th class=\"n\">packings</th><th class=\"n\">spheres in them</th>"
      "<th class=\"n\">in so many spheres</th><th class=\"n\">spheres in all</th><th class=\"n\">ball, radius"
      "</th><th class=\"n\">packing fraction</th><th class=\"n\">of the container</th></tr>\n");
  for (const NestLevel& level : levels_of(report.packing)) {
    const bool is_inside = level.depth > 0;
    page.add(
        "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{:.5f}</td><td class=\"n\">{:.5f}</td>"
        "</tr>\n",
        escaped(is_inside ? "inside " + level.name : level.name), grouped(level.packings),
        grouped(level.packed), is_inside ? grouped(level.filled) : std::string(), grouped(level.spheres),
        is_inside ? escaped(fmt::format("{:.6g} {}", level.ball, name_of(level.unit))) : std::string(),
        level.packing_fraction, level.share);
  }
  page.raw("</table>\n");
}

}  // namespace bernal
