#include "figures/section.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "io/legend.hpp"
#include "io/palette.hpp"

namespace bernal::figures {

std::vector<CutCircle> cut_circles(const Spheres<dynamic>& spheres, const Box& box, int axis, double height) {
  const std::array<int, 2> others = axis == 0   ? std::array{1, 2}
                                    : axis == 1 ? std::array{0, 2}
                                                : std::array{0, 1};
  const auto images = [&](int k, double x, double r, double from, double to) {
    std::vector<double> places;
    const double period = box.size[k];
    const int most = box.repeats(k) ? 1 + static_cast<int>(std::ceil(r / period)) : 0;
    for (int n = -most; n <= most; ++n)
      if (x + n * period + r > from && x + n * period - r < to) places.push_back(x + n * period);
    return places;
  };
  std::vector<CutCircle> circles;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i];
    const auto at = [&](int k) { return spheres.x[static_cast<std::size_t>(k)][i]; };
    for (const double along : images(axis, at(axis), r, height, height)) {
      const double squared = r * r - (along - height) * (along - height);
      if (!(squared > 0)) continue;
      const double cut = std::sqrt(squared);
      const auto seen = [&](int k) { return images(k, at(k) - box.corner[k], cut, 0, box.size[k]); };
      for (const double x : seen(others[0]))
        for (const double y : seen(others[1])) circles.push_back({Vector<2>(x, y), cut, i});
    }
  }
  return circles;
}

std::string section_svg(const Spheres<dynamic>& spheres, const Box& box, double width) {
  const SizeScale sizes(spheres.r);
  const double scale = width / box.size[0], tall = scale * box.size[1];
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-1 -1 {0:.1f} {1:.1f}\">\n<clipPath "
      "id=\"bernalsection\"><rect width=\"{2:.1f}\" height=\"{3:.1f}\"/></clipPath>\n<g "
      "clip-path=\"url(#bernalsection)\" stroke=\"#1d2733\" stroke-width=\".5\">\n",
      width + 2, tall + 2, width, tall);
  for (const CutCircle& c : cut_circles(spheres, box, 2, box.corner[2] + 0.5 * box.size[2]))
    out += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" fill=\"{}\"/>\n",
                       scale * c.center[0], tall - scale * c.center[1], scale * c.radius,
                       size_colour((sizes.colour_class(spheres.r[c.sphere]) + 0.5) / colour_classes).text());
  return out +
         fmt::format(
             "</g>\n<rect width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"#1d2733\"/>\n</svg>\n",
             width, tall);
}

}  // namespace bernal::figures
