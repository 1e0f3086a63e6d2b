#include "report/chart.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <vector>

#include <fmt/format.h>

#include "report/plot.hpp"
#include "viewer/html.hpp"

namespace bernal {
namespace {

constexpr double chart_width = 520, chart_height = 260;
constexpr double left_margin = 62, right_margin = 12, top_margin = 44, bottom_margin = 44;

/// A chart of the report.
class Chart : public Plot {
 public:
  Chart(const Axis& along, const Axis& across)
      : Plot({left_margin, top_margin, chart_width - right_margin, chart_height - bottom_margin}, along,
             across) {
    add("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\">", chart_width, chart_height);
    axes();
  }
  std::string finish() && { return std::move(*this).Plot::finish() + "</svg>"; }
};

/// A point of a history with its stage.
struct Moment {
  double seconds, value;
  std::string_view stage;
};

/// Adds the names of stages at their starts.
void add_stages(Chart& chart, const std::vector<Moment>& history) {
  double free_from = 0;  // where the next stage name would not overlap the last one
  std::string_view stage;
  for (const Moment& m : history) {
    if (m.stage == stage) continue;
    stage = m.stage;
    const double x = chart.x(m.seconds), end = x + 10 + 7.0 * static_cast<double>(stage.size());
    if (x < free_from || end > chart_width) continue;
    chart.add("<path class=\"stage\" d=\"M{:.1f} {}V{}\"/>", x, top_margin, chart_height - bottom_margin);
    chart.add("<text x=\"{:.1f}\" y=\"{}\">{}</text>", x, top_margin - 6, escaped(stage));
    free_from = end;
  }
}

std::string chart_of(const std::vector<Moment>& history, double y0, double y1, std::string_view label,
                     Scale scale) {
  const double last = std::ranges::max(history, {}, &Moment::seconds).seconds;
  Chart chart({0, last > 0 ? 1.02 * last : 1, "seconds since the start of the run"}, {y0, y1, label, scale});
  add_stages(chart, history);
  std::string line;
  for (const Moment& m : history) {
    line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? 'M' : 'L', chart.x(m.seconds), chart.y(m.value));
  }
  chart.add("<path class=\"first line\" d=\"{}\"/>", line);
  if (history.size() <= 200) {
    for (const Moment& m : history) {
      chart.add("<circle class=\"point\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.4\"/>", chart.x(m.seconds),
                chart.y(m.value));
    }
  }
  return std::move(chart).finish();
}

/// A value with the errors below and above it.
struct Uncertain {
  double x, y, below, above;
};

/// A line with its error band, clipped to the axis.
void add_band(Chart& chart, const std::vector<Uncertain>& points, double highest, double lowest = 0) {
  const auto append = [&](std::string& path, double x, double y) {
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', chart.x(x),
                        chart.y(std::clamp(y, lowest, highest)));
  };
  std::string line, band;
  for (const Uncertain& p : points) {
    append(line, p.x, p.y);
    append(band, p.x, p.y + p.above);
  }
  for (const Uncertain& p : points | std::views::reverse) append(band, p.x, p.y - p.below);
  chart.add("<path class=\"band\" d=\"{}Z\"/><path class=\"first line\" d=\"{}\"/>", band, line);
}

}  // namespace

std::string size_histogram(const SizeHistogram& histogram) {
  constexpr std::size_t bins = 36;
  const std::span<const double> sizes = histogram.sizes;
  const auto [least, most] = std::ranges::minmax(sizes);
  const double step = (most - least) / bins;
  std::vector<double> number(bins, 0), volume(bins, 0), asked(bins, 0);
  double all = 0;
  for (const double size : sizes) {
    const std::size_t bin =
        std::min(bins - 1, static_cast<std::size_t>((size - least) / (most - least) * bins));
    const double part = std::pow(size / most, histogram.dimension);
    number[bin] += 100.0 / static_cast<double>(sizes.size());
    volume[bin] += part;
    all += part;
  }
  for (double& share : volume) share *= 100 / all;
  if (histogram.asked) {
    for (std::size_t k = 0; k < bins; ++k) {
      const double from = least + step * static_cast<double>(k);
      asked[k] = 100 * (histogram.asked(from + step) - histogram.asked(from));
    }
  }

  const double highest =
      std::max({std::ranges::max(number), std::ranges::max(volume), std::ranges::max(asked)});
  Chart chart({least, most, histogram.label},
              {0, 1.05 * highest, "per cent of all spheres, in 36 equal steps"});
  const double bar = chart.x(most) / bins - chart.x(least) / bins;
  std::string by_volume, by_asked;
  for (std::size_t k = 0; k < bins; ++k) {
    const double x = chart.x(least) + bar * static_cast<double>(k);
    chart.add("<rect class=\"bar\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>", x + 0.5,
              chart.y(number[k]), bar - 1, chart.y(0) - chart.y(number[k]));
    by_volume += fmt::format("{}{:.1f} {:.1f}H{:.1f}", k == 0 ? 'M' : 'L', x, chart.y(volume[k]), x + bar);
    by_asked += fmt::format("{}{:.1f} {:.1f}H{:.1f}", k == 0 ? 'M' : 'L', x, chart.y(asked[k]), x + bar);
  }
  chart.add("<path class=\"second line\" d=\"{}\"/>", by_volume);
  if (histogram.asked) chart.add("<path class=\"asked line\" d=\"{}\"/>", by_asked);
  return std::move(chart).finish();
}

