#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/chart.hpp"
#include "io/html_text.hpp"
#include "io/report.hpp"
#include "io/report_style.hpp"

namespace bernal {
namespace {

/// Text that grows; `add` formats, `raw` does not.
class Page {
 public:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
  }
  void raw(std::string_view text) { text_ += text; }

  void card(std::string_view value, std::string_view name, std::string_view what,
            std::string_view style = "") {
    add("<div class=\"card\"><span class=\"dim\">{}</span><b class=\"{}\">{}</b><small>{}</small></div>\n",
        name, style, value, what);
  }
  /// One row of a table of name, value and explanation.
  void row(std::string_view name, std::string_view value, std::string_view what) {
    add("<tr><td>{}</td><td class=\"n\">{}</td><td class=\"dim\">{}</td></tr>\n", name, value, what);
  }
  std::string finish() && { return std::move(text_); }

 private:
  std::string text_;
};

std::string_view domain_name(const Domain& domain) {
  return std::holds_alternative<PeriodicBox>(domain) ? "periodic box" : kind_of(domain);
}

std::string seconds_text(double seconds) {
  return seconds < 100
             ? fmt::format("{:.3g} s", seconds)
             : fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60), std::fmod(seconds, 60));
}

/// Radii or diameters, whichever word the scene used; in ascending order.
struct Sizes {
  std::vector<double> values;
  std::string_view word;
};

Sizes sizes_of(const Packing& packing) {
  const bool diameters = packing.scene.sizes_are_diameters;
  Sizes sizes{packing.spheres.r, diameters ? "diameter" : "radius"};
  for (double& value : sizes.values) value *= diameters ? 2 : 1;
  std::sort(sizes.values.begin(), sizes.values.end());
  return sizes;
}

void write_headline(Page& page, const Report& report) {
  const Packing& packing = report.packing;
  const bool certified = report.certificate.certified;
  page.raw("<div class=\"cards\">\n");
  page.card(grouped(packing.spheres.size()), "Spheres",
            fmt::format("{}: {}", name_of(packing.outcome), escaped(packing.reason)));
  page.card(fmt::format("{:.4f}", packing.packing_fraction()), "Packing fraction",
            "the share of the container’s volume that is sphere");
  page.card(certified ? "yes" : "no", "Certified",
            certified ? "no overlap, nothing sticks out; proven on the written file"
                      : "see the certificate below for what is wrong",
            certified ? "yes" : "no");
  page.card(seconds_text(packing.seconds), "Time",
            fmt::format("{} thread{}", packing.threads, packing.threads == 1 ? "" : "s"));
  page.raw("</div>\n");
  page.add("<p class=\"statement{}\">{}</p>\n", certified ? "" : " failed",
           escaped(report.certificate.statement));
}

void write_scene(Page& page, const Report& report, std::string_view scene) {
  const Packing& packing = report.packing;
  const std::string unit = escaped(packing.scene.unit);
  const Vector<dynamic> extent = extent_of(packing.domain);
  page.add("<h2>What was asked</h2>\n<p>A {} of volume {:.6g} {}³, {:.4g} {} over all",
           domain_name(packing.domain), packing.volume, unit, fmt::join(extent, " × "), unit);
  if (const Shape* shape = std::get_if<Shape>(&packing.domain)) {
    if (const auto* mesh = std::get_if<Mesh>(shape))
      page.add(", with {} triangles", grouped(mesh->triangles.size()));
  }
  page.add(". Seed {}. Every length is in {}.</p>\n", packing.seed, unit);
  page.add(
      "<details><summary>The scene as it was run, with every default written out</summary><pre>{}</pre>"
      "</details>\n",
      escaped(scene));
}

