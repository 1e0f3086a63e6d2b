#include "bernal/domain/domain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <utility>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "core/every_dimension.hpp"
#include "domain/share_of_area.hpp"
#include "geometry/changes.hpp"
#include "geometry/measures.hpp"
#include "geometry/openings.hpp"

namespace bernal {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;  // which Clang 14 does not find by itself

Bounds<3> bounds_of_sphere(const Sphere& s) {
  const Vector<3> half = Vector<3>::Constant(s.radius);
  return {s.center - half, s.center + half};
}

/// The two discs' bounds: a disc of radius R with the unit normal a has the half extents R·sqrt(1 - a_k²),
/// written as the sum of the two other squares, which does not cancel.
Bounds<3> bounds_of_cylinder(const Cylinder& s) {
  const Vector<3> axis = s.axis.stableNormalized();
  const Vector<3> top = s.base + s.height * axis;
  Vector<3> half;
  for (int k = 0; k < 3; ++k) half[k] = s.radius * std::hypot(axis[(k + 1) % 3], axis[(k + 2) % 3]);
  return {s.base.cwiseMin(top) - half, s.base.cwiseMax(top) + half};
}

/// Those of the circles at the corners of the profile.
Bounds<3> bounds_of_revolved(const Revolved& s) {
  const Vector<3> axis = s.axis.stableNormalized();
  Vector<3> across;
  for (int k = 0; k < 3; ++k) across[k] = std::hypot(axis[(k + 1) % 3], axis[(k + 2) % 3]);
  auto bounds = Bounds<3>::of_nothing();
  for (const Vector<2>& p : s.profile) {
    const Vector<3> center = s.base + p[1] * axis;
    bounds.add(center - p[0] * across);
    bounds.add(center + p[0] * across);
  }
  return s.profile.empty() ? Bounds<3>() : bounds;
}

/// The integral of pi r² dz along the profile.
double volume_of_revolved(const Revolved& s) {
  if (s.profile.empty()) return 0;
  const double level = s.profile.front()[1];
  double sum = 0;
  s.for_each_edge([&](const Vector<2>& a, const Vector<2>& b) {
    sum += (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) * ((b[1] - level) - (a[1] - level));
  });
  return std::numbers::pi / 3 * std::abs(sum);
}

double area_of_revolved(const Revolved& s) {
  double sum = 0;
  s.for_each_edge([&](const Vector<2>& a, const Vector<2>& b) { sum += (a[0] + b[0]) * (b - a).norm(); });
  return std::numbers::pi * sum;
}

/// The points of a domain of two dimensions in the plane z = 0.
Vector<3> in_space(const Vector<dynamic>& p) {
  Vector<3> q = Vector<3>::Zero();
  q.head(p.size()) = p;
  return q;
}

Bounds<2> bounds_of_polygon(const Polygon& s) {
  auto bounds = Bounds<2>::of_nothing();
  for (const auto& loop : s.loops)
    for (const Vector<2>& p : loop) bounds.add(p);
  return s.loops.empty() ? Bounds<2>() : bounds;
}

/// Twice, about the first corner; positive where it runs counter-clockwise.
double twice_area_of(const std::vector<Vector<2>>& loop) {
  double twice = 0;
  for (std::size_t k = 2; k < loop.size(); ++k) {
    const Vector<2> a = loop[k - 1] - loop[0], b = loop[k] - loop[0];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice;
}

bool is_within(const std::vector<Vector<2>>& loop, const Vector<2>& p) {
  bool inside = false;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vector<2>&a = loop[k], &b = loop[(k + 1) % loop.size()];
    if ((a[1] > p[1]) != (b[1] > p[1])) inside ^= p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
  }
  return inside;
}

double area_of_polygon(const Polygon& s) {
  double area = 0;
  for (std::size_t loop = 0; loop < s.loops.size(); ++loop) area += share_of_area(s, loop);
  return area;
}

double length_of(const Polygon& s) {
  double length = 0;
  for (const auto& loop : s.loops)
    for (std::size_t k = 0; k < loop.size(); ++k) length += (loop[(k + 1) % loop.size()] - loop[k]).norm();
  return length;
}

/// Of what walls at so much inside of facets enclose, to first order in that; something in any case, for
/// those who divide by it.
double volume_within(double volume, double area, double inset) {
  constexpr double least_share = 1e-3;
  return inset == 0 ? volume : std::max(least_share * volume, volume - inset * area);
}

/// Without its openings.
double area_of_walls(const Mesh& mesh) {
  return mesh.repeats() ? area_of(mesh, triangles_of_walls(mesh)) : area_of(mesh);
}

/// Of the axes along which a mesh repeats itself those along which no wall faces: it is the same everywhere
/// along these, but for rounding.
int shifts_of(const Mesh& mesh) {
  constexpr double rounding = 1e-9;
  if (!mesh.repeats()) return 0;
  const std::vector<FaceCorners> walls = triangles_of_walls(mesh);
  int shifts = 0;
  for (int k = 0; k < 3; ++k)
    shifts += mesh.periodic[static_cast<std::size_t>(k)] && std::ranges::all_of(walls, [&](const auto& t) {
                const Vector<3> normal = doubled_area(mesh, t);
                return std::abs(normal[k]) <= rounding * normal.norm();
              });
  return shifts;
}

double spacing(double x) {
  x = std::abs(x);
  return std::nextafter(x, std::numeric_limits<double>::infinity()) - x;
}

}  // namespace

