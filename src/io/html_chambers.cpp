#include <algorithm>

#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "io/html_text.hpp"
#include "io/page.hpp"

namespace bernal {
namespace {

constexpr std::size_t most_rows = 20;

void write_table(Page& page, const Chambers& found, const std::string& unit) {
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

}  // namespace

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
  if (n > 1) write_table(page, *found, unit);
  if (found->misplaced > 0)
    page.add("<p class=\"dim\">Spheres that stick out and so are in no chamber: {}.</p>\n",
             grouped(found->misplaced));
}

}  // namespace bernal
