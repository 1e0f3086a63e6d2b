#include "report/disc_picture.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "viewer/palette.hpp"

namespace bernal {
namespace {

constexpr double farthest_out = 0.06;  // of the canvas, for discs beyond the outline
constexpr double caption_height = 36;

std::string flat_fill(int colour_class) { return size_colour((colour_class + 0.5) / colour_classes).text(); }

/// One group a colour class keeps the tags of discs short.
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

std::string svg_of(const DiscPicture& picture, const SizeScale& sizes, std::size_t spheres,
                   std::string_view unit) {
  const Vector<2> size = picture.window.size();
  double largest = 0;  // of those beyond the outline
  for (const Disc& disc : picture.discs)
    if (disc.sticks_out) largest = std::max(largest, disc.radius);
  const bool clipped = largest > 0;
  const double out_of_it = std::min(farthest_out, largest / size.maxCoeff());
  const double beyond = out_of_it * canvas_size;  // an inner picture clips what extends farther
  const double border = beyond + canvas_margin;
  const double scale = (canvas_size - 2 * border) / size.maxCoeff();
  const double top = border + (picture.caption.empty() ? 0 : caption_height);
  const Canvas canvas{std::max(narrowest_canvas, scale * size[0] + 2 * border),
                      scale * size[1] + top + border, scale};
  const double left = 0.5 * (canvas.width - scale * size[0]);
  const auto place = [&](const Vector<2>& p) {
    return Vector<2>(left + scale * (p[0] - picture.window.lower[0]),
                     top + scale * (picture.window.upper[1] - p[1]));
  };

  ByColour inside, across;
  for (const Disc& disc : picture.discs) {
    const auto colour = static_cast<std::size_t>(sizes.colour_class(disc.sphere_radius));
    inside[colour].push_back({place(disc.center), scale * disc.radius, disc.sphere_radius});
    if (disc.sticks_out) across[colour].push_back(inside[colour].back());
  }
  std::string path;
  for (const Loop& loop : picture.outline) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector<2> p = place(loop[k]);
      path += fmt::format("{}{:.2f} {:.2f}", k == 0 ? "M" : "L", p[0], p[1]);
    }
    if (!loop.empty()) path += "Z";
  }

  const double rim = std::clamp(0.06 * scale * sizes.smallest(), 0.1, 1.2);
  std::string out = svg_head(canvas.width, canvas.height, spheres);
  if (clipped) {
    out += fmt::format(
        "<clipPath id=\"bernalbox\"><path clip-rule=\"evenodd\" d=\"{0}\"/></clipPath>\n"
        "<svg x=\"{1:.2f}\" y=\"{2:.2f}\" width=\"{3:.2f}\" height=\"{4:.2f}\" "
        "viewBox=\"{1:.2f} {2:.2f} {3:.2f} {4:.2f}\"><g opacity=\"0.25\">\n",
        path, left - beyond, top - beyond, scale * size[0] + 2 * beyond, scale * size[1] + 2 * beyond);
    append_discs(out, across, rim);
    out += "</g></svg>\n<g clip-path=\"url(#bernalbox)\">\n";
  } else {
    out += "<g>\n";
  }
  append_discs(out, inside, rim);
  out += fmt::format("</g>\n<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>\n", path,
                     line_grey);
  if (!picture.caption.empty()) append_words(out, canvas.width / 2, caption_height - 8, 19, picture.caption);
  if (!picture.remark.empty())
    append_words(out, canvas.width / 2, canvas.height + legend_height / 2 + 6, 17, picture.remark);
  append_legend(out, canvas, sizes, unit, flat_fill);
  out += "</svg>\n";
  return out;
}

}  // namespace bernal
