#include "bernal/report/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "cad/repair/plane_cut.hpp"
#include "files/csv_headings.hpp"
#include "report/disc_picture.hpp"
#include "report/section_outline.hpp"

namespace bernal {
namespace {

/// Relative to the area of a circle.
constexpr double rounding = 1e-9;

/// The normal may have any length; also chooses the picture's axes.
SectionPlane plane_across(const Vector<3>& normal, double offset, std::string text) {
  SectionPlane plane;
  const double length = normal.stableNorm();
  plane.normal = normal / length;
  plane.offset = offset / length;
  plane.text = std::move(text);
  const Vector<3> up = Vector<3>::UnitZ() - plane.normal[2] * plane.normal;
  plane.up = up.norm() > 1e-6 ? Vector<3>(up.normalized()) : Vector<3>::UnitY();
  plane.right = plane.up.cross(plane.normal).normalized();
  // Seen from the side where x, or else y, runs to the right.
  if (plane.right[0] < 0 || (plane.right[0] == 0 && plane.right[1] < 0)) plane.right = -plane.right;
  return plane;
}

SectionPlane plane_across_axis(int axis, double place) {
  return plane_across(Vector<3>::Unit(axis), place, fmt::format("{} = {:.6g}", "xyz"[axis], place + 0.0));
}

int axis_of_middle(const Domain& domain) {
  const auto* box = std::get_if<Box>(&domain);
  if (!box || !box->repeats()) return 1;
  if (!box->has_walls()) return 2;
  return box->has_wall(0) || box->has_wall(2) ? 1 : 0;
}

/// Half-way along the facet that extends farthest along the axis: a plane there cuts the surface.
double where_it_is_cut(const Mesh& mesh, int axis) {
  double widest = -1, place = 0;
  for (const auto& t : mesh.triangles) {
    const auto [low, high] =
        std::minmax({mesh.vertices[t[0]][axis], mesh.vertices[t[1]][axis], mesh.vertices[t[2]][axis]});
    if (!(high - low > widest)) continue;
    widest = high - low;
    place = low + 0.5 * widest;
  }
  return place;
}

/// So many periods along each axis; in a tilted box as nearly so as its layers allow.
Vector<3> shift_of(const TiltedBoundary<3>& boundary, const Vector<3>& turns) {
  Vector<3> shift = turns.cwiseProduct(boundary.edges);
  if (!boundary.is_tilted()) return shift;
  for (int k = 2; k > 0; --k)
    for (int j = 0; j < k; ++j) shift[j] += turns[k] * boundary.along(k, j);
  // Whole cell vectors of lower axes make up for what the higher ones have moved it.
  const double rows = std::nearbyint((shift[1] - turns[1] * boundary.edges[1]) / boundary.edges[1]);
  shift -= rows * boundary.cell_vector(1);
  shift[0] -=
      boundary.edges[0] * std::nearbyint((shift[0] - turns[0] * boundary.edges[0]) / boundary.edges[0]);
  return shift;
}

/// Calls visit(shift) for the shifts by whole periods that can bring a sphere of this radius, with its centre
/// in one period, into it. The layers of a tilted box are shifted by up to half an edge against each other.
template <class Visit>
void for_each_shift(const TiltedBoundary<3>& boundary, double radius, Visit&& visit) {
  int most[3];
  for (int k = 0; k < 3; ++k)
    most[k] = boundary.repeats(k) ? static_cast<int>(std::min(50.0, std::ceil(radius / boundary.edges[k]))) +
                                        (boundary.is_tilted() && k < 2 ? 1 : 0)
                                  : 0;
  for (int x = -most[0]; x <= most[0]; ++x)
    for (int y = -most[1]; y <= most[1]; ++y)
      for (int z = -most[2]; z <= most[2]; ++z) visit(shift_of(boundary, {1.0 * x, 1.0 * y, 1.0 * z}));
}

Bounds<2> bounds_of_loops(const std::vector<Loop>& loops) {
  Bounds<2> bounds{loops.front().front(), loops.front().front()};
  for (const Loop& loop : loops) {
    for (const Vector<2>& p : loop) {
      bounds.lower = bounds.lower.cwiseMin(p);
      bounds.upper = bounds.upper.cwiseMax(p);
    }
  }
  return bounds;
}

}  // namespace

SectionPlane section_plane(std::string_view text) {
  const cad::CutPlane plane = [&] {
    try {
      return cad::plane_in(text);
    } catch (const Error&) {
      throw Error(ErrorCode::bad_argument,
                  fmt::format("\"{:.60}\" is no plane; write \"z = 1.1\" or \"0.6 x + 0.8 z = 2\"", text));
    }
  }();
  if (!plane.side_is_open)
    throw Error(ErrorCode::bad_argument,
                fmt::format("\"{:.60}\" is a side of a plane; a section is asked for as \"z = 1.1\"", text));
  return plane_across(plane.normal, plane.offset, plain_text(text));
}

SectionPlane middle_plane(const Domain& domain) {
  const int axis = axis_of_middle(domain);
  const SectionPlane plane = plane_across_axis(axis, bounds_of(domain).center()[axis]);
  const auto* mesh = std::get_if<Mesh>(&domain);
  return mesh && section_outline(domain, plane).empty()
             ? plane_across_axis(axis, where_it_is_cut(*mesh, axis))
             : plane;
}

namespace {

/// "y = 5 mm" from "y = 5"; only a length gets a unit.
std::string caption_of(std::string_view plane, std::string_view unit) {
  const std::string_view right = stripped(plane.substr(plane.find('=') + 1), " \t");
  double length;
  const auto [end, error] = std::from_chars(right.data(), right.data() + right.size(), length);
  const bool is_length = error == std::errc() && end == right.data() + right.size() && !unit.empty();
  return fmt::format("{}{}{}", plane, is_length ? " " : "", is_length ? unit : "");
}

}  // namespace

Section section_of(const Spheres<dynamic>& spheres, const Domain& domain, const SectionPlane& plane) {
  Section section;
  section.plane = plane;
  section.outline = section_outline(domain, plane);
  double area = 0;
  for (const Loop& loop : section.outline) area += area_within(loop);
  if (section.outline.empty() || !(std::abs(area) > 0)) {
    const Bounds<3> bounds = bounds_of(domain);
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("the plane \"{}\" does not meet the {}, which reaches from {:.6g}, {:.6g}, {:.6g} "
                    "to {:.6g}, {:.6g}, {:.6g}",
                    plane.text, name_of(domain), bounds.lower[0], bounds.lower[1], bounds.lower[2],
                    bounds.upper[0], bounds.upper[1], bounds.upper[2]));
  }
  section.area = std::abs(area);

