#include "io/write_svg.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "io/outline.hpp"
#include "io/palette.hpp"
#include "io/view.hpp"

namespace bernal {
namespace {

constexpr double canvas_size = 1000;
constexpr double narrowest_canvas = 480;  // so much the legend needs
constexpr double margin = 12;
constexpr double legend_height = 52;
constexpr double raster_pitch = 0.5;
constexpr int colour_classes = 9;
constexpr int shade_classes = 8;
constexpr std::uint32_t fewest_visible_points = 2;

/// Maps radii to colour classes, evenly in ln r between the first and the last per cent of the spheres.
class SizeScale {
 public:
  explicit SizeScale(std::vector<double> radii) {
    if (radii.empty()) return;
    std::sort(radii.begin(), radii.end());
    const auto at = [&](double share) {
      return radii[static_cast<std::size_t>(share * static_cast<double>(radii.size() - 1))];
    };
    smallest_ = at(0.01);
    largest_ = at(0.99);
    equal_ = !(largest_ > 1.001 * smallest_);
  }
  bool equal() const { return equal_; }
  double smallest() const { return smallest_; }
  double largest() const { return largest_; }

  int colour_class(double radius) const {
    if (equal_) return colour_classes / 2;
    const double t = std::log(radius / smallest_) / std::log(largest_ / smallest_);
    return std::clamp(static_cast<int>(t * colour_classes), 0, colour_classes - 1);
  }

 private:
  double smallest_ = 1, largest_ = 1;
  bool equal_ = true;
};

struct Ball {
  CanvasPoint center;
  double radius;
  std::uint32_t sphere;
};

/// The spheres as balls on the canvas, farthest first. Disjoint balls painted in the order of their centres'
/// depths hide each other rightly, whatever their sizes: the plane of equal power of two balls separates
/// them, and the eye's side of it is the side of the nearer centre.
std::vector<Ball> balls_back_to_front(const Spheres<dynamic>& spheres, const View& view) {
  std::vector<Ball> balls;
  balls.reserve(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    balls.push_back({view(spheres.center(i)), view.scale() * spheres.r[i], static_cast<std::uint32_t>(i)});
  }
  std::stable_sort(balls.begin(), balls.end(),
                   [](const Ball& a, const Ball& b) { return a.center.depth < b.center.depth; });
  return balls;
}

/// How dark a ball is drawn, in [0, 1]: what stands around it takes light away, and so does a side of the
/// packing that is turned from the light. Both are read off the depths of what can be seen.
class Shading {
 public:
  Shading(const DepthBuffer& depths, double mean_radius) : depths_(depths), patch_(7 * mean_radius) {}

  double operator()(const Ball& ball) const {
    return std::clamp(0.7 * occlusion(ball) + 0.8 * (aversion(ball) - 0.2), 0.0, 1.0);
  }

 private:
  static constexpr int directions = 16;

  double occlusion(const Ball& ball) const {
    double sum = 0;
    for (const double reach : {1.3, 2.2, 3.6}) {
      for (int k = 0; k < directions; ++k) {
        const double distance = reach * ball.radius;
        sum += std::clamp(rise(ball, k, distance) / (1.6 * distance) - 0.1, 0.0, 1.0);
      }
    }
    return sum / (3 * directions);
  }

  /// The patch of the packing around the ball as a tilted plane under a light from the upper left.
  double aversion(const Ball& ball) const {
    Vector<3> normal(0, 0, 1);
    for (int k = 0; k < directions; ++k) {
      const double slope = std::clamp(rise(ball, k, patch_) / patch_, -1.6, 1.6);
      normal[0] -= 2 * slope * std::cos(angle(k)) / directions;
      normal[1] -= 2 * slope * std::sin(angle(k)) / directions;
    }
    const Vector<3> light = Vector<3>(-0.5, -0.75, 0.75).normalized();
    return 0.5 - 0.5 * normal.normalized().dot(light);
  }

  static double angle(int k) { return 2 * std::numbers::pi * (k + 0.5) / directions; }
  /// How much nearer to the eye than the ball is what can be seen beside it.
  double rise(const Ball& ball, int k, double distance) const {
    return depths_.depth(ball.center.x + distance * std::cos(angle(k)),
                         ball.center.y + distance * std::sin(angle(k))) -
           ball.center.depth;
  }

