// Local packing fractions, structure factor, pore sizes.
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "report/chart.hpp"
#include "report/page.hpp"
#include "viewer/html.hpp"

namespace bernal {
namespace {

void write_local_packing(Page& page, const LocalPacking& local) {
  const std::string chart = local_packing_chart(local);
  page.add("<h2>How densely each sphere is packed</h2>\n<div class=\"pair\"><div>{}</div><div>\n",
           chart.empty() ? "<p class=\"dim\">All to the same.</p>" : chart);
  page.raw(
      "<p>The local packing fraction of a sphere: its volume over that of its cell, which is all that is "
      "nearer to it than to any other by the power distance |p − c|² − r². The cells of all spheres fill the "
      "domain; a sphere has more volume than its cell only where it overlaps others.</p>\n<div "
      "class=\"wide\"><table>\n");
  page.row("mean",
           local.ids.empty() ? fmt::format("{:.4f}", local.mean)
                             : fmt::format("{:.4f} ± {:.4f}", local.mean, local.mean_error),
           (local.ids.empty() ? "over the spheres"
                              : fmt::format("over {} spheres, evenly spread", grouped(local.ids.size()))) +
               (chart.empty() ? "" : "; the dashed line"));
  page.row("standard deviation", fmt::format("{:.4f}", local.deviation), "");
  for (const auto& [share, phi] : local.quantiles)
    if (share == 0.05 || share == 0.5 || share == 0.95)
      page.row(share == 0.5 ? "median" : fmt::format("{:g} % below", 100 * share), fmt::format("{:.4f}", phi),
               "");
  page.row("neighbours", fmt::format("{:.2f}", local.mean_neighbours),
           "faces that a cell shares with others, on average");
  if (local.empty > 0)
    page.row("without a cell", grouped(local.empty), "spheres that are hidden in others, or outside");
  page.raw("</table></div></div></div>\n");
}

void write_structure_factor(Page& page, const StructureFactor& factor) {
  page.add("<h2>How waves are scattered</h2>\n<div class=\"pair\"><div>{}</div><div>\n",
           structure_chart(factor));
  page.add(
      "<p>The structure factor S(k) of the centres over the wave number k times the mean diameter: 1 where "
      "centres are spread by chance; small at small k where every large part of the packing holds nearly as "
      "many. Of {} wave vectors that the box allows; the band is the standard error.</p>\n"
      "<div class=\"wide\"><table>\n",
      grouped(factor.references));
  if (const auto peak = factor.peak())
    page.row("highest peak", fmt::format("{:.2f} ± {:.2f}", peak->s, peak->error),
             fmt::format("at k d = {:.2f}", peak->k * factor.mean_diameter));
  page.row("smallest k", fmt::format("{:.2g} ± {:.1g}", factor.s.front(), factor.error.front()),
           fmt::format("S at k d = {:.2f}, of the longest waves that the box allows",
                       factor.k.front() * factor.mean_diameter));
  page.raw("</table></div></div></div>\n");
}

void write_pore_sizes(Page& page, const PoreSizes& pores, std::string_view unit, bool walls,
                      const std::string& where) {
  page.add("<h2>How large the pores are</h2>\n<div class=\"pair\"><div>{}</div><div>\n", pore_chart(pores));
  page.add(
      "<p>From points in the pores{}, how far it is to the nearest sphere{}. P(d) is the density of these "
      "distances, in mean diameters; the band is its standard error.</p>\n<div class=\"wide\"><table>\n",
      where, walls ? " or wall" : "");
  const std::string in = fmt::format("in {}", unit);
  page.row("mean", fmt::format("{:.4g} ± {:.1g}", pores.mean, pores.mean_error), in);
  page.row("root mean square", fmt::format("{:.4g}", std::sqrt(pores.second_moment)), in);
  for (const auto& [share, distance] : pores.quantiles)
    if (share == 0.5 || share == 0.95)
      page.row(share == 0.5 ? "median" : fmt::format("{:g} % below", 100 * share),
               fmt::format("{:.4g}", distance), in);
  page.row("largest seen", fmt::format("{:.4g}", pores.largest),
           fmt::format("{}, from {} points in pores", in, grouped(pores.in_pores)));
  page.raw("</table></div></div></div>\n");
}

}  // namespace

/// Measurements left out for very many spheres and for stopped runs.
void write_omissions(Page& page, const Report& report) {
  const Measurements& measured = report.measured;
  const int dimension = report.packing.spheres.dimension();
  if (report.packing.spheres.empty() || dimension < 2 || dimension > 3) return;
  if (!measured.left_out.empty()) {
    page.add("<p class=\"dim\">Not measured in a tilted box: {}.</p>\n", fmt::join(measured.left_out, ", "));
    return;
  }
  std::vector<std::string_view> left;
  if (!measured.local) left.push_back("local packing fractions");
  if (measured.local && !measured.local->ids.empty()) left.push_back("that of every single sphere");
  if (!measured.pores) left.push_back("sizes of pores");
  if (!measured.structure && !has_walls(report.packing.domain) && report.packing.spheres.size() > 1)
    left.push_back("the structure factor");
  if (!left.empty())
    page.add("<p class=\"dim\">Left to <code>bernal measure</code> on this folder: {}.</p>\n",
             fmt::join(left, ", "));
}

void write_structure(Page& page, const Report& report) {
  const Measurements& measured = report.measured;
  if (measured.local && measured.local->empty < measured.local->cell_volume.size())
    write_local_packing(page, *measured.local);
  if (measured.pores && measured.pores->in_pores > 0)
    write_pore_sizes(page, *measured.pores, escaped(name_of(report.packing.scene.unit)),
                     has_walls(report.packing.domain), below_level(report));
  if (measured.structure) write_structure_factor(page, *measured.structure);
  write_omissions(page, report);
}

}  // namespace bernal
