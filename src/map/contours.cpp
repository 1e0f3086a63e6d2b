#include "map/contours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "viewer/palette.hpp"

namespace bernal::drawing {
namespace {

constexpr int patches = 180;  ///< of one colour, along each side

struct Point {
  double x, y;
};

/// The colour of a band: the palette of sizes, kept light so that lines stand out.
std::string band_colour(double share) { return mix(size_colour(share), {1, 1, 1}, 0.35).text(); }

/// Where `v` lies in ascending `values`: the interval, and how far into it.
std::pair<std::size_t, double> place_in(const std::vector<double>& values, double v) {
  const auto above = std::upper_bound(values.begin() + 1, values.end() - 1, v);
  const auto k = static_cast<std::size_t>(above - values.begin()) - 1;
  return {k, std::clamp((v - values[k]) / (values[k + 1] - values[k]), 0.0, 1.0)};
}

double value_at(const Field& f, double x, double y) {
  const auto [j, s] = place_in(f.xs, x);
  const auto [i, t] = place_in(f.ys, y);
  return (1 - t) * ((1 - s) * f.at(i, j) + s * f.at(i, j + 1)) +
         t * ((1 - s) * f.at(i + 1, j) + s * f.at(i + 1, j + 1));
}

/// Patches of one colour a band; neighbours of the same band in a row are one rectangle.
void add_bands(Plot& plot, const Field& f, double step, int first, int last) {
  const PlotArea& frame = plot.area();
  const double width = (frame.right - frame.left) / patches, height = (frame.bottom - frame.top) / patches;
  plot.add("<g shape-rendering=\"crispEdges\">");
  for (int row = 0; row < patches; ++row) {
    const double y = plot.y_at(frame.top + height * (row + 0.5));
    int band = 0, from = 0;
    for (int column = 0; column <= patches; ++column) {
      int here = -1;
      if (column < patches)
        here = static_cast<int>(
            std::floor(value_at(f, plot.x_at(frame.left + width * (column + 0.5)), y) / step));
      if (column > 0 && here != band) {
        plot.add("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>",
                 frame.left + width * from, frame.top + height * row, width * (column - from), height + 0.3,
                 band_colour(last > first ? (band - first) / static_cast<double>(last - first) : 0.3));
        from = column;
      }
      band = here;
    }
  }
  plot.add("</g>");
}

/// Marching squares: the pieces of the line `level` in one cell, ends in the units of the picture.
void add_cell(const Plot& plot, const Field& f, std::size_t i, std::size_t j, double level,
              std::vector<std::pair<Point, Point>>& segments) {
  const std::array<Point, 4> corner = {{{plot.x(f.xs[j]), plot.y(f.ys[i])},
                                        {plot.x(f.xs[j + 1]), plot.y(f.ys[i])},
                                        {plot.x(f.xs[j + 1]), plot.y(f.ys[i + 1])},
                                        {plot.x(f.xs[j]), plot.y(f.ys[i + 1])}}};
  const std::array<double, 4> v = {f.at(i, j), f.at(i, j + 1), f.at(i + 1, j + 1), f.at(i + 1, j)};
  std::vector<Point> crossings;
  for (std::size_t a = 0; a < 4; ++a) {
    const std::size_t b = (a + 1) % 4;
    if ((v[a] < level) == (v[b] < level)) continue;
    const double s = (level - v[a]) / (v[b] - v[a]);
    crossings.push_back(
        {corner[a].x + s * (corner[b].x - corner[a].x), corner[a].y + s * (corner[b].y - corner[a].y)});
  }
  // In a saddle the mean decides which corners belong together, those that it lies with; the others are cut
  // off.
  if (crossings.size() == 4 && (v[0] + v[1] + v[2] + v[3] < 4 * level) != (v[0] < level))
    std::rotate(crossings.begin(), crossings.begin() + 1, crossings.end());
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
    segments.emplace_back(crossings[k], crossings[k + 1]);
}

void add_line(Plot& plot, const Field& f, double level, bool bold, std::string& names) {
  std::vector<std::pair<Point, Point>> segments;
  for (std::size_t i = 0; i + 1 < f.ys.size(); ++i)
    for (std::size_t j = 0; j + 1 < f.xs.size(); ++j) add_cell(plot, f, i, j, level, segments);
  if (segments.empty()) return;
  plot.add("<path class=\"contour{}\" d=\"", bold ? " bold" : "");
  for (const auto& [a, b] : segments) plot.add("M{:.1f} {:.1f}L{:.1f} {:.1f}", a.x, a.y, b.x, b.y);
  plot.add("\"/>\n");
  if (!bold) return;
  // Where it is nearest to the diagonal that rises, and so apart from the names of other lines.
  const PlotArea& frame = plot.area();
  const auto off = [&](const std::pair<Point, Point>& s) {
    return std::abs((s.first.x - frame.left) / (frame.right - frame.left) -
                    (frame.bottom - s.first.y) / (frame.bottom - frame.top));
  };
  const auto& [a, b] = *std::ranges::min_element(segments, {}, off);
  names +=
      fmt::format("<text class=\"halo\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.2f}</text>\n",
                  std::clamp(0.5 * (a.x + b.x), frame.left + 18, frame.right - 18),
                  std::clamp(0.5 * (a.y + b.y) + 4, frame.top + 14, frame.bottom - 6), level);
}

}  // namespace

void add_contours(Plot& plot, const Field& field, double step) {
  const auto [least, most] = std::ranges::minmax(field.values);
  const int first = static_cast<int>(std::floor(least / step)), last = static_cast<int>(most / step);
  add_bands(plot, field, step, first, last);
  std::string names;
  for (int k = first + 1; k <= last; ++k) add_line(plot, field, k * step, k % 5 == 0, names);
  plot.add("{}", names);
}

}  // namespace bernal::drawing
