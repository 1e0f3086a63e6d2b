#include "report/write_svg.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "report/disc_picture.hpp"
#include "report/legend.hpp"
#include "report/outline.hpp"
#include "viewer/palette.hpp"
#include "viewer/view.hpp"

namespace bernal {
namespace {

constexpr double finest_raster = 0.5, coarsest_raster = 1;
constexpr double raster_points_a_radius = 8;
constexpr int shade_classes = 8;
constexpr std::uint32_t fewest_visible_points = 2;

struct Ball {
  CanvasPoint center;
  double radius;
  std::uint32_t sphere;
};

/// The ids of the spheres, nearest centre first. Disjoint balls painted in reverse order hide each other
/// correctly for any sizes: the plane of equal power separates two balls, and the nearer centre is on the
/// eye's side of it.
std::vector<std::uint32_t> front_to_back(const Spheres<dynamic>& spheres) {
  std::vector<std::pair<double, std::uint32_t>> order;
  order.reserve(spheres.size());
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    const Vector<3> c(spheres.x[0][i], spheres.x[1][i], spheres.x[2][i]);
    order.emplace_back(-c.dot(View::towards_eye()), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> ids;
  ids.reserve(order.size());
  for (const auto& [depth, id] : order) ids.push_back(id);
  return ids;
}

/// Draws the spheres and returns those that may be visible, nearest first; the k-th of them has the id k in
/// the buffer.
std::vector<Ball> draw(const Spheres<dynamic>& spheres, const View& view, DepthBuffer& depths) {
  std::vector<Ball> balls;
  for (const std::uint32_t i : front_to_back(spheres)) {
    const Ball ball{view(spheres.center(i)), view.scale() * spheres.r[i], i};
    if (depths.hides_ball(ball.center, ball.radius)) continue;
    depths.draw_ball(ball.center, ball.radius, static_cast<std::uint32_t>(balls.size()));
    balls.push_back(ball);
  }
  return balls;
}

/// Darkness of a ball, in [0, 1]: from occlusion by its surroundings, and from the orientation of the
/// packing's surface to the light. Both are computed from the visible depths.
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

  /// The packing's surface around the ball as a plane lit from the upper left.
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
  /// How much nearer to the eye than the ball the visible surface beside it is.
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
  const auto darker = [](const Colour& c, double by) {  // red first: shadows are cool
    return Colour{c.red * (1 - 0.80 * by), c.green * (1 - 0.84 * by), c.blue * (1 - 0.66 * by)};
  };
  out += "<defs>\n";
  for (int c = 0; c < colour_classes; ++c) {
    for (int s = 0; s < shade_classes; ++s) {
      const double shade = static_cast<double>(s) / (shade_classes - 1);
      const Colour base = darker(size_colour((c + 0.5) / colour_classes), shade);
      out += fmt::format(
          "<radialGradient id=\"bernal{}{}\" cx=\".5\" cy=\".5\" r=\".5\" fx=\".34\" fy=\".27\">"
          "<stop offset=\"0\" stop-color=\"{}\"/><stop offset=\".3\" stop-color=\"{}\"/>"
          "<stop offset=\".75\" stop-color=\"{}\"/><stop offset=\"1\" stop-color=\"{}\"/>"
          "</radialGradient>\n",
          static_cast<char>('a' + c), s, mix(base, day, 0.55 - 0.35 * shade).text(),
          mix(base, day, 0.16 * (1 - shade)).text(), darker(base, 0.2).text(), darker(base, 0.65).text());
    }
  }
  out += "</defs>\n";
}

void append_strokes(std::string& out, const std::vector<Stroke>& strokes, bool hidden, double opacity,
                    double width) {
  out += fmt::format(
      "<path fill=\"none\" stroke=\"#8590a0\" stroke-opacity=\"{}\" stroke-width=\"{}\" "
      "stroke-linecap=\"round\" d=\"",
      opacity, width);
  for (const Stroke& stroke : strokes) {
    if (stroke.hidden != hidden) continue;
    out +=
        fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", stroke.from.x, stroke.from.y, stroke.to.x, stroke.to.y);
  }
  out += "\"/>\n";
}

void append_spheres(std::string& out, const Spheres<dynamic>& spheres, const View& view,
                    const SizeScale& sizes) {
  const double mean_radius = view.scale() * std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) /
                             static_cast<double>(std::max<std::size_t>(1, spheres.size()));
  const double pitch = std::clamp(mean_radius / raster_points_a_radius, finest_raster, coarsest_raster);
  DepthBuffer depths(view.width(), view.height(), pitch);
  const std::vector<Ball> balls = draw(spheres, view, depths);
  std::vector<std::uint32_t> visible_points(balls.size(), 0);
  for (const std::uint32_t k : depths.ids()) {
    if (k != DepthBuffer::nothing) ++visible_points[k];
  }
  const Shading shading(depths, mean_radius);
  // A ball smaller than the raster may contain no raster point: then its centre decides.
  const auto shows = [&](std::size_t k) {
    const Ball& ball = balls[k];
    return visible_points[k] >= fewest_visible_points ||
           (ball.radius < 2 * pitch &&
            depths.depth(ball.center.x, ball.center.y) <= ball.center.depth + ball.radius);
  };
  for (std::size_t k = balls.size(); k-- > 0;) {
    if (!shows(k)) continue;
    const Ball& ball = balls[k];
    const int shade = std::min(shade_classes - 1, static_cast<int>(shading(ball) * shade_classes));
    out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"url(#bernal{}{})\"/>\n",
                       ball.center.x, ball.center.y, ball.radius,
                       static_cast<char>('a' + sizes.colour_class(spheres.r[ball.sphere])), shade);
  }
}