/// The size below which a share of the number and of the volume of the spheres lies.
void write_quantiles(Page& page, const Sizes& sizes) {
  std::vector<double> volume_below;  // in units of the largest sphere
  double sum = 0;
  for (const double value : sizes.values) {
    sum += std::pow(value / sizes.values.back(), 3);
    volume_below.push_back(sum);
  }
  page.add(
      "<table><tr><th>share below</th><th class=\"n\">{} by number</th><th class=\"n\">by volume</th></tr>\n",
      sizes.word);
  const std::size_t last = sizes.values.size() - 1;
  for (const double share : {0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0}) {
    const auto by_number = static_cast<std::size_t>(std::lround(share * static_cast<double>(last)));
    const auto found = std::ranges::lower_bound(volume_below, share * sum);
    const auto by_volume = std::min(last, static_cast<std::size_t>(found - volume_below.begin()));
    page.add("<tr><td>{}</td><td class=\"n\">{:.4g}</td><td class=\"n\">{:.4g}</td></tr>\n",
             share == 0   ? "smallest"
             : share == 1 ? "largest"
                          : fmt::format("{:g} %", 100 * share),
             sizes.values[by_number], sizes.values[by_volume]);
  }
  page.raw("</table>\n");
}

void write_classes(Page& page, const Sizes& sizes, const std::map<double, std::uint64_t>& classes) {
  double volume = 0;
  for (const auto& [size, count] : classes) volume += std::pow(size, 3) * static_cast<double>(count);
  page.add(
      "<table><tr><th>{}</th><th class=\"n\">spheres</th><th class=\"n\">% of the number</th>"
      "<th class=\"n\">% of the volume</th></tr>\n",
      sizes.word);
  for (const auto& [size, count] : classes) {
    const auto n = static_cast<double>(count);
    page.add(
        "<tr><td>{:.6g}</td><td class=\"n\">{}</td><td class=\"n\">{:.2f}</td><td "
        "class=\"n\">{:.2f}</td></tr>\n",
        size, grouped(count), 100 * n / static_cast<double>(sizes.values.size()),
        100 * std::pow(size, 3) * n / volume);
  }
  page.raw("</table>\n");
}

void write_sizes(Page& page, const Report& report) {
  const Sizes sizes = sizes_of(report.packing);
  const std::string unit = escaped(report.packing.scene.unit);
  if (sizes.values.empty()) return;
  constexpr std::size_t most_classes = 12;
  std::map<double, std::uint64_t> classes;
  for (auto v = sizes.values.begin(); v != sizes.values.end() && classes.size() <= most_classes; ++v)
    ++classes[*v];

  page.raw("<h2>Sizes</h2>\n");
  if (classes.size() == 1) {
    page.add("<p>All spheres have the {} {:.6g} {}.</p>\n", sizes.word, sizes.values.front(), unit);
  } else if (classes.size() <= most_classes) {
    page.add("<p>In {}.</p>\n", unit);
    write_classes(page, sizes, classes);
  } else {
    page.add(
        "<p>What was packed, in {0}. By number every sphere counts the same; by volume a sphere counts as "
        "much "
        "as it is large, as on a balance.</p>\n<div class=\"pair\"><div>{1}<p class=\"key dim\"><i "
        "style=\"background:var(--first)\"></i>by number<i style=\"background:var(--second)\"></i>by "
        "volume</p>"
        "</div><div>\n",
        unit, size_histogram(sizes.values, fmt::format("{} ({})", sizes.word, report.packing.scene.unit)));
    write_quantiles(page, sizes);
    page.raw("</div></div>\n");
  }
}

void write_contacts(Page& page, const Report& report) {
  const Contacts& c = report.measured.contacts;
  page.add(
      "<h2>Contacts</h2>\n<p>Two spheres count as touching when the gap between them is below {:g} times the "
      "sum of their radii; a sphere and the wall when it is below {:g} of the radius.</p>\n<table>\n",
      c.contact_gap, c.contact_gap);
  page.row("between spheres", grouped(c.pairs), "pairs that touch");
  page.row("with the wall", grouped(c.walls), "counted once for each face, edge or corner that is touched");
  page.row("coordination", fmt::format("{:.3f}", c.coordination),
           "how many spheres touch a sphere, on average");
  page.row(
      "rattlers", grouped(c.rattlers),
      "spheres that fewer than four contacts hold, taken out one after the other until none is left; where "
      "nothing is wedged in, as in a bed that was only let settle, that can be nearly all");
  page.raw("</table>\n");
}

