#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/report/describe.hpp"
#include "report/chart.hpp"
#include "report/describe.hpp"
#include "report/page.hpp"
#include "report/report.hpp"
#include "report/report_style.hpp"
#include "scene/scene_entries.hpp"
#include "viewer/html.hpp"
#include "viewer/viewer_files.hpp"
#include "viewer/viewer_parts.hpp"

namespace bernal {
namespace {

/// "mm³", "mm²", and so on.
std::string volume_unit(const Packing& packing) {
  const int dimension = packing.spheres.dimension();
  const std::string unit = escaped(name_of(packing.scene.unit));
  if (dimension == 1) return unit;
  return dimension == 2   ? unit + "²"
         : dimension == 3 ? unit + "³"
                          : fmt::format("{}<sup>{}</sup>", unit, dimension);
}

std::string_view volume_word(const Packing& packing) {
  const int dimension = packing.spheres.dimension();
  return dimension == 1 ? "length" : dimension == 2 ? "area" : "volume";
}

std::string seconds_text(double seconds) {
  return seconds < 100
             ? fmt::format("{:.3g} s", seconds)
             : fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60), std::fmod(seconds, 60));
}

/// A packing that was read from its files has no plan.
std::string expected_text(const Packing& packing) {
  if (!(packing.expected_packing_fraction > 0)) return {};
  std::string text = fmt::format("; {:.3f} was expected", packing.expected_packing_fraction);
  if (packing.expected_of_sizes)
    text += fmt::format(", and the sizes that are there pack to {:.3f} at random by the rod model",
                        *packing.expected_of_sizes);
  return text;
}

void write_headline(Page& page, const Report& report) {
  const Packing& packing = report.packing;
  const bool certified = report.certificate.certified;
  const double allowed_overlap = report.certificate.allowed_overlap;
  const bool is_short = falls_short(packing.outcome);
  if (is_short)
    page.add("<p class=\"statement short\"><b>Not what was asked for.</b> The run ended as {}: {}.</p>\n",
             name_of(packing.outcome), escaped(packing.reason));
  page.raw("<div class=\"cards\">\n");
  page.card(grouped(packing.spheres.size()), "Spheres",
            is_short ? "see above how the run ended"
                     : fmt::format("{}: {}", name_of(packing.outcome), escaped(packing.reason)),
            is_short ? "short" : "");
  page.card(fmt::format("{:.4f}", packing.packing_fraction()), "Packing fraction",
            fmt::format("the share of the {}’s {} that is sphere, so that its porosity is {:.4f}{}",
                        kind_of(packing.domain) == "periodic" ? "box" : "container", volume_word(packing),
                        1 - packing.packing_fraction(), expected_text(packing)));
  if (const auto& bed = report.measured.bed)
    page.card(fmt::format("{:.3f}", bed->porosity), "Porosity of the bed",
              fmt::format("up to its surface, {:.4g} {} high; {}", bed->height,
                          escaped(name_of(packing.scene.unit)), short_rest_text(bed->rest)));
  page.card(certified ? "yes" : "no", "Certified",
            !certified ? "see the certificate below for what is wrong"
            : allowed_overlap > 0
                ? fmt::format("no overlap above {:g} of the sum of radii, which the scene allows; "
                              "nothing sticks out; proven on the written file",
                              allowed_overlap)
            : report.certificate.gap + report.certificate.wall_gap > 0
                ? "every gap is kept, nothing sticks out; proven on the written file"
                : "no overlap, nothing sticks out; proven on the written file",
            !certified ? "no"
            : is_short ? "short"
                       : "yes");
  page.card(seconds_text(packing.seconds), "Time",
            fmt::format("{} thread{}{}", packing.threads, packing.threads == 1 ? "" : "s",
                        packing.resumed == 0 ? ""
                        : packing.resumed == 1
                            ? "; went on from a checkpoint once"
                            : fmt::format("; went on from checkpoints {} times", packing.resumed)));
  page.raw("</div>\n");
  page.add("<p class=\"statement{}\">{}</p>\n",
           !certified ? " failed"
           : is_short ? " short"
                      : "",
           escaped(report.certificate.statement));
}