/// The points that must fit on the canvas: the domain, and spheres that protrude from the period.
std::vector<Vector<3>> corners_of(const Mesh& mesh, const Domain& domain, const Spheres<dynamic>& spheres) {
  if (!is_periodic(domain) || spheres.empty()) return mesh.vertices;
  const Vector<3> middle = bounds_of(domain).center();
  const TiltedBoundary<3> boundary = tilted_boundary_of<3>(domain);
  Vector<3> out = Vector<3>::Constant(std::ranges::max(spheres.r));
  for (int k = 0; k < 3; ++k)
    if (!boundary.repeats(k)) out[k] = 0;
  std::vector<Vector<3>> corners;
  if (boundary.is_tilted()) {  // whose corners may lie on any side of the middle
    for (const Vector<3>& v : mesh.vertices)
      for (int sides = 0; sides < 8; ++sides)
        corners.push_back(v + Vector<3>(sides & 1 ? out[0] : -out[0], sides & 2 ? out[1] : -out[1],
                                        sides & 4 ? out[2] : -out[2]));
    return corners;
  }
  for (const Vector<3>& v : mesh.vertices)
    corners.push_back((v.array() > middle.array()).select(v + out, v - out));
  return corners;
}

/// The images in the cell of the spheres of a tilted box.
Spheres<dynamic> in_cell(Spheres<dynamic> spheres, const Box& box) {
  const TiltedBoundary<3> cell(Vector<3>(box.size), box.tilt);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vector<3> shares = cell.in_cell_vectors(Vector<3>(spheres.center(i)) - Vector<3>(box.corner));
    Vector<3> center = spheres.center(i);
    for (int axis = 0; axis < 3; ++axis) center -= std::floor(shares[axis]) * cell.cell_vector(axis);
    spheres.set_center(i, center);
  }
  return spheres;
}

/// For more spheres in a box a corner with about `in_corner` is shown; more could not be distinguished.
constexpr std::size_t most_in_box = 2'000'000, in_corner = 200'000;

/// The spheres of a corner of the box, and its edges, `part` times those of the box.
std::pair<Spheres<dynamic>, Box> corner_of(const Spheres<dynamic>& spheres, const Box& box, double part) {
  Box corner = box;
  corner.size *= part;
  corner.tilt = {};  // of the brick, which is a period of a tilted box, too
  Spheres<dynamic> there(3);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    bool inside = true;
    for (int k = 0; k < 3; ++k)
      inside = inside && spheres.x[static_cast<std::size_t>(k)][i] - box.corner[k] < corner.size[k];
    if (inside) there.push_back(spheres.center(i), spheres.r[i]);
  }
  return {std::move(there), std::move(corner)};
}

std::string solid_svg(const Spheres<dynamic>& given, const Domain& domain, std::string_view unit,
                      const std::string& remark = {}) {
  if (const auto* box = std::get_if<Box>(&domain); box && given.size() > most_in_box) {
    const double part = std::cbrt(static_cast<double>(in_corner) / static_cast<double>(given.size()));
    const auto [there, corner] = corner_of(given, *box, part);
    return solid_svg(there, corner, unit, fmt::format("a corner of the box, {:.2g} of its edges", part));
  }
  const Spheres<dynamic> moved =
      is_tilted(domain) ? in_cell(given, std::get<Box>(domain)) : Spheres<dynamic>(3);
  const Spheres<dynamic>& spheres = is_tilted(domain) ? moved : given;
  const Mesh mesh = drawable_mesh(domain);
  const View view(corners_of(mesh, domain, spheres), canvas_size, canvas_margin, narrowest_canvas);
  const SizeScale sizes(spheres.r);
  const std::vector<Stroke> strokes = outline_of(mesh, view);
  const bool periodic = is_periodic(domain);  // spheres protrude and hide its edges

  std::string out = svg_head(view.width(), view.height(), spheres.size());
  append_gradients(out);
  append_strokes(out, strokes, true, 0.5, 1);
  append_spheres(out, spheres, view, sizes);
  append_strokes(out, strokes, false, periodic ? 0.95 : 0.55, periodic ? 1.8 : 1.2);
  if (!remark.empty()) append_words(out, view.width() / 2, view.height() + legend_height / 2 + 6, 17, remark);
  append_legend(out, {view.width(), view.height(), view.scale()}, sizes, unit,
                [](int colour) { return fmt::format("url(#bernal{}0)", static_cast<char>('a' + colour)); });
  out += "</svg>\n";
  return out;
}

