#include "cost/methods_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "cost/bench_drawing.hpp"
#include "figures/drawing.hpp"

namespace bernal::cost {
namespace {

constexpr double picture_width = 720, picture_height = 780;
constexpr PlotArea above{70, 96, 700, 376}, below{70, 452, 700, 722};

/// What holds all numbers, and some room.
struct Range {
  double from = std::numeric_limits<double>::infinity(), to = -from;
  void take(double value) {
    from = std::min(from, value);
    to = std::max(to, value);
  }
};

void panel(Plot& plot, const MethodsPicture& picture, const std::map<std::string, int>& colours,
           bool between_lids) {
  plot.axes();
  const PlotArea& area = plot.area();
  plot.add("<path class=\"model\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", area.left, plot.y(picture.predicted),
           area.right);
  figures::add_text(plot, area.right, plot.y(picture.predicted) - 6, "end",
                    fmt::format("rod model {:.4f}", picture.predicted));
  std::vector<std::string> texts;
  std::vector<NamedLine> names;
  for (const MethodsPicture::Line& line : picture.lines) {
    if (line.between_lids != between_lids) continue;
    std::vector<double> xs, ys;
    NamedLine name{{}, colours.at(line.name), {}, {}};
    double densest = 0;
    for (const MethodsPicture::Point& point : line.points) {
      xs.push_back(point.seconds);
      ys.push_back(point.phi);
      name.xs.push_back(plot.x(point.seconds));
      name.ys.push_back(plot.y(point.phi));
      densest = std::max(densest, point.phi);
      plot.add("<path class=\"scatter c{}\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", name.colour, name.xs.back(),
               plot.y(point.phi - point.scatter), plot.y(point.phi + point.scatter));
      plot.add("<circle class=\"dot c{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.2\"/>\n", name.colour,
               name.xs.back(), name.ys.back());
    }
    plot.line(xs, ys, fmt::format("series c{}", name.colour));
    texts.push_back(fmt::format("{} {:.3f}", line.name, densest));
    names.push_back(std::move(name));
  }
  for (std::size_t k = 0; k < names.size(); ++k) names[k].text = texts[k];
  add_names(plot, names);
}

}  // namespace

std::string draw(const MethodsPicture& picture) {
  Range seconds, phi[2];
  std::map<std::string, int> colours;
  for (const MethodsPicture::Line& line : picture.lines) {
    colours.emplace(line.name, static_cast<int>(colours.size() % 10));
    for (const MethodsPicture::Point& point : line.points) {
      seconds.take(point.seconds);
      phi[line.between_lids].take(point.phi);
    }
  }
  const auto decade = [](double s) { return std::pow(10, std::floor(std::log10(std::max(s, 1e-6)))); };
  const Axis x{decade(seconds.from), 10 * decade(seconds.to), "seconds of the processor, one thread",
               Scale::logarithmic};
  std::string body(bench_style);
  for (const bool between_lids : {false, true}) {
    Range& range = phi[between_lids];
    range.take(picture.predicted);
    const double room = 0.08 * (range.to - range.from) + 0.01;
    Axis along = x;
    if (!between_lids) along.label = "";
    Plot plot(between_lids ? below : above, along,
              {range.from - room, range.to + room,
               between_lids ? "packing fraction, between floor and lid"
                            : "packing fraction, in a box that repeats itself",
               Scale::linear});
    panel(plot, picture, colours, between_lids);
    body += std::move(plot).finish();
  }
  return figures::svg_document(picture_width, picture_height, picture.title, body);
}

}  // namespace bernal::cost