  const TiltedBoundary<3> boundary = tilted_boundary_of<3>(domain);
  const Bounds<2> window = bounds_of_loops(section.outline);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i];
    const Vector<3> center = boundary.wrap(Vector<3>(spheres.x[0][i], spheres.x[1][i], spheres.x[2][i]));
    for_each_shift(boundary, r, [&](const Vector<3>& shift) {
      const Vector<3> c = center + shift;
      const double h = plane.normal.dot(c) - plane.offset;
      if (!(std::abs(h) < r)) return;
      const Vector<3> foot = c - h * plane.normal;
      const Vector<2> there(plane.right.dot(foot), plane.up.dot(foot));
      const double radius = std::sqrt((r - h) * (r + h));
      if ((there.array() + radius <= window.lower.array()).any() ||
          (there.array() - radius >= window.upper.array()).any())
        return;
      const double whole = std::numbers::pi * radius * radius;
      double covered = whole;
      if (boundary.repeats()) {  // without periods, spheres lie inside
        covered = 0;
        for (const Loop& loop : section.outline) covered += area_within(loop, there, radius);
        covered = std::abs(covered);
        if (covered < rounding * whole) return;
      }
      section.circles.push_back({there, radius, i, covered < (1 - rounding) * whole});
      section.covered_area += covered;
    });
  }
  return section;
}

namespace {

/// More circles make the picture no clearer.
constexpr std::size_t most_circles = 30'000;

/// Limits a picture of very many circles to a corner of the rectangle, clipped at its sides.
void show_corner(DiscPicture& picture) {
  const auto is_rectangle = [&] {
    return picture.outline.size() == 1 &&
           std::abs(area_within(picture.outline.front())) > (1 - rounding) * picture.window.size().prod();
  };
  if (picture.discs.size() <= most_circles || !is_rectangle()) return;
  const double part =
      std::sqrt(static_cast<double>(most_circles) / static_cast<double>(picture.discs.size()));
  const Vector<2> lower = picture.window.lower, upper = lower + part * picture.window.size();
  picture.window.upper = upper;
  picture.outline = {{lower, {upper[0], lower[1]}, upper, {lower[0], upper[1]}}};
  std::erase_if(picture.discs, [&](const Disc& disc) {
    return (disc.center.array() + disc.radius <= lower.array()).any() ||
           (disc.center.array() - disc.radius >= upper.array()).any();
  });
  for (Disc& disc : picture.discs)
    disc.sticks_out = disc.sticks_out || (disc.center.array() - disc.radius < lower.array()).any() ||
                      (disc.center.array() + disc.radius > upper.array()).any();
  picture.remark = fmt::format("a corner, {:.2g} of the edges", part);
}

}  // namespace

std::string section_svg(const Section& section, const Spheres<dynamic>& spheres, std::string_view unit) {
  DiscPicture picture{{}, section.outline, bounds_of_loops(section.outline)};
  for (const Section::Circle& circle : section.circles)
    picture.discs.push_back({circle.center, circle.radius, spheres.r[circle.sphere], circle.sticks_out});
  picture.caption = fmt::format("{}   ·   area fraction {:.4f}   ·   {} circle{}",
                                caption_of(section.plane.text, unit), section.area_fraction(),
                                grouped(section.circles.size()), section.circles.size() == 1 ? "" : "s");
  show_corner(picture);
  return svg_of(picture, SizeScale(spheres.r), spheres.size(), unit);
}

}  // namespace bernal