std::string radial_chart(const RadialDistribution& radial) {
  // The contact peak of equal spheres is as high as the bins are narrow; the axis is scaled to what follows.
  double highest = 3;
  std::vector<Uncertain> points;
  for (std::size_t k = 0; k < radial.g.size(); ++k) {
    const double diameters = radial.r[k] / radial.mean_diameter, g = radial.g[k], error = radial.error[k];
    if (diameters > 1.2) highest = std::max(highest, 1.1 * g);
    points.push_back({diameters, g, error, g > 0 ? error : 0});
  }
  Chart chart({0, radial.bin_width * static_cast<double>(radial.g.size()) / radial.mean_diameter,
               "distance of the centres (mean diameters)"},
              {0, highest, "g(r)"});
  add_band(chart, points, highest);
  return std::move(chart).finish();
}

std::string size_correlation_chart(const SizeCorrelation& correlation) {
  // Where two of the smallest sizes touch, C is far above the range of interest.
  constexpr double highest = 0.3;
  std::vector<Uncertain> points;
  for (std::size_t k = 0; k < correlation.d.size(); ++k)
    if (correlation.error[k] < highest)
      points.push_back({correlation.d[k] / correlation.mean_diameter, correlation.c[k], correlation.error[k],
                        correlation.error[k]});
  if (points.size() < 2) return {};
  const double reach =
      correlation.bin_width * static_cast<double>(correlation.d.size()) / correlation.mean_diameter;
  Chart chart({0, reach, "distance of the centres (mean diameters)"}, {-highest, highest, "C(d)"});
  chart.add("<path class=\"asked line\" d=\"M{} {:.1f}H{}\"/>", left_margin, chart.y(0),
            chart_width - right_margin);
  add_band(chart, points, highest, -highest);
  return std::move(chart).finish();
}

std::string bed_chart(const BedProfile& bed, std::string_view unit) {
  double most = 1;
  std::vector<double> heights, fractions;
  for (const auto& layer : bed.layers) {
    most = std::max(most, layer.packing_fraction);
    heights.push_back(0.5 * (layer.from + layer.to));
    fractions.push_back(layer.packing_fraction);
  }
  Chart chart({0, 1.02 * bed.highest, fmt::format("height ({})", unit)}, {0, most, "packing fraction"});
  chart.add("<path class=\"asked line\" d=\"M{:.1f} {}V{}\"/>", chart.x(bed.height), top_margin,
            chart_height - bottom_margin);
  chart.line(heights, fractions, "first line");
  return std::move(chart).finish();
}

std::string wall_chart(const WallProfile& profile) {
  const std::size_t even = profile.layers.size() - 1;  // the last layer holds all that is deeper
  if (even < 2) return {};
  double highest = 1;
  std::vector<Uncertain> points;
  for (const auto& layer : profile.layers) {
    highest = std::max(highest, layer.porosity + layer.error);
    points.push_back(
        {0.5 * (layer.from + layer.to) / profile.mean_diameter, layer.porosity, layer.error, layer.error});
  }
  points.pop_back();
  Chart chart(
      {0, profile.layers[even].from / profile.mean_diameter, "distance from the wall (mean diameters)"},
      {0, highest, "porosity"});
  chart.add("<path class=\"asked line\" d=\"M{} {:.1f}H{}\"/>", left_margin, chart.y(profile.mean_porosity),
            chart_width - right_margin);
  add_band(chart, points, highest);
  return std::move(chart).finish();
}

std::string wall_size_chart(const WallProfile& profile) {
  constexpr double highest = 2;
  std::vector<Uncertain> points;
  bool differ = false;
  for (std::size_t k = 0; k + 1 < profile.layers.size(); ++k) {
    const auto& layer = profile.layers[k];
    if (!layer.segregation || layer.segregation->spheres < 2) continue;
    const double ratio = layer.segregation->volume_ratio, error = layer.segregation->error;
    differ = differ || error > 0;
    points.push_back({0.5 * (layer.from + layer.to) / profile.mean_diameter, ratio, error, error});
  }
  if (points.size() < 2 || !differ) return {};
  Chart chart({0, profile.layers.back().from / profile.mean_diameter,
               "from the wall to the surface of the sphere (mean diameters)"},
              {0, highest, "mean volume, of that of all"});
  chart.add("<path class=\"asked line\" d=\"M{} {:.1f}H{}\"/>", left_margin, chart.y(1),
            chart_width - right_margin);
  add_band(chart, points, highest);
  return std::move(chart).finish();
}