void write_history(Page& page, const Report& report) {
  const Packing& packing = report.packing;
  if (packing.history.size() >= 2) {
    page.add("<h2>How the run went</h2>\n<div class=\"pair\"><div>{}</div><div>{}</div></div>\n",
             history_chart(packing.history, &Milestone::packing_fraction, "packing fraction"),
             history_chart(packing.history, &Milestone::potential,
                           fmt::format("mean height of the spheres ({})", packing.scene.unit)));
    page.raw(
        "<p class=\"dim\">The height is measured against the direction in which the spheres are pushed; it "
        "falls as "
        "they settle and rises as new ones are put on top.</p>\n");
  }
  if (packing.effects.empty()) return;
  page.raw(
      "<h2>What the time went into</h2>\n<p>Only what the scene calls for is built and run. Entries may "
      "contain "
      "each other.</p>\n<div class=\"wide\"><table><tr><th>effect</th><th class=\"n\">calls</th>"
      "<th class=\"n\">seconds</th></tr>\n");
  for (const Effect& effect : packing.effects) {
    page.add("<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{:.3f}</td></tr>\n", escaped(effect.name),
             grouped(effect.calls), effect.seconds);
  }
  page.raw("</table></div>\n");
}

void write_certificate(Page& page, const Report& report) {
  const Certificate& c = report.certificate;
  const bool walls = std::holds_alternative<Shape>(report.packing.domain);
  page.raw(
      "<h2>The certificate</h2>\n<p>After writing, <code>spheres.csv</code> was read back, and every "
      "question of "
      "the kind “do these two overlap?” or “does this sphere cross this piece of wall?” was decided for the "
      "numbers as they stand in the file: in ordinary arithmetic where its rounding error provably cannot "
      "change "
      "the answer, in exact arithmetic everywhere else. Touching is allowed.</p>\n<div "
      "class=\"wide\"><table>\n");
  page.row("pairs of spheres", grouped(c.pairs_tested), "near enough to need a decision");
  if (walls) {
    page.row("spheres and pieces of wall", grouped(c.walls_tested), "near enough to need a decision");
    page.row("centres", grouped(c.centers_tested), "whose side of the wall was decided");
  }
  page.row("decided in ordinary arithmetic", grouped(c.decided_double), "with a proven error bound");
  page.row("decided in exact arithmetic", grouped(c.decided_exact), "where the bound was not enough");
  page.row("overlapping pairs", grouped(c.overlapping_pairs), "");
  if (walls) page.row("spheres that stick out", grouped(c.protruding_spheres), "");
  if (c.worst_pair) {
    page.row("closest pair", fmt::format("{:.3g}", -c.max_overlap),
             fmt::format("its gap over the sum of its radii; spheres {}, counted from 0", worst_pair_text(c)));
  }
  if (c.worst_wall) {
    page.row("closest to the wall", fmt::format("{:.3g}", c.min_wall_gap),
             fmt::format("gap over radius; sphere {}, counted from 0", *c.worst_wall));
  }
  page.row("time", seconds_text(c.seconds), "");
  page.raw("</table></div>\n<p class=\"dim\">To repeat it: <code>bernal verify</code> on this folder.</p>\n");
}

}  // namespace

std::string html_of(const Report& report, std::string_view picture, std::string_view scene) {
  const Packing& packing = report.packing;
  std::string title =
      fmt::format("{} spheres in a {}", grouped(packing.spheres.size()), domain_name(packing.domain));
  if (packing.scene.container.has("file")) {
    title += ", " + std::filesystem::path(packing.scene.container.text("file")).filename().string();
  }
  Page page;
  page.add(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>{}</title>\n<style>",
      escaped(title));
  page.raw(report_style);
  page.add("</style></head>\n<body><main>\n<h1>{}</h1>\n<span class=\"dim\">packed by bernal {}</span>\n",
           escaped(title), escaped(packing.version));
  write_headline(page, report);
  page.raw("<div class=\"picture\">\n");
  page.raw(picture);
  page.raw("</div>\n");
  write_scene(page, report, scene);
  write_sizes(page, report);
  write_contacts(page, report);
  write_history(page, report);
  write_certificate(page, report);
  page.add(
      "<p class=\"dim\">bernal {} · seed {} · hash of the spheres <code>{}</code>: the same scene, seed and "
      "version give the same hash on every machine.</p>\n</main></body></html>\n",
      escaped(packing.version), packing.seed, report.hash);
  return std::move(page).finish();
}

}  // namespace bernal
