#include "report/drawing.hpp"

#include <array>

#include "viewer/html.hpp"

namespace bernal::drawing {
namespace {

constexpr std::string_view style = R"css(
text { font:13px "Helvetica Neue",Helvetica,Arial,sans-serif; fill:#5d6b7a; }
.label, .title { fill:#1d2733; } .title { font-size:15px; font-weight:600; }
.grid { stroke:#dde3e9; } .axis { stroke:#5d6b7a; fill:none; } .page { fill:#ffffff; }
.line { fill:none; stroke-width:1.8; stroke-linejoin:round; stroke:#2f8ba3; } .heavy { stroke-width:2.8; }
.marker { fill:#b3561d; stroke:#1d2733; stroke-width:1.3; }
.contour { fill:none; stroke:#1d2733; stroke-width:.5; stroke-linecap:round; }
.bold { stroke-width:1.8; }
.halo { fill:#1d2733; stroke:#ffffff; stroke-width:4; paint-order:stroke; stroke-linejoin:round; }
)css";

}  // namespace

std::string svg_document(double width, double height, std::string_view title, std::string_view body) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "role=\"img\" aria-label=\"{2}\">\n<style>{3}</style>\n<rect class=\"page\" width=\"{0}\" "
      "height=\"{1}\"/>\n<text class=\"title\" x=\"{4}\" y=\"26\">{2}</text>\n{5}\n</svg>\n",
      width, height, escaped(title), style, 16, body);
}

void add_disc(Plot& plot, double x, double y) {
  plot.add("<circle class=\"marker\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.2\"/>", x, y);
}

std::string_view series_colour(std::size_t k) {
  // The palette of Okabe & Ito without yellow, which is invisible on white.
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

void add_text(Plot& plot, double x, double y, std::string_view anchor, std::string_view text) {
  plot.add("<text class=\"label\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor,
           escaped(text));
}

}  // namespace bernal::drawing