/// What was asked of the cells, beside what there is.
void write_cells(Page& page, const PackedCells& cells, std::string_view unit) {
  page.add(
      "<p>{}.</p>\n<table><tr><th>Share of the cells</th><th>wanted, {}³</th><th>by the radii</th>"
      "<th>reached</th></tr>\n",
      escaped(cells_in_words(cells)), escaped(unit));
  for (const auto& [share, wanted, by_radii, reached] : cells.quantiles)
    page.add("<tr><td>{:g} %</td><td>{:.4g}</td><td>{:.4g}</td><td>{:.4g}</td></tr>\n", 100 * share, wanted,
             by_radii, reached);
  page.raw("</table>\n");
}

/// The sum by which an amount became a number of spheres, and what is there.
void write_amount(Page& page, const Packing& packing) {
  const std::vector<double>& radii = packing.spheres.r;
  if (radii.empty()) return;
  const auto [least, most] = std::ranges::minmax(radii);
  const double mean = std::cbrt(3 * packing.packing_fraction() * packing.volume /
                                (4 * std::numbers::pi * static_cast<double>(radii.size())));
  const std::string amount = amount_in_words(packing.scene, 2 * mean, least == most, radii.size());
  if (!amount.empty()) page.add("<p>{}.</p>\n", escaped(amount));
  if (const auto mass = mass_of(packing, packing.packing_fraction()))
    page.add("<p>The spheres weigh {:.6g} kg{}.</p>\n", *mass,
             packing.scene.material_density
                 ? fmt::format(", of {:.6g} kg/m³ each", *packing.scene.material_density)
                 : std::string());
  if (const auto& bulk = packing.bulk_density)
    page.add("<p>Bulk density: {:.6g} kg/m³ asked, {:.6g} reached.</p>\n", bulk->asked, bulk->reached);
  if (packing.cells) write_cells(page, *packing.cells, name_of(packing.scene.unit));
}

/// What explain said before the run.
void write_remarks(Page& page, const Packing& packing) {
  if (!packing.caution.empty())
    page.add("<p class=\"statement short\"><b>Caution:</b> {}.</p>\n", escaped(packing.caution));
  for (const std::string& hint : packing.hints) page.add("<p class=\"dim\">Note: {}.</p>\n", escaped(hint));
}

void write_scene(Page& page, const Report& report, std::string_view scene) {
  const Packing& packing = report.packing;
  const std::string unit = escaped(name_of(packing.scene.unit));
  const Vector<dynamic> extent = bounds_of<dynamic>(packing.domain).size();
  const std::string_view repeated = !is_periodic(packing.domain) ? " over all"
                                    : !has_walls(packing.domain) ? ", repeated without end in all directions"
                                    : kind_of(packing.domain) == "cylinder"
                                        ? ", repeated without end along its axis"
                                        : ", repeated without end along the axes that have no walls";
  page.add("<h2>What was asked</h2>\n<p>A {} of {} {:.6g} {}, {:.4g} {}{}", name_of(packing.domain),
           volume_word(packing), packing.volume, volume_unit(packing), fmt::join(extent, " × "), unit,
           repeated);
  if (const auto* mesh = std::get_if<Mesh>(&packing.domain))
    page.add(", with {} triangles", grouped(mesh->triangles.size()));
  page.add(". Seed {}. Every length is in {}.</p>\n", packing.seed, unit);
  write_amount(page, packing);
  write_remarks(page, packing);
  page.add(
      "<details><summary>The scene as it was run, with every default written out</summary><pre>{}</pre>"
      "</details>\n",
      escaped(scene));
}

