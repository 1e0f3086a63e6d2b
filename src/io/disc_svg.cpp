#include "io/disc_svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "io/legend.hpp"
#include "io/palette.hpp"

namespace bernal {
namespace {

constexpr double most_discs = 20'000;
constexpr double farthest_out = 0.06;  // of the canvas, for what sticks out of the box

struct Disc {
  Vector<2> center;
  double radius;
};

std::string fill_of(int colour_class) { return size_colour((colour_class + 0.5) / colour_classes).text(); }

/// One group a colour class: the discs' own tags stay short.
using ByColour = std::array<std::vector<Disc>, colour_classes>;

void append_discs(std::string& out, const ByColour& discs, double rim) {
  for (int c = 0; c < colour_classes; ++c) {
    if (discs[static_cast<std::size_t>(c)].empty()) continue;
    const Colour colour = size_colour((c + 0.5) / colour_classes);
    out += fmt::format("<g fill=\"{}\" stroke=\"{}\" stroke-width=\"{:.2f}\">\n", colour.text(),
                       mix(colour, Colour{}, 0.45).text(), rim);
    for (const Disc& disc : discs[static_cast<std::size_t>(c)]) {
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.2f}\"/>\n", disc.center[0],
                         disc.center[1], std::max(0.0, disc.radius - rim / 2));
    }
    out += "</g>\n";
  }
}

}  // namespace

std::string disc_svg(const Spheres<dynamic>& spheres, const Box& box, std::string_view unit) {
  const SizeScale sizes(spheres.r);
  const auto n = static_cast<double>(spheres.size());
  const double part = n > most_discs ? std::sqrt(most_discs / n) : 1;
  const Vector<2> window = part * Vector<2>(box.size);
  const double largest = spheres.empty() ? 0 : std::ranges::max(spheres.r);

  const double border = std::min(farthest_out, largest / window.maxCoeff()) * canvas_size + canvas_margin;
  const double scale = (canvas_size - 2 * border) / window.maxCoeff();
  const Canvas canvas{std::max(narrowest_canvas, scale * window[0] + 2 * border),
                      scale * window[1] + 2 * border, scale};
  const Vector<2> corner(0.5 * (canvas.width - scale * window[0]), border);  // upper left

  ByColour inside, across;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i];
    const auto colour = static_cast<std::size_t>(sizes.colour_class(r));
    for (int image = 0; image < 9; ++image) {
      if ((box.has_wall(0) && image % 3 != 1) || (box.has_wall(1) && image / 3 != 1)) continue;
      const Vector<2> c(spheres.x[0][i] - box.corner[0] + (image % 3 - 1) * box.size[0],
                        spheres.x[1][i] - box.corner[1] + (image / 3 - 1) * box.size[1]);
      if ((c.array() + r <= 0).any() || (c.array() - r >= window.array()).any()) continue;
      const Disc disc{corner + scale * Vector<2>(c[0], window[1] - c[1]), scale * r};
      inside[colour].push_back(disc);
      if ((c.array() < r).any() || (c.array() + r > window.array()).any()) across[colour].push_back(disc);
    }
  }

  const double rim = std::clamp(0.06 * scale * sizes.smallest(), 0.1, 1.2);
  std::string out = svg_head(canvas.width, canvas.height, spheres.size());
  const std::string frame = fmt::format("x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"",
                                        corner[0], corner[1], scale * window[0], scale * window[1]);
  out += fmt::format("<clipPath id=\"bernalbox\"><rect {}/></clipPath>\n<g opacity=\"0.25\">\n", frame);
  append_discs(out, across, rim);
  out += "</g>\n<g clip-path=\"url(#bernalbox)\">\n";
  append_discs(out, inside, rim);
  out += fmt::format("</g>\n<rect {} fill=\"none\" stroke=\"#8590a0\" stroke-width=\"1.6\"/>\n", frame);
  if (part < 1) {
    out += fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-family=\"system-ui,sans-serif\" "
        "font-size=\"17\" fill=\"#8590a0\">a corner of the box, {:.2g} of its edges</text>\n",
        canvas.width / 2, canvas.height + legend_height / 2 + 6, part);
  }
  append_legend(out, canvas, sizes, unit, fill_of);
  out += "</svg>\n";
  return out;
}

}  // namespace bernal
