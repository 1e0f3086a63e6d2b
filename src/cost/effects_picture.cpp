#include "cost/effects_picture.hpp"

#include <algorithm>
#include <cmath>

#include "cost/bench_drawing.hpp"
#include "figures/drawing.hpp"

namespace bernal::cost {
namespace {

constexpr double picture_width = 720, row_height = 26, first_row = 74, names_end = 200;
constexpr double least_ratio = 0.04, most_ratio = 25, most_gain = 0.1;  // that are drawn; beyond, at the edge

/// A bar from the axis to a value, its scatter, and the number beside it.
void bar(Plot& plot, double y, double origin, double from, double value, double to, int colour,
         const std::string& text) {
  const double x0 = plot.x(origin), x1 = plot.x(value);
  plot.add("<rect class=\"dot c{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"12\" rx=\"1.5\"/>",
           colour, std::min(x0, x1), y - 6, std::max(0.8, std::abs(x1 - x0)));
  plot.add("<path class=\"model solid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", plot.x(from), y, plot.x(to));
  const bool rightwards = value >= origin;
  figures::add_text(plot, rightwards ? std::max(x1, plot.x(to)) + 5 : std::min(x1, plot.x(from)) - 5, y + 4,
                    rightwards ? "start" : "end", text);
}

}  // namespace

std::string draw(const EffectsPicture& picture) {
  double widest = 0.01;
  for (const EffectsPicture::Row& row : picture.rows)
    widest = std::max(widest, std::abs(row.gain) + row.gain_scatter);
  widest = std::min(widest, most_gain);
  const double axis_end = 1.55 * widest;  // the numbers stand beside the bars
  const double bottom = first_row + row_height * static_cast<double>(picture.rows.size());
  Plot left({names_end + 10, first_row, 445, bottom}, {-axis_end, axis_end, "", Scale::linear},
            {0, 1, "", Scale::linear});
  Plot right({465, first_row, 710, bottom}, {least_ratio / 8, most_ratio * 8, "", Scale::logarithmic},
             {0, 1, "", Scale::linear});
  const auto heading = [](Plot& plot, double origin, std::string_view text) {
    const PlotArea& area = plot.area();
    plot.add("<path class=\"axis\" d=\"M{0:.1f} {1:.1f}V{2:.1f}\"/>", plot.x(origin), area.top - 8,
             area.bottom);
    figures::add_text(plot, plot.x(origin), area.top - 16, "middle", text);
  };
  heading(left, 0, "packing fraction, with − without");
  heading(right, 1, "time, with / without");
  for (std::size_t k = 0; k < picture.rows.size(); ++k) {
    const EffectsPicture::Row& row = picture.rows[k];
    const double y = first_row + row_height * (static_cast<double>(k) + 0.5);
    figures::add_text(left, names_end, y + 4, "end", row.name);
    const auto within = [&](double gain) { return std::clamp(gain, -widest, widest); };
    bar(left, y, 0, within(row.gain - row.gain_scatter), within(row.gain),
        within(row.gain + row.gain_scatter), row.gain < 0 ? 2 : 0, fmt::format("{:+.4f}", row.gain));
    const auto drawn = [](double ratio) { return std::clamp(ratio, least_ratio, most_ratio); };
    bar(right, y, 1, drawn(row.ratio - row.ratio_scatter), drawn(row.ratio),
        drawn(row.ratio + row.ratio_scatter), row.ratio > 1 ? 2 : 0,
        fmt::format("× {:.{}f}", row.ratio, row.ratio < 10 ? 2 : 0));
  }
  figures::add_text(left, 16, bottom + 26, "start",
                    fmt::format("The bars end at {:g} and at {:g} times.", most_gain, most_ratio));
  return figures::svg_document(
      picture_width, bottom + 40, "What each effect buys and costs",
      std::string(bench_style) + std::move(left).finish() + "\n" + std::move(right).finish());
}

}  // namespace bernal::cost