/// In relaxation overlaps vanish; in compression spheres settle; otherwise only their number changes.
void write_history(Page& page, const Packing& packing) {
  if (packing.history.size() < 2) return;
  const auto any = [&](auto is) { return std::ranges::any_of(packing.history, is); };
  const bool grown = !any([](const Milestone& m) { return m.stage != "grow"; });
  const bool relaxed = !grown && any([](const Milestone& m) { return m.max_overlap != 0; });
  const bool settled = !grown && any([](const Milestone& m) { return m.potential != 0; });
  const std::string filling =
      history_chart(packing.history, &Milestone::packing_fraction, "packing fraction");
  if (!relaxed && !settled) {
    page.add(
        "<h2>How the run went</h2>\n{}<p class=\"dim\">{}</p>\n", filling,
        grown ? "Hard spheres fly, collide and grow until they jam or are as large as asked."
              : "Spheres come from large to small, in a box of given size; those that are there make room.");
    return;
  }
  page.add("<h2>How the run went</h2>\n<div class=\"pair\"><div>{}</div><div>{}</div></div>\n", filling,
           relaxed
               ? overlap_chart(packing.history)
               : history_chart(packing.history, &Milestone::potential,
                               fmt::format("mean height of the spheres ({})", name_of(packing.scene.unit))));
  page.raw(!relaxed ? "<p class=\"dim\">The height is measured against the direction in which the spheres "
                      "are pushed; it falls as they settle and rises as new ones are put on top.</p>\n"
           : kind_of(packing.domain) == "periodic"
               ? "<p class=\"dim\">The run starts with spheres that overlap; they push each other "
                 "apart, in a box that grows or has its size already.</p>\n"
               : "<p class=\"dim\">Spheres that overlap push each other apart, and the wall pushes too. What "
                 "is stuck is shaken with larger radii or put into holes, where the overlap jumps.</p>\n");
}

void write_effects(Page& page, const Packing& packing) {
  if (packing.effects.empty()) return;
  page.raw(
      "<h2>What the time went into</h2>\n<p>Only what the scene calls for is built and run. Entries may "
      "contain each other.</p>\n<div class=\"wide\"><table><tr><th>effect</th><th class=\"n\">calls</th>"
      "<th class=\"n\">seconds</th></tr>\n");
  for (const Effect& effect : packing.effects) {
    const bool timed = effect.seconds > 0 || effect.calls == 0;
    page.add("<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n", escaped(effect.name),
             grouped(effect.calls), timed ? fmt::format("{:.3f}", effect.seconds) : "counted only");
  }
  page.raw("</table></div>\n");
}

void write_certificate(Page& page, const Report& report) {
  const Certificate& c = report.certificate;
  const bool walls = has_walls(report.packing.domain);
  const auto* mesh = std::get_if<Mesh>(&report.packing.domain);
  page.add(
      "<h2>The certificate</h2>\n<p>After writing, <code>{}</code> was read back, and every "
      "question of "
      "the kind “do these two overlap?”{}{} was decided for the numbers as they stand in the file: in "
      "ordinary "
      "arithmetic where its rounding error provably cannot change the answer, in exact arithmetic everywhere "
      "else. "
      "{}Touching is allowed.</p>\n<div class=\"wide\"><table>\n",
      report.files.contains("spheres.npy") ? "spheres.npy" : "spheres.csv",
      is_periodic(report.packing.domain) ? ", images in the neighbouring periods included," : "",
      walls ? " or “does this sphere cross this piece of wall?”" : "",
      mesh && mesh->surface ? "About the walls, which are the CAD surface, proven bounds of it decide. "
                            : "");
  page.row("pairs of spheres", grouped(c.pairs_tested), "near enough to need a decision");
  if (walls) {
    page.row("spheres and pieces of wall", grouped(c.walls_tested),
             walls_tested_are_near(report.packing.domain) ? "near enough to need a decision"
                                                          : "each sphere with each wall, however far away");
    page.row("centres", grouped(c.centers_tested), "whose side of the wall was decided");
  }
  page.row("decided in ordinary arithmetic", grouped(c.decided_double), "with a proven error bound");
  page.row("decided in exact arithmetic", grouped(c.decided_exact), "where the bound was not enough");
  page.row(
      "overlapping pairs", grouped(c.overlapping_pairs),
      c.allowed_overlap > 0 ? fmt::format("by more than {:g} of the sum of radii", c.allowed_overlap) : "");
  if (walls) page.row("spheres that stick out", grouped(c.protruding_spheres), "");
  const auto least = [](const std::optional<double>& distance) {
    return distance ? fmt::format("{:.9g}", *distance) : std::string("more than twice that");
  };
  const std::string_view unit = name_of(report.packing.scene.unit);
  if (c.gap > 0)
    page.row(
        "gap between spheres", fmt::format("{:g}", c.gap),
        fmt::format("in {}, at least, as the scene asks; the least is {}. All ratios here, and contacts, "
                    "are those of spheres with half of it around them",
                    unit, least(c.least_distance)));
  if (c.wall_gap > 0)
    page.row("gap from walls", fmt::format("{:g}", c.wall_gap),
             fmt::format("in {}, at least; the least is {}", unit, least(c.least_wall_distance)));
  if (c.worst_pair) {
    page.row(
        "closest pair", fmt::format("{:.3g}", -c.max_overlap),
        fmt::format("its gap over the sum of its radii; spheres {}, counted from 0", worst_pair_text(c)));
  }
  if (c.worst_wall) {
    page.row("closest to the wall", fmt::format("{:.3g}", c.min_wall_gap),
             fmt::format("gap over radius; sphere {}, counted from 0", *c.worst_wall));
  }
  for (const auto& [pair, ratio] : c.overlaps)
    page.row("overlap", fmt::format("{:.3g}", ratio), "of the sum of radii; spheres " + pair_text(pair));
  for (const auto& [sphere, gap] : c.protrusions)
    page.row("sticks out", fmt::format("{:.3g}", -gap), fmt::format("of its radius; sphere {}", sphere));
  page.row("time", seconds_text(c.seconds), "");
  page.raw("</table></div>\n<p class=\"dim\">To repeat it: <code>bernal verify</code> on this folder.</p>\n");
}

}  // namespace

