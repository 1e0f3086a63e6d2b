#include "surfaces/wall_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bernal/core/error.hpp"
#include "cad/read/triangulate.hpp"
#include "domain/revolved_surface.hpp"
#include "geometry/edges.hpp"
#include "geometry/point_numbers.hpp"
#include "surfaces/icosphere.hpp"

namespace bernal {
namespace {

FloatPoint float_point(const Vector<3>& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}
Vector<3> double_point(const FloatPoint& p) { return {p[0], p[1], p[2]}; }

void append(FloatSurface& to, const FloatSurface& more) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles) to.triangles.push_back({first + a, first + b, first + c});
  to.faces.insert(to.faces.end(), more.faces.begin(), more.faces.end());
}

/// Merges equal vertices.
void join(FloatSurface& surface) {
  PointNumbers<FloatPoint> numbers;
  renumber(surface.triangles, [&](std::uint32_t v) { return numbers.of(surface.vertices[v]); });
  surface.vertices = std::move(numbers.points);
}

FloatSurface convex_face(const std::vector<FloatPoint>& outline, int face) {
  FloatSurface made{outline, {}, {}};
  const auto halve = [&](auto self, std::uint32_t from, std::uint32_t to) -> void {
    if (to - from < 2) return;
    const std::uint32_t middle = (from + to) / 2;
    made.triangles.push_back({from, middle, to});
    made.faces.push_back(static_cast<std::int8_t>(face));
    self(self, from, middle);
    self(self, middle, to);
  };
  halve(halve, 0, static_cast<std::uint32_t>(outline.size() - 1));
  return made;
}

struct MakeWalls {
  double deflection;

  WallSurface operator()(const Box& box) const {
    const Vector<3> lower = box.corner, upper = lower + Vector<3>(box.size);
    WallSurface made;
    for (int axis = 0; axis < 3; ++axis)
      for (const bool is_upper : {false, true}) {
        // Counter-clockwise from above the upper face.
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::vector<FloatPoint> outline;
        for (const auto& [at_u, at_v] :
             {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
          Vector<3> p = is_upper ? upper : lower;
          p[u] = at_u ? upper[u] : lower[u];
          p[v] = at_v ? upper[v] : lower[v];
          outline.push_back(float_point(p));
        }
        if (!is_upper) std::ranges::reverse(outline);
        if (box.repeats(axis))
          made.ends.push_back({2 * axis + (is_upper ? 1 : 0), outline});
        else
          append(made.walls, convex_face(outline, on_wall));
      }
    join(made.walls);
    return made;
  }

  WallSurface operator()(const Cylinder& cylinder) const {
    const Vector<3> axis = cylinder.axis.normalized();
    const int along = cylinder.periodic ? cylinder.coordinate_axis() : -1;
    const Vector<3> e1 =
        along >= 0 ? Vector<3>(Vector<3>::Unit((along + 1) % 3)) : Vector<3>(axis.unitOrthogonal());
    const Vector<3> e2 = axis.cross(e1);
    // R (1 / cos(pi/n) - 1) <= deflection
    const double angle = std::acos(1 / (1 + deflection / cylinder.radius));
    const double sides = std::max(12.0, std::ceil(std::numbers::pi / angle));
    if (!(sides < 1e5))
      throw Error(ErrorCode::bad_argument,
                  "a cylinder so much wider than its spheres takes more than "
                  "100,000 sides; allow a larger deflection");
    const auto n = static_cast<std::uint32_t>(sides);
    const double radius = cylinder.radius / std::cos(std::numbers::pi / n);
    Vector<3> ends[2] = {cylinder.base, cylinder.base + cylinder.height * axis};
    std::vector<FloatPoint> rings[2];
    for (int end = 0; end < 2; ++end)
      for (std::uint32_t k = 0; k < n; ++k) {
        const double phi = 2 * std::numbers::pi * k / n;
        Vector<3> p = ends[end] + radius * (std::cos(phi) * e1 + std::sin(phi) * e2);
        if (along >= 0) {  // both rings are equal except along the axis
          p = ends[0] + radius * (std::cos(phi) * e1 + std::sin(phi) * e2);
          const Boundary<3> boundary = boundary_of<3>(Domain(cylinder));
          const bool upper = (end == 1) == (axis[along] > 0);
          p[along] = boundary.origin[along] + (upper ? boundary.edges[along] : 0.0);
        }
        rings[end].push_back(float_point(p));
      }
    WallSurface made;
    made.walls.vertices = rings[0];
    made.walls.vertices.insert(made.walls.vertices.end(), rings[1].begin(), rings[1].end());
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t next = (k + 1) % n;
      made.walls.triangles.push_back({k, next, n + next});
      made.walls.triangles.push_back({k, n + next, n + k});
    }
    made.walls.faces.assign(made.walls.triangles.size(), on_wall);
    std::ranges::reverse(rings[0]);
    for (int end = 0; end < 2; ++end) {
      if (along < 0)
        append(made.walls, convex_face(rings[end], on_wall));
      else
        made.ends.push_back({2 * along + ((end == 1) == (axis[along] > 0) ? 1 : 0), rings[end]});
    }
    join(made.walls);
    return made;
  }

  WallSurface operator()(const Sphere& sphere) const {
    const double share = deflection / sphere.radius;
    const int frequency = frequency_for(share / (1 + share));
    if (frequency >= most_frequent)
      throw Error(ErrorCode::bad_argument,
                  "a container so much larger than its spheres takes millions of "
                  "triangles; allow a larger deflection");
    const Icosphere& inscribed = icosphere(frequency);
    const double radius = sphere.radius / inscribed.inradius;
    WallSurface made;
    for (const Vector<3>& v : inscribed.vertices)
      made.walls.vertices.push_back(float_point(sphere.center + radius * v));
    made.walls.triangles = inscribed.triangles;
    made.walls.faces.assign(made.walls.triangles.size(), on_wall);
    return made;
  }

