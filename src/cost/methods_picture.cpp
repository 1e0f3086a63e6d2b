#include "cost/methods_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cost/bench_drawing.hpp"
#include "figures/drawing.hpp"

namespace bernal::cost {
namespace {

constexpr double picture_width = 720, picture_height = 770;
constexpr PlotArea above{70, 86, 700, 376}, below{70, 446, 700, 716};

/// What holds all numbers, and some room.
struct Range {
  double from = std::numeric_limits<double>::infinity(), to = -from;
  void take(double value) {
    from = std::min(from, value);
    to = std::max(to, value);
  }
};

/// 1, 2 or 5 times a power of ten that is no more than a value.
double round_down(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  return decade * (value >= 5 * decade ? 5 : value >= 2 * decade ? 2 : 1);
}

void panel(Plot& plot, const MethodsPicture& picture, bool between_lids) {
  plot.axes();
  const PlotArea& area = plot.area();
  plot.add("<path class=\"model\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", area.left, plot.y(picture.predicted),
           area.right);
  const std::string model = fmt::format("rod model {:.4f}", picture.predicted);
  const double model_y = plot.y(picture.predicted) - 6;
  figures::add_text(plot, area.left + 4, model_y, "start", model);
  std::vector<std::string> texts;
  std::vector<NamedLine> names;
  for (const MethodsPicture::Line& line : picture.lines) {
    if (line.between_lids != between_lids) continue;
    std::vector<double> xs, ys;
    NamedLine name{{}, line.colour, {}, {}};
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
  add_names(
      plot, names,
      {place_of_text(area.left + 4, model_y, model), {area.left, model_y + 4, area.right, model_y + 8}});
}

}  // namespace

std::string draw(const MethodsPicture& picture) {
  Range seconds, phi[2];
  for (const MethodsPicture::Line& line : picture.lines) {
    for (const MethodsPicture::Point& point : line.points) {
      seconds.take(point.seconds);
      phi[line.between_lids].take(point.phi);
    }
  }
  constexpr double room_for_names = 6, least_seconds = 1e-6;
  const Axis x{round_down(std::max(seconds.from, least_seconds) * 0.9),
               round_down(std::max(seconds.to, least_seconds) * room_for_names),
               "seconds of the processor, one thread", Scale::logarithmic};
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
    panel(plot, picture, between_lids);
    body += std::move(plot).finish();
  }
  return figures::svg_document(picture_width, picture_height, picture.title, body);
}

}  // namespace bernal::cost