double share_of_area(const Polygon& s, std::size_t loop) {
  const auto& line = s.loops[loop];
  if (line.empty()) return 0;
  bool hole = false;
  for (const auto& other : s.loops) hole ^= &other != &line && is_within(other, line.front());
  return (hole ? -0.5 : 0.5) * std::abs(twice_area_of(line));
}

int Cylinder::coordinate_axis() const {
  for (int k = 0; k < 3; ++k)
    if (axis[k] != 0 && axis[(k + 1) % 3] == 0 && axis[(k + 2) % 3] == 0) return k;
  return -1;
}

std::string_view kind_of(const Domain& domain) {
  return std::visit(
      Overloaded{[](const Box& s) -> std::string_view { return s.repeats() ? "periodic" : "box"; },
                 [](const Cylinder&) -> std::string_view { return "cylinder"; },
                 [](const Sphere&) -> std::string_view { return "sphere"; },
                 [](const Mesh&) -> std::string_view { return "mesh"; },
                 [](const Polygon&) -> std::string_view { return "polygon"; },
                 [](const Revolved&) -> std::string_view { return "revolved"; }},
      domain);
}

std::string name_of(const Domain& domain) {
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  if (cylinder && cylinder->periodic) return "periodic cylinder";
  if (is_repeated_mesh(domain)) return "periodic mesh";
  if (std::holds_alternative<Revolved>(domain)) return "solid of revolution";
  const auto* box = std::get_if<Box>(&domain);
  if (!box || !box->repeats()) return std::string(kind_of(domain));
  if (!box->has_walls()) return box->is_tilted() ? "tilted periodic box" : "periodic box";
  std::string axes;
  int walls = 0;
  for (int k = 0; k < box->dimension(); ++k)
    if (box->has_wall(k)) axes += (walls++ > 0 ? ", " : "") + std::to_string(k);
  return std::string("box periodic but along ").append(walls > 1 ? "axes " : "axis ").append(axes);
}

int dimension_of(const Domain& domain) {
  const auto* box = std::get_if<Box>(&domain);
  return box ? box->dimension() : std::holds_alternative<Polygon>(domain) ? 2 : 3;
}

bool has_walls(const Domain& domain) {
  const auto* box = std::get_if<Box>(&domain);
  return !box || box->has_walls();
}

int symmetries_of(const Domain& domain) {
  return std::visit(Overloaded{[](const Box& s) {
                                 int shifts = 0;
                                 for (int k = 0; k < s.dimension(); ++k) shifts += s.repeats(k);
                                 return shifts;
                               },
                               [](const Cylinder& s) { return s.periodic ? 2 : 1; },
                               [](const Sphere&) { return 3; }, [](const Mesh& s) { return shifts_of(s); },
                               [](const Polygon&) { return 0; }, [](const Revolved&) { return 1; }},
                    domain);
}

bool is_periodic(const Domain& domain) {
  return std::visit(
      Overloaded{[](const Box& s) { return s.repeats(); }, [](const Cylinder& s) { return s.periodic; },
                 [](const Sphere&) { return false; }, [](const Mesh& s) { return s.repeats(); },
                 [](const Polygon&) { return false; }, [](const Revolved&) { return false; }},
      domain);
}

