#include "report/section_outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

#include "domain/revolved_surface.hpp"

#include "report/outline.hpp"

namespace bernal {
namespace {

using FlatLoop = std::vector<Vector<2>>;

/// A polygon with this many corners on a circle departs from it by 1 - cos(π / 720) = 1e-5 of its radius.
constexpr int round_points = 720;

Vector<2> in_plane(const SectionPlane& plane, const Vector<3>& p) {
  return {plane.right.dot(p), plane.up.dot(p)};
}

double height_above(const SectionPlane& plane, const Vector<3>& p) {
  return plane.normal.dot(p) - plane.offset;
}

/// Corners on the plane count as above it, or as below.
std::vector<FlatLoop> cut_of(const Mesh& mesh, const SectionPlane& plane, bool on_is_above) {
  std::vector<double> heights;
  heights.reserve(mesh.vertices.size());
  for (const Vector<3>& v : mesh.vertices) heights.push_back(height_above(plane, v));
  const auto above = [&](std::uint32_t v) { return on_is_above ? heights[v] >= 0 : heights[v] > 0; };

  // The line enters a triangle through one edge and leaves it through another; both are identified by their
  // corners, so that the pieces join without a tolerance.
  using Side = std::pair<std::uint32_t, std::uint32_t>;
  std::multimap<Side, Side> pieces;
  for (const auto& t : mesh.triangles) {
    Side enters, leaves;
    bool crosses = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (above(a) == above(b)) continue;
      (above(a) ? enters : leaves) = std::minmax(a, b);
      crosses = true;
    }
    if (crosses) pieces.emplace(enters, leaves);
  }
  const auto crossing = [&](const Side& side) {
    const double h = heights[side.first], k = heights[side.second];
    const Vector<3> p = mesh.vertices[side.first], q = mesh.vertices[side.second];
    return in_plane(plane, p + h / (h - k) * (q - p));
  };
  std::vector<FlatLoop> loops;
  while (!pieces.empty()) {
    FlatLoop loop;
    for (auto piece = pieces.begin(); piece != pieces.end();) {
      loop.push_back(crossing(piece->first));
      const Side next = piece->second;
      pieces.erase(piece);
      piece = pieces.find(next);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<FlatLoop> cut_of(const Mesh& mesh, const SectionPlane& plane) {
  std::vector<FlatLoop> loops = cut_of(mesh, plane, true);
  return loops.empty() ? cut_of(mesh, plane, false) : loops;
}

std::vector<FlatLoop> cut_of(const Box& box, const SectionPlane& plane) {
  // The brick of a tilted box is a period of it, too.
  return cut_of(drawable_mesh(Box{box.corner, box.size, box.periodic}), plane);
}

std::vector<FlatLoop> cut_of(const Revolved& revolved, const SectionPlane& plane) {
  return cut_of(surface_of(revolved, round_points), plane);
}

std::vector<FlatLoop> cut_of(const Polygon& polygon, const SectionPlane& plane) {
  return cut_of(drawable_mesh(polygon), plane);
}

std::vector<FlatLoop> cut_of(const Sphere& sphere, const SectionPlane& plane) {
  const double h = height_above(plane, sphere.center);
  if (!(std::abs(h) < sphere.radius)) return {};
  const double radius = std::sqrt((sphere.radius - h) * (sphere.radius + h));
  const Vector<2> center = in_plane(plane, sphere.center - h * plane.normal);
  FlatLoop loop;
  for (int k = 0; k < round_points; ++k) {
    const double angle = 2 * std::numbers::pi * k / round_points;
    loop.push_back(center + radius * Vector<2>(std::cos(angle), std::sin(angle)));
  }
  return {loop};
}

/// With s the sine of the angle between axis and plane: an ellipse with half axes R / |s| and R, between the
/// lines where the plane meets the lids; two lines along the axis if it is parallel to the plane.
std::vector<FlatLoop> cut_of(const Cylinder& cylinder, const SectionPlane& plane) {
  const Vector<3> axis = cylinder.axis.normalized();
  const double s = plane.normal.dot(axis), h = height_above(plane, cylinder.base), r = cylinder.radius;
  // Below this the ends of the ellipse are practically at infinity.
  if (std::abs(s) < 1e-12) {
    if (!(std::abs(h) < r)) return {};
    const Vector<3> across = plane.normal.cross(axis).normalized() * std::sqrt((r - h) * (r + h));
    const Vector<3> base = cylinder.base - h * plane.normal, top = base + cylinder.height * axis;
    FlatLoop loop;
    for (const Vector<3>& p :
         std::initializer_list<Vector<3>>{base - across, base + across, top + across, top - across})
      loop.push_back(in_plane(plane, p));
    return {loop};
  }
  const double middle = -h / s;  // position along the axis at which it meets the plane
  const Vector<3> center = cylinder.base + middle * axis;
  Vector<3> steep = axis - s * plane.normal;
  double cosine = steep.norm();
  if (cosine < 1e-12) {
    if (!(middle >= 0 && middle <= cylinder.height)) return {};
    return cut_of(Sphere{center, r}, plane);
  }
  steep /= cosine;
  const Vector<3> level = plane.normal.cross(steep);
  // A point center + x steep + y level is at middle + x cosine along the axis.
  const double half = r / std::abs(s);
  const double from = std::clamp(-middle / cosine / half, -1.0, 1.0);
  const double to = std::clamp((cylinder.height - middle) / cosine / half, -1.0, 1.0);
  if (!(from < to)) return {};
  FlatLoop loop;
  const double first = std::acos(from), last = std::acos(to);
  for (const int side : {1, -1}) {
    for (int k = 0; k <= round_points / 2; ++k) {
      const double share = 2.0 * k / round_points;
      const double angle = side > 0 ? first + share * (last - first) : last + share * (first - last);
      loop.push_back(
          in_plane(plane, center + half * std::cos(angle) * steep + side * r * std::sin(angle) * level));
    }
  }
  return {loop};
}

double cross_of(const Vector<2>& a, const Vector<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// The signed common area of the circle of this radius about the origin and the triangle (0, a, b).
double shared_with_triangle(const Vector<2>& a, const Vector<2>& b, double radius) {
  const auto sector = [&](const Vector<2>& p, const Vector<2>& q) {
    return 0.5 * radius * radius * std::atan2(cross_of(p, q), p.dot(q));
  };
  const Vector<2> along = b - a;
  const double length_squared = along.squaredNorm();
  if (!(length_squared > 0)) return 0;
  // |a + t along| = radius
  const double middle = -a.dot(along) / length_squared;
  const double off_squared = (a + middle * along).squaredNorm();
  if (off_squared >= radius * radius) return sector(a, b);
  const double half = std::sqrt((radius * radius - off_squared) / length_squared);
  const double enters = std::clamp(middle - half, 0.0, 1.0), leaves = std::clamp(middle + half, 0.0, 1.0);
  if (!(enters < leaves)) return sector(a, b);
  const Vector<2> p = a + enters * along, q = a + leaves * along;
  return (enters > 0 ? sector(a, p) : 0) + 0.5 * cross_of(p, q) + (leaves < 1 ? sector(q, b) : 0);
}

}  // namespace

std::vector<std::vector<Vector<2>>> section_outline(const Domain& domain, const SectionPlane& plane) {
  return std::visit([&](const auto& shape) { return cut_of(shape, plane); }, domain);
}

double area_within(const std::vector<Vector<2>>& loop) {
  double twice = 0;
  for (std::size_t k = 0; k < loop.size(); ++k)
    twice += cross_of(loop[k] - loop[0], loop[(k + 1) % loop.size()] - loop[0]);
  return 0.5 * twice;
}

double area_within(const std::vector<Vector<2>>& loop, const Vector<2>& center, double radius) {
  double area = 0;
  for (std::size_t k = 0; k < loop.size(); ++k)
    area += shared_with_triangle(loop[k] - center, loop[(k + 1) % loop.size()] - center, radius);
  return area;
}

}  // namespace bernal
