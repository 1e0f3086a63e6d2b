#include <algorithm>
#include <cmath>

#include "bernal/io/section.hpp"
#include "figures/drawing.hpp"
#include "figures/zhao.hpp"
#include "io/write_svg.hpp"

namespace bernal::figures {
namespace {

struct Line {
  ZhaoRun runs;
  const char *classes, *name;
};

/// What runs have over the number of spheres.
template <class Value>
void add_line(Plot& plot, const ZhaoResults& results, const Line& line, const Value& value) {
  std::vector<double> xs, ys;
  for (const int n : results.counts(line.runs)) {
    ZhaoRun run = line.runs;
    run.spheres = n;
    xs.push_back(n);
    ys.push_back(value(results.of(run)).mean);
  }
  add_curve(plot, xs, ys, line.classes);
}

/// From the largest power of ten below to the smallest above.
Axis decades(const std::vector<double>& values, std::string_view label) {
  const auto [least, most] = std::ranges::minmax(values);
  const double from = std::pow(10, std::floor(std::log10(least))),
               to = std::pow(10, std::ceil(std::log10(most)));
  return {from, to > from ? to : 10 * from, label, Scale::logarithmic};
}

template <class Value>
std::vector<double> values_of(const ZhaoResults& results, const std::vector<Line>& lines,
                              const Value& value) {
  std::vector<double> all;
  for (Line line : lines)
    for (const int n : results.counts(line.runs)) {
      line.runs.spheres = n;
      all.push_back(value(line.runs));
    }
  return all;
}

File figure_over_counts(const ZhaoResults& results, const std::vector<Line>& lines, const std::string& name,
                        std::string_view title, Axis y,
                        MeanOfSeeds (*value)(const std::vector<const DonePacking*>&)) {
  const std::vector<double> counts =
      values_of(results, lines, [](const ZhaoRun& run) { return double(run.spheres); });
  Plot plot({78, 130, 700, 440}, decades(counts, "spheres N"), y);
  plot.axes();
  double k = 0;
  for (const Line& line : lines) {
    add_line(plot, results, line, value);
    legend_line(plot, 100 + 310 * std::fmod(k, 2), 58 + 22 * std::floor(k / 2), line.classes, line.name);
    ++k;
  }
  return {name, svg_document(730, 500, title, std::move(plot).finish())};
}

File figure_5_of(const ZhaoResults& results) {
  static const std::string short_name = fmt::format("T = {}, published loop", fixed_periods[0]);
  static const std::string long_name = fmt::format("T = {}, published loop", fixed_periods[1]);
  const std::vector<Line> lines = {
      {{}, "line one heavy", "T = 17 lg² N, published loop"},
      {{.method = RelaxMethod::fast}, "line four dashed", "T = 17 lg² N, fast loop"},
      {{.period = fixed_periods[1]}, "line two", long_name.c_str()},
      {{.period = fixed_periods[0]}, "line three dotdash", short_name.c_str()}};
  const std::vector<double> all =
      values_of(results, lines, [&](const ZhaoRun& run) { return phi_of(results.of(run)).mean; });
  const auto [least, most] = std::ranges::minmax(all);
  return figure_over_counts(
      results, lines, "zhao2007_fig5.svg",
      "Figure 5: packing fraction with fixed and adaptive period, equal spheres",
      {std::floor(100 * least) / 100, std::ceil(100 * most) / 100, "packing fraction φ"}, phi_of);
}

File figure_8_of(const ZhaoResults& results) {
  const std::vector<Line> lines = {{{}, "line one heavy", "published loop, φ0 = 0.86"},
                                   {{.phi0 = 0.75}, "line two dashed", "published loop, φ0 = 0.75"},
                                   {{.method = RelaxMethod::fast}, "line four", "fast loop, φ0 = 0.86"}};
  const std::vector<double> all =
      values_of(results, lines, [&](const ZhaoRun& run) { return seconds_of(results.of(run)).mean; });
  return figure_over_counts(results, lines, "zhao2007_fig8.svg", "Figure 8: time, equal spheres",
                            decades(all, "seconds"), seconds_of);
}

/// A packing and the plane in its middle, side by side.
File packing_figure(const ZhaoResults& results, std::size_t row) {
  const ZhaoSizes& of = zhao_sizes()[row];
  // Equal spheres are packed in many numbers: shown is the one that the others have too.
  const int spheres = results.counts({.sizes = 1, .method = RelaxMethod::fast}).back();
  const auto all = results.of({.sizes = row, .method = RelaxMethod::fast, .spheres = spheres});
  const DonePacking& shown = *all.front();
  const Packing& packing = shown.packing;
  const std::string body =
      nested_svg(svg_of(packing.spheres, packing.domain, ""), 8, 44, 500, 520) +
      nested_svg(section_svg(section_of(packing.spheres, packing.domain, middle_plane(packing.domain)),
                             packing.spheres, ""),
                 505, 44, 455, 520);
  return {fmt::format("zhao2007_fig{}.svg", of.figure),
          svg_document(970, 580,
                       fmt::format("Figure {}: {} spheres, {}: packing fraction {:.4f}", of.figure,
                                   packing.spheres.size(), of.name, shown.phi),
                       body)};
}

}  // namespace

Files zhao_pictures(const ZhaoResults& results) {
  Files files = {figure_5_of(results), figure_8_of(results)};
  for (std::size_t row = 0; row < zhao_sizes().size(); ++row)
    if (zhao_sizes()[row].figure > 0) files.push_back(packing_figure(results, row));
  return files;
}

}  // namespace bernal::figures
