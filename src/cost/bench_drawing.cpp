#include "cost/bench_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/html_text.hpp"

namespace bernal::cost {
namespace {

constexpr double letter = 6.9, height = 15;  // of the words, in the units of the picture
constexpr double below_middle = 4;           // the line that letters stand on
constexpr double beside = 8;                 // from a point to its words
constexpr double step = 4;                   // along a line, to see what words would cover

/// What it costs to cover, or to stand elsewhere.
constexpr double cost_of_words = 1000, cost_beyond = 1000, cost_of_line = 1, cost_of_other_end = 3;

double overlap(const Place& a, const Place& b) {
  return std::max(0.0, std::min(a.right, b.right) - std::max(a.left, b.left)) *
         std::max(0.0, std::min(a.bottom, b.bottom) - std::max(a.top, b.top));
}

bool holds(const Place& place, double x, double y) {
  return x > place.left && x < place.right && y > place.top && y < place.bottom;
}

/// Points along a line, a step apart.
std::vector<std::pair<double, double>> along(const NamedLine& line) {
  std::vector<std::pair<double, double>> points = {{line.xs[0], line.ys[0]}};
  for (std::size_t k = 1; k < line.xs.size(); ++k) {
    const double dx = line.xs[k] - line.xs[k - 1], dy = line.ys[k] - line.ys[k - 1];
    const int steps = 1 + static_cast<int>(std::hypot(dx, dy) / step);
    for (int i = 1; i <= steps; ++i)
      points.emplace_back(line.xs[k - 1] + dx * i / steps, line.ys[k - 1] + dy * i / steps);
  }
  return points;
}

/// Where words of that width may stand beside a point.
std::vector<Place> around(double x, double y, double width) {
  const double half = 0.5 * height;
  const auto at = [&](double left, double middle) {
    return Place{left, middle - half, left + width, middle + half};
  };
  return {at(x + beside, y),
          at(x - beside - width, y),
          at(x + beside, y - beside),
          at(x + beside, y + beside),
          at(x - beside - width, y - beside),
          at(x - beside - width, y + beside),
          at(x - 0.5 * width, y - half - beside),
          at(x - 0.5 * width, y + half + beside),
          at(x - 0.5 * width, y - half - 2 * beside),
          at(x - 0.5 * width, y + half + 2 * beside)};
}

}  // namespace

const std::string_view bench_style = R"css(<style>
.name { paint-order:stroke; stroke:#ffffff; stroke-width:4; stroke-linejoin:round; font-size:12.5px; }
.series { fill:none; stroke-width:1.8; stroke-linejoin:round; } .scatter { stroke-width:1.2; }
.dot { stroke:none; } .model { stroke:#1d2733; stroke-width:1.2; stroke-dasharray:6 4; fill:none; } .model.solid { stroke-dasharray:none; }
.c0 { color:#0b6e8f; } .c1 { color:#7a8794; } .c2 { color:#b3471d; } .c3 { color:#3a3f8f; } .c4 { color:#86661a; }
.c5 { color:#2e7d46; } .c6 { color:#a8327e; } .c7 { color:#5d6b7a; } .c8 { color:#8a5ac2; } .c9 { color:#1f8a70; }
.series, .scatter { stroke:currentColor; } .dot, .name { fill:currentColor; }
@media (prefers-color-scheme: dark) {
  text { fill:#94a2b1; } .label, .title { fill:#e4e9ee; } .grid { stroke:#2c3743; } .axis { stroke:#94a2b1; }
  .page { fill:#10161d; } .name { stroke:#10161d; fill:currentColor; } .model { stroke:#e4e9ee; }
  .c0 { color:#5bc0de; } .c1 { color:#aab6c2; } .c2 { color:#f08a5d; } .c3 { color:#9aa0f5; } .c4 { color:#d9b65a; }
  .c5 { color:#74c68c; } .c6 { color:#e88bc5; } .c7 { color:#94a2b1; } .c8 { color:#c3a2f0; } .c9 { color:#5fd0b0; }
}
</style>
)css";

Place place_of_text(double x, double baseline, std::string_view text) {
  return {x, baseline - below_middle - 0.5 * height, x + letter * static_cast<double>(text.size()),
          baseline - below_middle + 0.5 * height};
}

void add_names(Plot& plot, const std::vector<NamedLine>& lines, std::vector<Place> taken) {
  std::vector<std::vector<std::pair<double, double>>> drawn;
  for (const NamedLine& line : lines) drawn.push_back(along(line));
  const PlotArea& area = plot.area();
  for (const NamedLine& line : lines) {
    const double width = letter * static_cast<double>(line.text.size());
    Place best{};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t from_end = 0; from_end < line.xs.size(); ++from_end) {
      const std::size_t k = line.xs.size() - 1 - from_end;
      double rank = cost_of_other_end * static_cast<double>(from_end);
      for (const Place& place : around(line.xs[k], line.ys[k], width)) {
        double cost = rank += 0.1;
        for (const Place& word : taken) cost += cost_of_words * (overlap(place, word) > 0);
        const bool inside = place.left >= area.left && place.right <= area.right && place.top >= area.top &&
                            place.bottom <= area.bottom;
        cost += cost_beyond * !inside;
        for (const auto& points : drawn)
          for (const auto& [x, y] : points) cost += cost_of_line * holds(place, x, y);
        if (cost < least) {
          least = cost;
          best = place;
        }
      }
    }
    taken.push_back(best);
    plot.add("<text class=\"name c{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", line.colour, best.left,
             best.bottom - 0.5 * height + below_middle, escaped(line.text));
  }
}

}  // namespace bernal::cost