constexpr double most_discs = 20'000;

/// All discs in a polygon. Cost: O(N).
std::string disc_svg(const Spheres<dynamic>& spheres, const Polygon& polygon, std::string_view unit) {
  const Bounds<dynamic> bounds = bounds_of<dynamic>(polygon);
  DiscPicture picture{{}, polygon.loops, {bounds.lower, bounds.upper}};
  for (std::size_t i = 0; i < spheres.size(); ++i)
    picture.discs.push_back({spheres.center(i), spheres.r[i], spheres.r[i]});
  return svg_of(picture, SizeScale(spheres.r), spheres.size(), unit);
}

/// Discs in a tilted box: those in its cell, images that reach into it, and faintly the parts beyond it.
std::string tilted_disc_svg(const Spheres<dynamic>& spheres, const Box& box, std::string_view unit) {
  TiltedBoundary<2> cell(Vector<2>(box.size), box.tilt);
  cell.origin = box.corner;
  const Vector<2> a = cell.cell_vector(0), b = cell.cell_vector(1);
  // Between opposite sides.
  const Vector<2> heights(a[0] * b[1] / b.norm(), b[1]);
  const Vector<2> lower(std::min(0.0, b[0]), 0), upper(a[0] + std::max(0.0, b[0]), b[1]);
  DiscPicture picture{{}, {{{0, 0}, a, a + b, b}}, {lower, upper}};
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vector<2> reach = Vector<2>::Constant(spheres.r[i]).cwiseQuotient(heights);
    Vector<2> shares = cell.in_cell_vectors(Vector<2>(spheres.center(i)));
    for (double& share : shares) share -= std::floor(share);
    const int across = static_cast<int>(std::ceil(reach[0])), along = static_cast<int>(std::ceil(reach[1]));
    for (int row = -along; row <= along; ++row)
      for (int column = -across; column <= across; ++column) {
        const Vector<2> there = shares + Vector<2>(column, row);
        if ((there + reach).minCoeff() <= 0 || (there - reach).maxCoeff() >= 1) continue;
        const bool sticks_out = (there - reach).minCoeff() < 0 || (there + reach).maxCoeff() > 1;
        picture.discs.push_back({there[0] * a + there[1] * b, spheres.r[i], spheres.r[i], sticks_out});
      }
  }
  return svg_of(picture, SizeScale(spheres.r), spheres.size(), unit);
}

/// Discs in a box of two dimensions: those in it, images that reach into it, and faintly the parts beyond it.
/// For very many discs a part of the box is shown, as the key says. Precondition: two dimensions, centres in
/// one period. Cost: O(N).
std::string disc_svg(const Spheres<dynamic>& spheres, const Box& box, std::string_view unit) {
  const auto n = static_cast<double>(spheres.size());
  const double part = n > most_discs ? std::sqrt(most_discs / n) : 1;
  if (box.is_tilted() && part == 1) return tilted_disc_svg(spheres, box, unit);
  const Vector<2> window = part * Vector<2>(box.size);
  DiscPicture picture{{}, {{{0, 0}, {window[0], 0}, window, {0, window[1]}}}, {Vector<2>::Zero(), window}};
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i];
    const int across = box.is_tilted() ? 5 : 3;  // rows of a tilted box are shifted against each other
    for (int image = 0; image < 3 * across; ++image) {
      const int column = image % across - across / 2, row = image / across - 1;
      if ((box.has_wall(0) && column != 0) || (box.has_wall(1) && row != 0)) continue;
      const Vector<2> c(spheres.x[0][i] - box.corner[0] + column * box.size[0] +
                            row * std::remainder(box.tilt[0], box.size[0]),
                        spheres.x[1][i] - box.corner[1] + row * box.size[1]);
      if ((c.array() + r <= 0).any() || (c.array() - r >= window.array()).any()) continue;
      const bool sticks_out = (c.array() < r).any() || (c.array() + r > window.array()).any();
      picture.discs.push_back({c, r, r, sticks_out && (part < 1 || box.repeats())});
    }
  }
  if (part < 1) picture.remark = fmt::format("a corner of the box, {:.2g} of its edges", part);
  return svg_of(picture, SizeScale(spheres.r), spheres.size(), unit);
}

}  // namespace

std::string svg_of(const Spheres<dynamic>& spheres, const Domain& domain, std::string_view unit) {
  switch (spheres.dimension()) {
    case 2:
      if (const auto* polygon = std::get_if<Polygon>(&domain)) return disc_svg(spheres, *polygon, unit);
      return disc_svg(spheres, std::get<Box>(domain), unit);
    case 3:
      return solid_svg(spheres, domain, unit);
    default:
      return {};
  }
}

}  // namespace bernal
