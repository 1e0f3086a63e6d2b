#include "bernal/domain/shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"

namespace bernal {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

Bounds<3> bounds_of_points(const std::vector<Vector<3>>& points) {
  if (points.empty()) return {};
  Bounds<3> bounds{points.front(), points.front()};
  for (const Vector<3>& p : points) {
    bounds.lower = bounds.lower.cwiseMin(p);
    bounds.upper = bounds.upper.cwiseMax(p);
  }
  return bounds;
}

/// The two discs' bounds: a disc of radius R with the unit normal a has the half extents R·sqrt(1 - a_k²),
/// written as the sum of the two other squares, which does not cancel.
Bounds<3> bounds_of_cylinder(const CylinderShape& s) {
  const Vector<3> axis = s.axis.stableNormalized();
  const Vector<3> top = s.base + s.height * axis;
  Vector<3> half;
  for (int k = 0; k < 3; ++k) half[k] = s.radius * std::hypot(axis[(k + 1) % 3], axis[(k + 2) % 3]);
  return {s.base.cwiseMin(top) - half, s.base.cwiseMax(top) + half};
}

double volume_of_mesh(const Mesh& mesh) {
  const Vector<3> origin = bounds_of_points(mesh.vertices).center();
  double six_volumes = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector<3> a = mesh.vertices[i] - origin, b = mesh.vertices[j] - origin,
                    c = mesh.vertices[k] - origin;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6;
}

double area_of_mesh(const Mesh& mesh) {
  double twice_area = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector<3>& a = mesh.vertices[i];
    twice_area += (mesh.vertices[j] - a).cross(mesh.vertices[k] - a).norm();
  }
  return twice_area / 2;
}

double spacing(double x) {
  x = std::abs(x);
  return std::nextafter(x, std::numeric_limits<double>::infinity()) - x;
}

}  // namespace

std::string_view kind_of(const Shape& shape) {
  return std::visit(Overloaded{[](const BoxShape&) -> std::string_view { return "box"; },
                               [](const CylinderShape&) -> std::string_view { return "cylinder"; },
                               [](const SphereShape&) -> std::string_view { return "sphere"; },
                               [](const Mesh&) -> std::string_view { return "mesh"; }},
                    shape);
}

Bounds<3> bounds_of(const Shape& shape) {
  return std::visit(Overloaded{[](const BoxShape& s) {
                                 return Bounds<3>{s.corner, s.corner + s.size};
                               },
                               [](const CylinderShape& s) { return bounds_of_cylinder(s); },
                               [](const SphereShape& s) {
                                 const Vector<3> half = Vector<3>::Constant(s.radius);
                                 return Bounds<3>{s.center - half, s.center + half};
                               },
                               [](const Mesh& s) { return bounds_of_points(s.vertices); }},
                    shape);
}

double volume_of(const Shape& shape) {
  using std::numbers::pi;
  return std::visit(Overloaded{[](const BoxShape& s) { return bounds_of(s).volume(); },
                               [](const CylinderShape& s) { return pi * s.radius * s.radius * s.height; },
                               [](const SphereShape& s) { return ball_volume(3, s.radius); },
                               [](const Mesh& s) { return volume_of_mesh(s); }},
                    shape);
}

double area_of(const Shape& shape) {
  using std::numbers::pi;
  return std::visit(
      Overloaded{[](const BoxShape& s) {
                   const Vector<3> e = bounds_of(s).size();
                   return 2 * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]);
                 },
                 [](const CylinderShape& s) { return 2 * pi * s.radius * (s.radius + s.height); },
                 [](const SphereShape& s) { return 4 * pi * s.radius * s.radius; },
                 [](const Mesh& s) { return area_of_mesh(s); }},
      shape);
}

Frame frame_of(const Shape& shape) {
  const Bounds<3> bounds = bounds_of(shape);
  const double diagonal = bounds.diagonal();
  if (!(diagonal > 0) || !std::isfinite(diagonal))
    throw Error(ErrorCode::bad_argument,
                "the container has no extent or is not finite: check its size and coordinates");
  Frame frame;
  frame.scale = std::exp2(std::ilogb(diagonal));
  // On a grid of sixteenths of the scale, the origin has few bits: subtracting it is exact for coordinates of
  // that size or larger.
  const double grid = frame.scale / 16;
  const Vector<3> center = bounds.center();
  for (int k = 0; k < 3; ++k) frame.origin[k] = std::nearbyint(center[k] / grid) * grid;

  const double farthest = std::max(bounds.lower.cwiseAbs().maxCoeff(), bounds.upper.cwiseAbs().maxCoeff());
  frame.resolution = std::max(spacing(farthest) / frame.scale, spacing(2.0));
  return frame;
}

Shape to_local(const Shape& shape, const Frame& frame) {
  return std::visit(Overloaded{[&](const BoxShape& s) -> Shape {
                                 const Vector<3> lower = frame.to_local(s.corner);
                                 const Vector<3> upper = frame.to_local(s.corner + s.size);
                                 return BoxShape{lower, upper - lower};
                               },
                               [&](CylinderShape s) -> Shape {
                                 s.base = frame.to_local(s.base);
                                 s.radius /= frame.scale;
                                 s.height /= frame.scale;
                                 return s;
                               },
                               [&](SphereShape s) -> Shape {
                                 s.center = frame.to_local(s.center);
                                 s.radius /= frame.scale;
                                 return s;
                               },
                               [&](Mesh s) -> Shape {
                                 for (Vector<3>& v : s.vertices) v = frame.to_local(v);
                                 return s;
                               }},
                    shape);
}

}  // namespace bernal