std::string local_packing_chart(const LocalPacking& local) {
  constexpr std::size_t bins = 36;
  if (!(local.deviation > 1e-6 * local.mean) || local.quantiles.empty()) return {};
  double least = local.mean, most = local.mean;
  for (std::size_t i = 0; i < local.cell_volume.size(); ++i) {
    if (!(local.cell_volume[i] > 0)) continue;
    least = std::min(least, local.packing_fraction[i]);
    most = std::max(most, local.packing_fraction[i]);
  }
  // Spheres almost hidden by overlaps have tiny cells: outliers are left out.
  const double low = local.quantiles.front().packing_fraction, high = local.quantiles.back().packing_fraction;
  least = std::max(least, low - (high - low));
  most = std::min(most, high + (high - low));
  const auto all = static_cast<double>(local.cell_volume.size() - local.empty);
  std::vector<double> share(bins, 0);
  for (std::size_t i = 0; i < local.cell_volume.size(); ++i) {
    const double at = (local.packing_fraction[i] - least) / (most - least) * bins;
    if (local.cell_volume[i] > 0 && at >= 0 && at <= bins)
      share[std::min(bins - 1, static_cast<std::size_t>(at))] += 100 / all;
  }
  const double highest = 1.05 * std::ranges::max(share);
  Chart chart({least, most, "local packing fraction"},
              {0, highest, "per cent of the spheres, in 36 equal steps"});
  const double bar = (chart.x(most) - chart.x(least)) / bins;
  for (std::size_t k = 0; k < bins; ++k)
    chart.add("<rect class=\"bar\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
              chart.x(least) + bar * static_cast<double>(k) + 0.5, chart.y(share[k]), bar - 1,
              chart.y(0) - chart.y(share[k]));
  if (local.mean <= most)
    chart.add("<path class=\"asked line\" d=\"M{:.1f} {}V{}\"/>", chart.x(local.mean), top_margin,
              chart_height - bottom_margin);
  return std::move(chart).finish();
}

std::string structure_chart(const StructureFactor& factor) {
  if (factor.k.size() < 2) return {};
  double highest = 1.5;
  std::vector<Uncertain> points;
  for (std::size_t b = 0; b < factor.k.size(); ++b) {
    const double s = factor.s[b], error = factor.error[b];
    highest = std::max(highest, std::min(1.1 * s, 6.0));  // peaks of crystals grow with the number of spheres
    points.push_back({factor.k[b] * factor.mean_diameter, s, error, error});
  }
  Chart chart({0, points.back().x, "wave number (inverse mean diameters)"}, {0, highest, "S(k)"});
  chart.add("<path class=\"asked line\" d=\"M{} {:.1f}H{}\"/>", left_margin, chart.y(1),
            chart_width - right_margin);
  add_band(chart, points, highest);
  return std::move(chart).finish();
}

std::string pore_chart(const PoreSizes& pores) {
  if (pores.d.size() < 2) return {};
  double highest = 0;
  std::vector<Uncertain> points;
  for (std::size_t k = 0; k < pores.d.size(); ++k) {
    const double p = pores.density[k] * pores.mean_diameter, error = pores.error[k] * pores.mean_diameter;
    highest = std::max(highest, 1.05 * (p + error));
    points.push_back({pores.d[k] / pores.mean_diameter, p, error, error});
  }
  Chart chart({0, points.back().x, "distance to the nearest solid (mean diameters)"}, {0, highest, "P(d)"});
  add_band(chart, points, highest);
  return std::move(chart).finish();
}

std::string history_chart(std::span<const Milestone> history, double Milestone::*value,
                          std::string_view label) {
  std::vector<Moment> moments;
  double least = history.front().*value, most = least;
  for (const Milestone& m : history) {
    moments.push_back({m.seconds, m.*value, m.stage});
    least = std::min(least, m.*value);
    most = std::max(most, m.*value);
  }
  // Mere rounding is drawn as a flat line.
  double room = std::max({0.08 * (most - least), 1e-3 * std::abs(least), 1e-3 * std::abs(most)});
  if (!(room > 0)) room = 1;
  return chart_of(moments, least - room, most + room, label, Scale::linear);
}

std::string overlap_chart(std::span<const Milestone> history) {
  std::vector<Moment> moments;
  for (const Milestone& m : history)
    if (m.max_overlap > 0) moments.push_back({m.seconds, std::log10(m.max_overlap), m.stage});
  if (moments.size() < 2) return {};
  const auto [least, most] = std::ranges::minmax(moments, {}, &Moment::value);
  const double from = std::floor(least.value), to = std::max(from + 1, std::ceil(most.value));
  return chart_of(moments, from, to, "largest overlap, of the sum of the radii", Scale::exponents);
}

}  // namespace bernal