  WallSurface operator()(const Mesh& mesh) const {
    require_closed_walls(mesh, "a file of surfaces");
    WallSurface made;
    for (const Vector<3>& v : mesh.vertices) made.walls.vertices.push_back(float_point(v));
    made.walls.triangles = mesh.triangles;
    made.walls.faces.assign(made.walls.triangles.size(), on_wall);
    return made;
  }

  WallSurface operator()(const Revolved& revolved) const {
    const double sides = sides_for(revolved, deflection);
    if (!(sides * static_cast<double>(revolved.profile.size()) < 5e6))
      throw Error(ErrorCode::bad_argument,
                  "a solid of revolution so much wider than its spheres takes millions of triangles; allow a "
                  "larger deflection");
    return (*this)(surface_of(revolved, static_cast<int>(sides), RoundAs::circumscribed));
  }

  WallSurface operator()(const Polygon&) const {
    throw Error(ErrorCode::bad_argument, "a polygon has no surface");
  }
};

using FloatEdge = std::pair<FloatPoint, FloatPoint>;

FloatEdge edge_between(const FloatPoint& a, const FloatPoint& b) { return std::minmax(a, b); }

}  // namespace

FloatSurface WallSurface::closed() const {
  FloatSurface made = walls;
  for (const End& end : ends) append(made, convex_face(end.outline, end.face));
  if (!ends.empty()) join(made);
  return made;
}

Mesh WallSurface::extended(const Boundary<3>& boundary) const {
  const FloatSurface surface = closed();
  Mesh mesh;
  for (const FloatPoint& p : surface.vertices) {
    Vector<3> moved = double_point(p);
    for (const End& end : ends) {
      const auto axis = static_cast<std::size_t>(end.axis());
      if (p[axis] != end.outline.front()[axis]) continue;
      moved[end.axis()] += (end.is_upper() ? 1 : -1) * boundary.edges[end.axis()];
    }
    mesh.vertices.push_back(moved);
  }
  mesh.triangles = surface.triangles;
  return mesh;
}

WallSurface wall_surface(const Domain& domain, double deflection) {
  return std::visit(MakeWalls{deflection}, domain);
}

std::optional<FloatSurface> end_between(const WallSurface::End& end,
                                        const std::vector<std::array<FloatPoint, 3>>& covered,
                                        const std::vector<FloatPoint>& on_outline) {
  // The outline of what is covered: edges with a single triangle.
  PointNumbers<FloatPoint> corners;
  std::vector<FaceCorners> triangles;
  for (const auto& [a, b, c] : covered) triangles.push_back({corners.of(a), corners.of(b), corners.of(c)});
  std::set<FloatEdge> edges;
  std::set<FloatPoint> rim;
  for (const EdgeUse& edge : open_edges(triangles)) {
    const FloatPoint &from = corners.points[edge.low], &to = corners.points[edge.high];
    edges.insert(edge_between(from, to));
    rim.insert({from, to});
  }
  rim.insert(on_outline.begin(), on_outline.end());
  // The end's own outline, divided where spheres cross it; an edge in both bounds nothing.
  for (std::size_t k = 0; k < end.outline.size(); ++k) {
    const FloatPoint from = end.outline[k], to = end.outline[(k + 1) % end.outline.size()];
    std::vector<FloatPoint> line = {from, to};
    int differ = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) differ += from[axis] != to[axis];
    if (differ == 1)
      for (const FloatPoint& p : rim) {
        bool between = true;
        for (std::size_t axis = 0; axis < 3; ++axis)
          between &= std::min(from[axis], to[axis]) <= p[axis] && p[axis] <= std::max(from[axis], to[axis]);
        if (between) line.push_back(p);
      }
    std::ranges::sort(line);
    line.erase(std::unique(line.begin(), line.end()), line.end());
    for (std::size_t m = 1; m < line.size(); ++m) {
      const FloatEdge edge = edge_between(line[m - 1], line[m]);
      if (!edges.insert(edge).second) edges.erase(edge);
    }
  }
  FloatSurface made;
  PointNumbers<FloatPoint> numbers;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> lines;
  for (const auto& [a, b] : edges) {
    const std::uint32_t first = numbers.of(a);
    lines.emplace_back(first, numbers.of(b));
  }
  if (lines.empty()) return made;
  made.vertices = std::move(numbers.points);
  std::vector<Vector<3>> points;
  for (const FloatPoint& p : made.vertices) points.push_back(double_point(p));
  const auto filled =
      cad::triangulate_regions(points, lines, (end.is_upper() ? 1.0 : -1.0) * Vector<3>::Unit(end.axis()));
  if (!filled) return std::nullopt;
  made.triangles = *filled;
  made.faces.assign(made.triangles.size(), static_cast<std::int8_t>(end.face));
  return made;
}

FloatSurface moved_to(const WallSurface::End& opposite, FloatSurface surface) {
  const auto axis = static_cast<std::size_t>(opposite.axis());
  for (FloatPoint& p : surface.vertices) p[axis] = opposite.outline.front()[axis];
  for (Triangle& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
  std::ranges::fill(surface.faces, static_cast<std::int8_t>(opposite.face));
  return surface;
}

}  // namespace bernal