template <int D>
Bounds<D> bounds_of(const Domain& domain) {
  return std::visit(Overloaded{[](const Box& s) {
                                 if constexpr (D == 3)
                                   if (s.dimension() == 2)
                                     return Bounds<D>{in_space(s.corner), in_space(s.corner + s.size)};
                                 return Bounds<D>{s.corner, s.corner + s.size};
                               },
                               [](const Polygon& s) {
                                 const Bounds<2> bounds = bounds_of_polygon(s);
                                 if constexpr (D == 3)
                                   return Bounds<D>{in_space(bounds.lower), in_space(bounds.upper)};
                                 else
                                   return Bounds<D>{bounds.lower, bounds.upper};
                               },
                               [](const auto& s) {
                                 Bounds<3> bounds;
                                 if constexpr (std::is_same_v<decltype(s), const Cylinder&>)
                                   bounds = bounds_of_cylinder(s);
                                 else if constexpr (std::is_same_v<decltype(s), const Sphere&>)
                                   bounds = bounds_of_sphere(s);
                                 else if constexpr (std::is_same_v<decltype(s), const Revolved&>)
                                   bounds = bounds_of_revolved(s);
                                 else
                                   bounds = bounds_of(s);
                                 return Bounds<D>{bounds.lower, bounds.upper};
                               }},
                    domain);
}
template Bounds<3> bounds_of(const Domain&);
template Bounds<dynamic> bounds_of(const Domain&);

double volume_of(const Domain& domain) {
  using std::numbers::pi;
  return std::visit(
      Overloaded{[](const Box& s) {
                   return s.repeats() || s.dimension() != 3 ? s.size.prod() : bounds_of(s).volume();
                 },
                 [](const Cylinder& s) { return pi * s.radius * s.radius * s.height; },
                 [](const Sphere& s) { return ball_volume(3, s.radius); },
                 [](const Mesh& s) { return volume_within(signed_volume(s), area_of_walls(s), s.inset); },
                 [](const Polygon& s) { return volume_within(area_of_polygon(s), length_of(s), s.inset); },
                 [](const Revolved& s) {
                   return volume_within(volume_of_revolved(s), area_of_revolved(s), s.inset);
                 }},
      domain);
}

double area_of(const Domain& domain) {
  using std::numbers::pi;
  return std::visit(
      Overloaded{
          [](const Box& s) {
            const Vector<3> e = bounds_of(s).size();
            double area = 0;
            if (s.dimension() == 2) return 2 * ((s.has_wall(0) ? e[1] : 0) + (s.has_wall(1) ? e[0] : 0));
            for (const int k : {2, 0, 1})
              if (s.has_wall(k)) area += 2 * (e[(k + 1) % 3] * e[(k + 2) % 3]);
            return area;
          },
          [](const Cylinder& s) { return 2 * pi * s.radius * ((s.periodic ? 0 : s.radius) + s.height); },
          [](const Sphere& s) { return 4 * pi * s.radius * s.radius; },
          [](const Mesh& s) { return area_of_walls(s); }, [](const Polygon& s) { return length_of(s); },
          [](const Revolved& s) { return area_of_revolved(s); }},
      domain);
}

Frame frame_of(const Domain& shape) {
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

Domain to_local(const Domain& shape, const Frame& frame) {
  return std::visit(Overloaded{[&](const Box& s) -> Domain {
                                 const int dimension = s.dimension();
                                 const Vector<3> lower = frame.to_local(in_space(s.corner));
                                 Vector<3> size = frame.to_local(in_space(s.corner + s.size)) - lower;
                                 for (int k = 0; k < dimension; ++k)  // periods scale without rounding
                                   if (s.repeats(k)) size[k] = s.size[k] / frame.scale;
                                 return Box{lower.head(dimension), size.head(dimension), s.periodic,
                                            scaled(s.tilt, 1 / frame.scale)};
                               },
                               [&](Cylinder s) -> Domain {
                                 s.base = frame.to_local(s.base);
                                 s.radius /= frame.scale;
                                 s.height /= frame.scale;
                                 return s;
                               },
                               [&](Sphere s) -> Domain {
                                 s.center = frame.to_local(s.center);
                                 s.radius /= frame.scale;
                                 return s;
                               },
                               [&](Mesh s) -> Domain {
                                 move_vertices(s, [&](const Vector<3>& v) { return frame.to_local(v); });
                                 s.inset /= frame.scale;
                                 return s;
                               },
                               [&](Polygon s) -> Domain {
                                 for (auto& loop : s.loops)
                                   for (Vector<2>& v : loop) v = frame.to_local(in_space(v)).head<2>();
                                 s.inset /= frame.scale;
                                 return s;
                               },
                               [&](Revolved s) -> Domain {
                                 s.base = frame.to_local(s.base);
                                 for (Vector<2>& p : s.profile) p /= frame.scale;
                                 s.inset /= frame.scale;
                                 return s;
                               }},
                    shape);
}

}  // namespace bernal
