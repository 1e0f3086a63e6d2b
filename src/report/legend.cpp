#include "report/legend.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "viewer/html.hpp"

namespace bernal {

SizeScale::SizeScale(const std::vector<double>& radii) : empty_(radii.empty()) {
  if (radii.empty()) return;
  smallest_ = std::ranges::min(radii);
  largest_ = std::ranges::max(radii);
  equal_ = !(largest_ > 1.001 * smallest_);
}

int SizeScale::colour_class(double radius) const {
  if (equal_) return colour_classes / 2;
  const double t = std::log(radius / smallest_) / std::log(largest_ / smallest_);
  return std::clamp(static_cast<int>(t * colour_classes), 0, colour_classes - 1);
}

std::string svg_head(double width, double height, std::size_t spheres) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" role=\"img\" "
      "aria-label=\"{2} spheres in their container\">\n",
      width, height + legend_height, spheres);
}

namespace {

/// The largest 1, 2 or 5 times a power of ten that is at most `length`.
double round_length(double length) {
  const double decade = std::pow(10, std::floor(std::log10(length)));
  for (const double step : {5.0, 2.0}) {
    if (step * decade <= length) return step * decade;
  }
  return decade;
}

/// Most words of the legend are narrower.
double width_of(std::string_view words) { return 9.5 * static_cast<double>(words.size()); }

}  // namespace

void append_words(std::string& out, double x, double y, double size, std::string_view words) {
  out += fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-family=\"system-ui,sans-serif\" "
      "font-size=\"{}\" fill=\"{}\">{}</text>\n",
      x, y, size, line_grey, escaped(words));
}

void append_legend(std::string& out, const Canvas& canvas, const SizeScale& sizes, std::string_view unit,
                   const std::function<std::string(int)>& fill) {
  const double y = canvas.height + legend_height / 2;
  const auto size = [&](double r) {  // with enough digits to distinguish the two
    const bool same = fmt::format("{:.3g}", sizes.smallest()) == fmt::format("{:.3g}", sizes.largest());
    return fmt::format("{:.{}g}", r, same ? 5 : 3);
  };
  constexpr double step = 17, shortest_bar = 10;
  const double end = canvas.width - canvas_margin - 100, behind_words = end - step * colour_classes - 8;
  const std::string words = sizes.empty() || sizes.equal() ? "" : "radius " + size(sizes.smallest());
  // Beside the words of a narrow picture there is room for a shorter bar only.
  double length = round_length(0.2 * canvas.width / canvas.scale);
  const auto overlaps = [&] {
    const double label = width_of(fmt::format("{:g} {}", length, unit)) + 22;
    return canvas_margin + length * canvas.scale + label > behind_words - width_of(words);
  };
  while (!words.empty() && overlaps() && length * canvas.scale > 2.5 * shortest_bar)
    length = round_length(0.99 * length);
  const double bar = length * canvas.scale;
  out += fmt::format(
      "<g font-family=\"system-ui,sans-serif\" font-size=\"17\" fill=\"#8590a0\">\n"
      "<path d=\"M{0} {1}v10h{2:.1f}v-10\" fill=\"none\" stroke=\"#8590a0\" stroke-width=\"1.6\"/>"
      "<text x=\"{3:.1f}\" y=\"{4}\">{5:g} {6}</text>\n",
      canvas_margin, y - 5, bar, canvas_margin + bar + 10, y + 6, length, unit);
  if (!sizes.empty() && sizes.equal()) {
    out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"end\">radius {:.3g} {}</text>\n",
                       canvas.width - canvas_margin, y + 6, sizes.smallest(), unit);
  } else if (!sizes.empty()) {
    out += fmt::format("<text x=\"{:.1f}\" y=\"{}\">{} {}</text>\n", end + 8, y + 6, size(sizes.largest()),
                       unit);
    for (int c = 0; c < colour_classes; ++c) {
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{}\" r=\"{:.1f}\" fill=\"{}\"/>\n",
                         end - step * (colour_classes - c - 0.5), y, 4.0 + 4.0 * c / (colour_classes - 1),
                         fill(c));
    }
    out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", behind_words, y + 6,
                       words);
  }
  out += "</g>\n";
}

}  // namespace bernal