std::string html_of(const Report& report, const Pictures& pictures, std::string_view scene) {
  const Packing& packing = report.packing;
  const SceneContainer& container = packing.scene.container;
  std::string title = fmt::format(
      "{} sphere{} in a {}", grouped(packing.spheres.size()), packing.spheres.size() == 1 ? "" : "s",
      container.obstacles.empty()
          ? name_of(packing.domain)
          : fmt::format("{} with obstacles", schema::word_of(container, packing.domain)));
  if (const auto* mesh = std::get_if<MeshFile>(&packing.scene.container))
    title += ", " + plain_text(mesh->file.filename().string());
  Page page;
  page.add(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n{}"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>{}</title>\n<style>",
      offline_policy, escaped(title));
  page.raw(report_style);
  if (!pictures.view.empty()) page.raw(viewer_style);
  page.add("</style></head>\n<body><main>\n<h1>{}</h1>\n<span class=\"dim\">packed by bernal {}</span>\n",
           escaped(title), escaped(text_of(packing.program)));
  write_headline(page, report);
  if (pictures.packing.empty()) {
    page.add("<p class=\"dim\">There is no picture of {} dimension{}.</p>\n", packing.spheres.dimension(),
             packing.spheres.dimension() == 1 ? "" : "s");
  } else {
    if (!pictures.view.empty()) write_view_frame(page);
    page.raw("<div class=\"pair\">\n");
    for (const std::string_view picture : {pictures.packing, pictures.section})
      if (!picture.empty()) page.add("<div class=\"picture\">\n{}</div>\n", picture);
    page.raw("</div>\n");
  }
  write_scene(page, report, scene);
  write_bed(page, report);
  write_sizes(page, report);
  write_layers(page, report);
  write_levels(page, report);
  write_contacts(page, report);
  write_chambers(page, report);
  write_walls(page, report);
  write_structure(page, report);
  write_history(page, report.packing);
  write_effects(page, report.packing);
  write_certificate(page, report);
  page.add(
      "<p class=\"dim\">bernal {} · seed {} · hash of the spheres <code>{}</code>: the same scene, seed and "
      "packings number give the same hash, whatever the number of threads, where C library and kind of "
      "processor are the same.</p>\n</main>\n",
      escaped(text_of(packing.program)), packing.seed, report.hash);
  std::string text = in_dimension(packing.spheres.dimension(), std::move(page).finish());
  Page end;
  if (!pictures.view.empty()) write_view_program(end, pictures.view);
  end.raw("</body></html>\n");
  return text + std::move(end).finish();
}

}  // namespace bernal