  const DepthBuffer& depths_;
  double patch_;
};

void append_gradients(std::string& out) {
  const Colour day{1, 0.985, 0.95};
  const auto darker = [](const Colour& c, double by) {  // red goes first: shadows are cool
    return Colour{c.red * (1 - 0.80 * by), c.green * (1 - 0.84 * by), c.blue * (1 - 0.66 * by)};
  };
  out += "<defs>\n";
  for (int c = 0; c < colour_classes; ++c) {
    for (int s = 0; s < shade_classes; ++s) {
      const double shade = static_cast<double>(s) / (shade_classes - 1);
      const Colour base = darker(size_colour((c + 0.5) / colour_classes), shade);
      fmt::format_to(std::back_inserter(out),
                     "<radialGradient id=\"bernal{}{}\" cx=\".5\" cy=\".5\" r=\".5\" fx=\".34\" fy=\".27\">"
                     "<stop offset=\"0\" stop-color=\"{}\"/><stop offset=\".3\" stop-color=\"{}\"/>"
                     "<stop offset=\".75\" stop-color=\"{}\"/><stop offset=\"1\" stop-color=\"{}\"/>"
                     "</radialGradient>\n",
                     static_cast<char>('a' + c), s, mix(base, day, 0.55 - 0.35 * shade).text(),
                     mix(base, day, 0.16 * (1 - shade)).text(), darker(base, 0.2).text(),
                     darker(base, 0.65).text());
    }
  }
  out += "</defs>\n";
}

void append_strokes(std::string& out, const std::vector<Stroke>& strokes, bool hidden, double opacity,
                    double width) {
  fmt::format_to(std::back_inserter(out),
                 "<path fill=\"none\" stroke=\"#8590a0\" stroke-opacity=\"{}\" stroke-width=\"{}\" "
                 "stroke-linecap=\"round\" d=\"",
                 opacity, width);
  for (const Stroke& stroke : strokes) {
    if (stroke.hidden != hidden) continue;
    fmt::format_to(std::back_inserter(out), "M{:.1f} {:.1f}L{:.1f} {:.1f}", stroke.from.x, stroke.from.y,
                   stroke.to.x, stroke.to.y);
  }
  out += "\"/>\n";
}

void append_spheres(std::string& out, const Spheres<dynamic>& spheres, const View& view,
                    const SizeScale& sizes) {
  const std::vector<Ball> balls = balls_back_to_front(spheres, view);
  DepthBuffer depths(view.width(), view.height(), raster_pitch);
  for (std::uint32_t k = 0; k < balls.size(); ++k) depths.draw_ball(balls[k].center, balls[k].radius, k);
  std::vector<std::uint32_t> visible_points(balls.size(), 0);
  for (const std::uint32_t k : depths.ids()) {
    if (k != DepthBuffer::nothing) ++visible_points[k];
  }
  const double mean_radius = view.scale() * std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) /
                             static_cast<double>(std::max<std::size_t>(1, spheres.size()));
  const Shading shading(depths, mean_radius);
  // A ball smaller than the raster may be met by none of its points: its centre decides.
  const auto shows = [&](std::size_t k) {
    const Ball& ball = balls[k];
    return visible_points[k] >= fewest_visible_points ||
           (ball.radius < 2 * raster_pitch &&
            depths.depth(ball.center.x, ball.center.y) <= ball.center.depth + ball.radius);
  };
  for (std::size_t k = 0; k < balls.size(); ++k) {
    if (!shows(k)) continue;
    const Ball& ball = balls[k];
    const int shade = std::min(shade_classes - 1, static_cast<int>(shading(ball) * shade_classes));
    fmt::format_to(std::back_inserter(out),
                   "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"url(#bernal{}{})\"/>\n",
                   ball.center.x, ball.center.y, ball.radius,
                   static_cast<char>('a' + sizes.colour_class(spheres.r[ball.sphere])), shade);
  }
}

/// The largest 1, 2 or 5 times a power of ten that is at most `length`.
double round_length(double length) {
  const double decade = std::pow(10, std::floor(std::log10(length)));
  for (const double step : {5.0, 2.0}) {
    if (step * decade <= length) return step * decade;
  }
  return decade;
}

void append_legend(std::string& out, const View& view, const SizeScale& sizes, std::string_view unit,
                   bool any) {
  const double y = view.height() + legend_height / 2;
  const double length = round_length(0.2 * view.width() / view.scale());
  const double bar = length * view.scale();
  fmt::format_to(std::back_inserter(out),
                 "<g font-family=\"system-ui,sans-serif\" font-size=\"17\" fill=\"#8590a0\">\n"
                 "<path d=\"M{0} {1}v10h{2:.1f}v-10\" fill=\"none\" stroke=\"#8590a0\" stroke-width=\"1.6\"/>"
                 "<text x=\"{3:.1f}\" y=\"{4}\">{5:g} {6}</text>\n",
                 margin, y - 5, bar, margin + bar + 10, y + 6, length, unit);
  if (any && sizes.equal()) {
    fmt::format_to(std::back_inserter(out),
                   "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"end\">radius {:.3g} {}</text>\n",
                   view.width() - margin, y + 6, sizes.smallest(), unit);
  } else if (any) {
    constexpr double step = 17;
    const double end = view.width() - margin - 100;
    fmt::format_to(std::back_inserter(out), "<text x=\"{:.1f}\" y=\"{}\">{:.3g} {}</text>\n", end + 8, y + 6,
                   sizes.largest(), unit);
    for (int c = 0; c < colour_classes; ++c) {
      fmt::format_to(std::back_inserter(out),
                     "<circle cx=\"{:.1f}\" cy=\"{}\" r=\"{:.1f}\" fill=\"url(#bernal{}0)\"/>\n",
                     end - step * (colour_classes - c - 0.5), y, 4.0 + 4.0 * c / (colour_classes - 1),
                     static_cast<char>('a' + c));
    }
    fmt::format_to(std::back_inserter(out),
                   "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"end\">radius {:.3g}</text>\n",
                   end - step * colour_classes - 8, y + 6, sizes.smallest());
  }
  out += "</g>\n";
}

}  // namespace

std::string svg_of(const Spheres<dynamic>& spheres, const Domain& domain, std::string_view unit) {
  const Mesh mesh = drawable_mesh(domain);
  const View view(mesh.vertices, canvas_size, margin, narrowest_canvas);
  const SizeScale sizes(spheres.r);
  const std::vector<Stroke> strokes = outline_of(mesh, view);

  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" role=\"img\" "
      "aria-label=\"{2} spheres in their container\">\n",
      view.width(), view.height() + legend_height, spheres.size());
  append_gradients(out);
  append_strokes(out, strokes, true, 0.5, 1);
  append_spheres(out, spheres, view, sizes);
  append_strokes(out, strokes, false, 0.55, 1.2);
  append_legend(out, view, sizes, unit, !spheres.empty());
  out += "</svg>\n";
  return out;
}

}  // namespace bernal
