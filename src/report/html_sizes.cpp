#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "report/chart.hpp"
#include "report/class_amounts.hpp"
#include "report/page.hpp"
#include "report/size_summary.hpp"
#include "scene/size_kinds.hpp"
#include "viewer/html.hpp"

namespace bernal {
namespace {

/// Radii or diameters, as in the scene; ascending.
struct Sizes {
  std::vector<double> values;
  std::string_view word;
  double factor;  ///< of a radius
  int dimension;

  double volume(double value) const { return std::pow(value / values.back(), dimension); }
  std::string_view volume_word() const { return dimension == 2 ? "area" : "volume"; }
};

Sizes sizes_of(const Packing& packing) {
  const bool diameters = packing.scene.sizes_are_diameters;
  Sizes sizes{packing.spheres.r, diameters ? "diameter" : "radius", diameters ? 2.0 : 1.0,
              packing.spheres.dimension()};
  for (double& value : sizes.values) value *= sizes.factor;
  std::sort(sizes.values.begin(), sizes.values.end());
  return sizes;
}

std::string asked_text(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "no limit";
}

/// The size below which a share of the number and of the volume lies.
void write_quantiles(Page& page, const Sizes& sizes, const SizeDistribution* asked) {
  std::vector<double> volume_below;  // in units of the largest sphere
  double sum = 0;
  for (const double value : sizes.values) {
    sum += sizes.volume(value);
    volume_below.push_back(sum);
  }
  page.add(
      "<table><tr><th>share below</th><th class=\"n\">{} by number</th>{}<th class=\"n\">by {}</th></tr>\n",
      sizes.word, asked ? "<th class=\"n\">asked</th>" : "", sizes.volume_word());
  const auto n = static_cast<double>(sizes.values.size());
  const std::size_t last = sizes.values.size() - 1;
  for (const double share : {0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0}) {
    const auto by_number = static_cast<std::size_t>(std::max(1.0, std::ceil(share * n))) - 1;
    const auto found = std::ranges::lower_bound(volume_below, share * sum);
    const auto by_volume = std::min(last, static_cast<std::size_t>(found - volume_below.begin()));
    page.add(
        "<tr><td>{}</td><td class=\"n\">{:.4g}</td>{}<td class=\"n\">{:.4g}</td></tr>\n",
        share == 0   ? "smallest"
        : share == 1 ? "largest"
                     : fmt::format("{:g} %", 100 * share),
        sizes.values[by_number],
        asked ? fmt::format("<td class=\"n dim\">{}</td>", asked_text(sizes.factor * asked->quantile(share)))
              : "",
        sizes.values[by_volume]);
  }
  page.raw("</table>\n");
}

std::string head_of_asked(const SizeDistribution* asked) { return asked ? "<th class=\"n\">asked</th>" : ""; }
std::string asked_cell(const SizeDistribution* asked, double share) {
  return asked ? fmt::format("<td class=\"n dim\">{:.2f}</td>", 100 * share) : "";
}

void write_classes(Page& page, const Sizes& sizes, const std::map<double, std::uint64_t>& classes,
                   const SizeDistribution* asked, const Packing& packing) {
  const auto* stated = std::get_if<Classes>(&packing.scene.sizes);
  const auto class_at = [&](double size) {
    return stated ? class_of(*stated, size / (packing.scene.scale * packing.size_scale)) : std::nullopt;
  };
  double volume = 0, mass = 0;
  const auto density = [&](double size) {
    const auto k = class_at(size);
    return k && !stated->material_densities.empty() ? stated->material_densities[*k] : 0.0;
  };
  for (const auto& [size, count] : classes) {
    volume += sizes.volume(size) * static_cast<double>(count);
    mass += density(size) * sizes.volume(size) * static_cast<double>(count);
  }
  const bool has_names = stated && !stated->names.empty();
  page.add(
      "<table><tr>{}<th>{}</th><th class=\"n\">spheres</th><th class=\"n\">% of the number</th>{}"
      "<th class=\"n\">% of the {}</th>{}{}</tr>\n",
      has_names ? "<th>name</th>" : "", sizes.word, head_of_asked(asked), sizes.volume_word(),
      head_of_asked(asked), mass > 0 ? "<th class=\"n\">% of the mass</th>" : "");
  for (const auto& [size, count] : classes) {
    const auto n = static_cast<double>(count);
    constexpr double same = 1e-12;
    const double radius = size / sizes.factor;
    const double share =
        asked ? asked->cumulative(radius * (1 + same)) - asked->cumulative(radius * (1 - same)) : 0;
    const auto k = class_at(size);
    page.add(
        "<tr>{}<td>{:.6g}</td><td class=\"n\">{}</td><td class=\"n\">{:.2f}</td>{}<td "
        "class=\"n\">{:.2f}</td>{}{}</tr>\n",
        has_names ? fmt::format("<td>{}</td>", k ? escaped(stated->names[*k]) : "") : "", size,
        grouped(count), 100 * n / static_cast<double>(sizes.values.size()), asked_cell(asked, share),
        100 * sizes.volume(size) * n / volume,
        asked_cell(asked,
                   asked ? share * std::pow(radius, sizes.dimension) / asked->moment(sizes.dimension) : 0),
        mass > 0
            ? fmt::format("<td class=\"n\">{:.2f}</td>", 100 * density(size) * sizes.volume(size) * n / mass)
            : "");
  }
  page.raw("</table>\n");
}

/// Diameters with a tenth, half and nine tenths of the volume below, and how near a law comes to those given.
void write_percentiles(Page& page, const Report& report, const Sizes& sizes) {
  const Scene& scene = report.packing.scene;
  const std::string unit = escaped(name_of(scene.unit));
  if (!report.measured.sizes) return;
  std::vector<std::string> packed, asked;
  for (const auto& [share, realised, of_asked] : report.measured.sizes->volume_quantiles) {
    packed.push_back(fmt::format("D{:.0f} {:.4g}", 100 * share, 2 * realised));
    asked.push_back(fmt::format("{:.4g}", 2 * of_asked));
  }
  page.add("<p>By {} of what was packed: {} {}; asked {}.</p>\n", sizes.volume_word(),
           fmt::join(packed, ", "), unit, fmt::join(asked, ", "));
  if (!report.asked) return;
  std::vector<std::string> fits;
  for (const SizeSummary::Fit& fit : summary_of(scene, *report.asked).fit) fits.push_back(fit_in_words(fit));
  if (!fits.empty())
    page.add("<p>The law that was taken for the percentiles has, {} and against what was given, {}.</p>\n",
             basis_of_fit(scene), fmt::join(fits, ", "));
}

/// By tenths of the volume: requested and realised shares.
void write_shares(Page& page, const Sizes& sizes, const std::vector<SizeComparison::Share>& shares) {
  page.add(
      "<table><tr><th>{} up to</th><th class=\"n\">spheres</th><th class=\"n\">% of the number</th>"
      "<th class=\"n\">asked</th><th class=\"n\">% of the {}</th><th class=\"n\">asked</th></tr>\n",
      sizes.word, sizes.volume_word());
  for (const SizeComparison::Share& share : shares)
    page.add(
        "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{:.3g}</td><td class=\"n dim\">{:.3g}</td>"
        "<td class=\"n\">{:.2f}</td><td class=\"n dim\">{:.2f}</td></tr>\n",
        asked_text(sizes.factor * share.up_to), grouped(share.count), 100 * share.number,
        100 * share.asked_number, 100 * share.volume, 100 * share.asked_volume);
  page.raw("</table>\n");
}

std::string share_of_cases(double p) { return p > 0.99 ? "over 99 %" : fmt::format("{:.2g} %", 100 * p); }

void write_comparison(Page& page, const SizeComparison& c, const Sizes& sizes) {
  page.add(
      "<p class=\"dim\">Against what was asked: the cumulative shares by number differ by at most {:.3g}",
      c.ks_statistic);
  if (c.ks_p_value)
    page.add("; independent draws would differ by more in {} of all cases (Kolmogorov–Smirnov)",
             share_of_cases(*c.ks_p_value));
  if (c.chi_squared_p_value)
    page.add("; independent draws would have counts farther off in {} of all cases (χ²)",
             share_of_cases(*c.chi_squared_p_value));
  page.add(". The mean {} of a sphere is {:.2f} % of what was asked", sizes.volume_word(),
           100 * c.volume_ratio);
  if (std::isfinite(c.volume_ratio_error) && c.volume_ratio_error > 0)
    page.add(", where independent draws have a standard error of {:.2g} %", 100 * c.volume_ratio_error);
  page.raw(".");
  if (c.drawn && c.drawn->missing == 0)
    page.raw(
        c.drawn->scale == 1
            ? " The sizes are those of the drawn sequence to the bit, less its tail: none was left out."
            : fmt::format(" The sizes are those of the drawn sequence, less its tail, and all of them times "
                          "{:.9g}, which is left out of this comparison: so the spheres jam.",
                          c.drawn->scale));
  else if (c.drawn)
    page.add(
        " Of as many draws {} are missing, and other sizes are there instead; in ascending order the sizes "
        "differ from the drawn ones by up to {:.2g} %.",
        grouped(c.drawn->missing), 100 * c.drawn->largest_deviation);
  if (c.drawn && c.drawn->above_largest > 0)
    page.add(" {} larger {} passed over.", grouped(c.drawn->above_largest),
             c.drawn->above_largest == 1 ? "draw was" : "draws were");
  page.raw("</p>\n");
}

}  // namespace

/// What the scene tells apart: its zones, and what lies in none, or its materials.
void write_sphere_classes(Page& page, const Packing& packing) {
  const std::vector<ClassAmount> amounts = class_amounts(packing);
  if (amounts.size() < 2) return;
  double solid = 0;
  for (const ClassAmount& amount : amounts) solid += amount.packing_fraction;
  const bool has_mass =
      std::ranges::all_of(amounts, [](const ClassAmount& amount) { return amount.mass.has_value(); });
  page.add(
      "<h2>Classes</h2>\n<table><tr><th>class</th><th>material</th><th class=\"n\">spheres</th>"
      "<th class=\"n\">of the container</th><th class=\"n\">% of the volume of all</th>{}</tr>\n",
      has_mass ? "<th class=\"n\">mass (kg)</th>" : "");
  for (const ClassAmount& amount : amounts)
    page.add(
        "<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{:.4f}</td><td "
        "class=\"n\">{:.2f}</td>{}</tr>\n",
        escaped(amount.of.name), escaped(amount.of.material), grouped(amount.spheres),
        amount.packing_fraction, solid > 0 ? 100 * amount.packing_fraction / solid : 0.0,
        has_mass ? fmt::format("<td class=\"n\">{:.4g}</td>", *amount.mass) : "");
  page.raw("</table>\n");
}

void write_sizes(Page& page, const Report& report) {
  write_sphere_classes(page, report.packing);
  const Sizes sizes = sizes_of(report.packing);
  const std::string unit = escaped(name_of(report.packing.scene.unit));
  if (sizes.values.empty()) return;
  constexpr std::size_t most_classes = 12;
  std::map<double, std::uint64_t> classes;
  for (auto v = sizes.values.begin(); v != sizes.values.end() && classes.size() <= most_classes; ++v)
    ++classes[*v];

  page.raw("<h2>Sizes</h2>\n");
  if (classes.size() == 1) {
    page.add("<p>All spheres have the {} {:.6g} {}.</p>\n", sizes.word, sizes.values.front(), unit);
    return;
  }
  if (classes.size() <= most_classes) {
    page.add("<p>In {}.</p>\n", unit);
    write_classes(page, sizes, classes, report.asked, report.packing);
  } else {
    SizeHistogram histogram{sizes.values,
                            sizes.dimension,
                            fmt::format("{} ({})", sizes.word, name_of(report.packing.scene.unit)),
                            {}};
    if (report.asked)
      histogram.asked = [&](double size) { return report.asked->cumulative(size / sizes.factor); };
    page.add(
        "<p>What was packed, in {0}. By number every sphere counts the same; by {1} a sphere counts as "
        "much as it is large{2}.</p>\n<div class=\"pair\"><div>{3}<p class=\"key dim\"><i "
        "style=\"background:var(--first)\"></i>by number{4}<i style=\"background:var(--second)\"></i>by "
        "{1}</p></div><div>\n",
        unit, sizes.volume_word(), sizes.dimension == 3 ? ", as on a balance" : "", size_histogram(histogram),
        report.asked ? "<i class=\"dashed\"></i>asked by number" : "");
    write_quantiles(page, sizes, report.asked);
    page.raw("</div></div>\n");
    if (report.measured.sizes && !report.measured.sizes->shares.empty())
      write_shares(page, sizes, report.measured.sizes->shares);
  }
  write_percentiles(page, report, sizes);
  if (report.measured.sizes) write_comparison(page, *report.measured.sizes, sizes);
}

}  // namespace bernal
