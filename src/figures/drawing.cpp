#include "figures/drawing.hpp"

#include <array>
#include <cmath>

#include "io/html_text.hpp"

namespace bernal::figures {
namespace {

constexpr std::string_view style = R"css(
text { font:13px "Helvetica Neue",Helvetica,Arial,sans-serif; fill:#5d6b7a; }
.label, .title { fill:#1d2733; } .title { font-size:15px; font-weight:600; }
.grid { stroke:#dde3e9; } .axis { stroke:#5d6b7a; fill:none; } .page { fill:#ffffff; }
.line { fill:none; stroke-width:1.8; stroke-linejoin:round; stroke:#2f8ba3; }
.heavy { stroke-width:2.8; } .thin { stroke-width:1.1; }
.dashed { stroke-dasharray:7 4; } .dotdash { stroke-dasharray:9 3 2 3; }
.one { stroke:#1d2733; } .two { stroke:#2f8ba3; } .three { stroke:#3a3f8f; } .four { stroke:#b3561d; }
circle.line { stroke:#ffffff; stroke-width:1; } circle.one { fill:#1d2733; } circle.two { fill:#2f8ba3; }
circle.three { fill:#3a3f8f; } circle.four { fill:#b3561d; }
.bar { fill:#8fcdb8; stroke:#ffffff; stroke-width:.6; }
.marker { stroke:#1d2733; stroke-width:1.3; } .triangle { fill:#ffffff; } .disc { fill:#b3561d; } .ring { fill:#ffffff; }
.contour { fill:none; stroke:#1d2733; stroke-width:.5; stroke-linecap:round; }
.bold { stroke-width:1.8; }
.halo { fill:#1d2733; stroke:#ffffff; stroke-width:4; paint-order:stroke; stroke-linejoin:round; }
)css";

void draw_marker(Plot& plot, Marker marker, double x, double y) {
  if (marker == Marker::triangle)
    plot.add("<path class=\"marker triangle\" d=\"M{:.1f} {:.1f}l5.2 9h-10.4z\"/>", x, y - 6);
  else
    plot.add("<circle class=\"marker {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.2\"/>",
             marker == Marker::disc ? "disc" : "ring", x, y);
}

}  // namespace

std::string svg_document(double width, double height, std::string_view title, std::string_view body) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "role=\"img\" aria-label=\"{2}\">\n<style>{3}</style>\n<rect class=\"page\" width=\"{0}\" "
      "height=\"{1}\"/>\n<text class=\"title\" x=\"{4}\" y=\"26\">{2}</text>\n{5}\n</svg>\n",
      width, height, escaped(title), style, 16, body);
}

void legend_line(Plot& plot, double x, double y, std::string_view classes, std::string_view text) {
  plot.add("<path class=\"{}\" d=\"M{:.1f} {:.1f}h34\"/>", classes, x, y - 4);
  add_text(plot, x + 42, y, "start", text);
}

void add_marker(Plot& plot, Marker marker, double x, double y) {
  draw_marker(plot, marker, plot.x(x), plot.y(y));
}

void legend_marker(Plot& plot, Marker marker, double x, double y, std::string_view text) {
  draw_marker(plot, marker, x + 17, y - 4);
  add_text(plot, x + 42, y, "start", text);
}

std::string_view series_colour(std::size_t k) {
  // Okabe & Ito's, but for yellow, which is none on white.
  constexpr std::array<std::string_view, 6> colours = {"#0072b2", "#d55e00", "#009e73",
                                                       "#cc79a7", "#56b4e9", "#e69f00"};
  return colours[k % colours.size()];
}

std::string shape(std::size_t k, double x, double y, double r, std::string_view style) {
  constexpr std::size_t shapes = 4;
  switch (k % shapes) {
    case 0:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" {}/>", x, y, r, style);
    case 1:
      return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>",
                         x - 0.85 * r, y - 0.85 * r, 1.7 * r, 1.7 * r, style);
    case 2:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}h{:.1f}z\" {}/>", x, y - 1.1 * r, 1.1 * r,
                         1.9 * r, -2.2 * r, style);
    default:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}h{:.1f}z\" {}/>", x, y + 1.1 * r, 1.1 * r,
                         -1.9 * r, -2.2 * r, style);
  }
}

void add_error_bar(Plot& plot, double x, double y, double error) {
  plot.add("<path class=\"marker\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", plot.x(x), plot.y(y - error),
           plot.y(y + error));
}

void add_curve(Plot& plot, std::span<const double> xs, std::span<const double> ys, std::string_view classes) {
  plot.line(xs, ys, classes);
  for (std::size_t k = 0; k < xs.size(); ++k)
    plot.add("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>", classes, plot.x(xs[k]),
             plot.y(ys[k]));
}

std::string nested_svg(std::string svg, double x, double y, double width, double height) {
  constexpr std::string_view tag = "<svg";
  const std::size_t at = svg.find(tag);
  if (at == svg.npos) return {};
  return svg.insert(
      at + tag.size(),
      fmt::format(" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"", x, y, width, height));
}

void add_text(Plot& plot, double x, double y, std::string_view anchor, std::string_view text) {
  plot.add("<text class=\"label\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor,
           escaped(text));
}

std::vector<double> spread(double from, double to, int steps, bool logarithmic) {
  std::vector<double> values;
  for (int k = 0; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    values.push_back(logarithmic ? from * std::pow(to / from, share) : from + (to - from) * share);
  }
  values.back() = to;
  return values;
}

}  // namespace bernal::figures
