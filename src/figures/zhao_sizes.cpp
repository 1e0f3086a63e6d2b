#include <algorithm>
#include <cmath>
#include <numbers>

#include "bernal/run/run.hpp"
#include "bernal/sizes/radius_sequence.hpp"
#include "figures/drawing.hpp"
#include "figures/zhao.hpp"

namespace bernal::figures {
namespace {

constexpr int drawn = 10'000;
constexpr int bars = 48;

/// As it is printed: of uniform numbers each and the next, and no factor 2 beside the logarithm.
std::vector<double> by_the_printed_formula(std::uint64_t seed) {
  Random random(seed, stream(Stream::radii));
  std::vector<double> radii;
  for (double t = 1 - random.uniform(); radii.size() < drawn;) {
    const double next = 1 - random.uniform();
    radii.push_back(
        std::exp(printed_sigma * std::sqrt(-std::log(t)) * std::sin(2 * std::numbers::pi * next)));
    t = next;
  }
  return radii;
}

std::vector<double> drawn_from(const SizeDistribution& sizes, std::uint64_t seed) {
  RadiusSequence sequence(sizes, seed, Draw::random);
  std::vector<double> radii(drawn);
  for (double& r : radii) r = sequence.next();
  return radii;
}

/// The largest difference between the shares at or below any radius, of these radii and of the distribution.
double kolmogorov_smirnov(std::vector<double> radii, const SizeDistribution& sizes) {
  std::ranges::sort(radii);
  const auto n = static_cast<double>(radii.size());
  double most = 0;
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const double expected = sizes.cumulative(radii[k]), before = static_cast<double>(k);
    most = std::max({most, std::abs(expected - before / n), std::abs(expected - (before + 1) / n)});
  }
  return most;
}

std::vector<double> histogram_of(const std::vector<double>& radii, double from, double to) {
  std::vector<double> density(bars, 0);
  const double width = (to - from) / bars;
  for (const double r : radii) {
    const double k = std::floor((r - from) / width);
    if (k >= 0 && k < bars)
      density[static_cast<std::size_t>(k)] += 1 / (width * static_cast<double>(radii.size()));
  }
  return density;
}

/// Mean density between two radii a bar apart.
double density_at(const SizeDistribution& sizes, double r, double width) {
  return (sizes.cumulative(r + 0.5 * width) - sizes.cumulative(r - 0.5 * width)) / width;
}

struct Curve {
  std::string_view classes, name;
  const SizeDistribution& sizes;
};

File figure_of(const std::string& name, std::string_view title, const std::vector<double>& radii,
               std::string_view what, double from, double to, const std::vector<Curve>& curves) {
  const std::vector<double> bar = histogram_of(radii, from, to), xs = spread(from, to, 240);
  double most = std::ranges::max(bar);
  std::vector<std::vector<double>> lines;
  for (const Curve& curve : curves) {
    std::vector<double>& ys = lines.emplace_back();
    for (const double x : xs) ys.push_back(density_at(curve.sizes, x, 0.002 * (to - from)));
    most = std::max(most, std::ranges::max(ys));
  }
  Plot plot({78, 130, 700, 440},
            {from, to, name == "zhao2007_fig1.svg" ? "radius over its median" : "diameter"},
            {0, 1.05 * most, "density"});
  const double width = (to - from) / bars;
  for (int k = 0; k < bars; ++k) {
    const double top = plot.y(bar[static_cast<std::size_t>(k)]);
    plot.add("<rect class=\"bar\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
             plot.x(from + k * width), top, plot.x(from + width) - plot.x(from), plot.y(0) - top);
  }
  plot.axes();
  plot.add("<rect class=\"bar\" x=\"100\" y=\"48\" width=\"34\" height=\"12\"/>");
  add_text(plot, 142, 60, "start", what);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    plot.line(xs, lines[k], curves[k].classes);
    legend_line(plot, 100 + 200.0 * static_cast<double>(k), 84, curves[k].classes, curves[k].name);
  }
  return {name, svg_document(730, 500, title, std::move(plot).finish())};
}

std::string csv_lines(std::string_view figure, const std::vector<double>& radii,
                      const SizeDistribution& stated, double from, double to) {
  const std::vector<double> bar = histogram_of(radii, from, to);
  const double width = (to - from) / bars;
  std::string csv;
  for (int k = 0; k < bars; ++k) {
    const double middle = from + (k + 0.5) * width;
    csv += fmt::format("{},{:.5g},{:.5f},{:.5f}\n", figure, middle, bar[static_cast<std::size_t>(k)],
                       density_at(stated, middle, width));
  }
  return csv;
}

std::unique_ptr<SizeDistribution> distribution_of(std::size_t row) {
  Scene scene;
  scene.sizes = zhao_sizes()[row].sizes;
  return radii_of(scene);
}

}  // namespace

DrawnSizes zhao_drawn_sizes(std::uint64_t seed) {
  const auto lognormal = distribution_of(2), arbitrary = distribution_of(3),
             narrower = distribution_of(as_printed);
  const std::vector<double> own = drawn_from(*lognormal, seed), printed = by_the_printed_formula(seed),
                            grains = drawn_from(*arbitrary, seed);
  DrawnSizes result;
  constexpr double least = 0.2, most = 2.6, widest = 4.2;
  result.files = {
      figure_of("zhao2007_fig1.svg", "Figure 1: lognormal sizes, sigma 0.3", own, "10,000 radii, drawn here",
                least, most,
                {{"line one heavy", "density, sigma 0.3", *lognormal},
                 {"line four dashed", "density, sigma 0.212: what the printed formula draws", *narrower}}),
      figure_of("zhao2007_fig2.svg", "Figure 2: arbitrary sizes, by a cubic spline through points", grains,
                "10,000 sizes, drawn here", 0, widest, {{"line one heavy", "the spline", *arbitrary}}),
      {"zhao2007_sizes.csv", "figure,size,density_drawn,density_stated\n" +
                                 csv_lines("1", own, *lognormal, least, most) +
                                 csv_lines("1 as printed", printed, *narrower, least, most) +
                                 csv_lines("2", grains, *arbitrary, 0, widest)}};

  const double expected = 1.36 / std::sqrt(static_cast<double>(drawn));
  const auto row = [&](std::string what, const std::vector<double>& radii, const SizeDistribution& sizes,
                       std::string against) {
    return std::vector<std::string>{std::move(what), std::move(against),
                                    fmt::format("{:.4f}", kolmogorov_smirnov(radii, sizes))};
  };
  result.page =
      R"(## Figures 1 and 2: drawn sizes against their density

![figure 1](zhao2007_fig1.svg)
![figure 2](zhao2007_fig2.svg)

)" +
      markdown_table({"10,000 sizes", "held against", "largest difference of the cumulative shares"},
                     {row("lognormal, drawn here", own, *lognormal, "sigma 0.3"),
                      row("by the printed formula", printed, *lognormal, "sigma 0.3"),
                      row("by the printed formula", printed, *narrower, "sigma 0.3/√2 = 0.212"),
                      row("arbitrary, drawn here", grains, *arbitrary, "the spline")}) +
      fmt::format(
          R"(
Of sizes that follow the distribution one draw in twenty differs by more than {:.4f}. The printed formula,
r = exp(σ √(−ln t) sin 2πt') with t' the next t, lacks the factor 2 of Box and Muller beside the
logarithm: it draws a narrower distribution than the one it is said to. The data of their figure 2 are not
in the text; what stands for them is one broad hump, skewed to the right, and the paper's rejection is
replaced by its inverse, so that one number gives one radius.
)",
          expected);
  return result;
}

}  // namespace bernal::figures
