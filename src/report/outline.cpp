#include "report/outline.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "bernal/core/error.hpp"
#include "domain/revolved_surface.hpp"
#include "geometry/changes.hpp"
#include "geometry/edges.hpp"

namespace bernal {
namespace {

constexpr std::uint32_t rim_points = 180;
constexpr std::size_t most_edges = 20'000;  // more would only add bytes

/// Two unit vectors that complete `axis` to an orthogonal frame.
std::array<Vector<3>, 2> across(const Vector<3>& axis) {
  const Vector<3> u = axis.unitOrthogonal();
  return {u, axis.normalized().cross(u)};
}

std::vector<Vector<3>> ring(const Vector<3>& center, const Vector<3>& axis, double radius) {
  const auto [u, v] = across(axis);
  std::vector<Vector<3>> points;
  for (std::uint32_t k = 0; k < rim_points; ++k) {
    const double angle = 2 * std::numbers::pi * k / rim_points;
    points.push_back(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return points;
}

Mesh drawable(const Box& box) {
  const Vector<3> corner = box.corner;
  Mesh mesh = mesh_of_box({corner, corner + Vector<3>(box.size)});
  if (!box.is_tilted()) return mesh;
  const TiltedBoundary<3> cell(Vector<3>(box.size), box.tilt);
  for (Vector<3>& p : mesh.vertices) {
    const Vector<3> shares = (p - corner).cwiseQuotient(cell.edges);
    p = corner;
    for (int axis = 0; axis < 3; ++axis) p += shares[axis] * cell.cell_vector(axis);
  }
  return mesh;
}

Mesh drawable(const Cylinder& cylinder) {
  const Vector<3> axis = cylinder.axis.normalized();
  const Vector<3> top_center = cylinder.base + cylinder.height * axis;
  Mesh mesh;
  mesh.vertices = ring(cylinder.base, axis, cylinder.radius);
  const std::vector<Vector<3>> upper = ring(top_center, axis, cylinder.radius);
  mesh.vertices.insert(mesh.vertices.end(), upper.begin(), upper.end());
  mesh.vertices.push_back(cylinder.base);
  mesh.vertices.push_back(top_center);
  for (std::uint32_t i = 0; i < rim_points; ++i) {
    const std::uint32_t j = (i + 1) % rim_points, n = rim_points;
    mesh.triangles.push_back({i, j, n + i});
    mesh.triangles.push_back({j, n + j, n + i});
    mesh.triangles.push_back({2 * n, j, i});
    mesh.triangles.push_back({2 * n + 1, n + i, n + j});
  }
  return mesh;
}

Mesh drawable(const Sphere& sphere) {
  Mesh mesh;
  mesh.vertices = ring(sphere.center, View::towards_eye(), sphere.radius);
  mesh.vertices.push_back(sphere.center + sphere.radius * View::towards_eye());
  mesh.vertices.push_back(sphere.center - sphere.radius * View::towards_eye());
  for (std::uint32_t i = 0; i < rim_points; ++i) {
    const std::uint32_t j = (i + 1) % rim_points;
    mesh.triangles.push_back({i, j, rim_points});
    mesh.triangles.push_back({j, i, rim_points + 1});
  }
  return mesh;
}

Mesh drawable(const Mesh& mesh) { return mesh; }

Mesh drawable(const Revolved& revolved) { return surface_of(revolved, rim_points); }

Mesh drawable(const Polygon&) {
  throw Error(ErrorCode::bad_argument, "a polygon lies in the plane and has no surface");
}

/// Edges that show the shape, and the silhouette.
SharpEdges marked_edges(const Mesh& mesh) {
  return sharp_edges(mesh, most_edges, [](const Vector<3>& n, const Vector<3>& m) {
    return (n.dot(View::towards_eye()) > 0) != (m.dot(View::towards_eye()) > 0);
  });
}

/// Cuts an edge where it enters or leaves the hidden region.
void split_where_hidden(const CanvasPoint& a, const CanvasPoint& b, const DepthBuffer& surface, double bias,
                        std::vector<Stroke>& strokes) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  const int steps = std::max(1, static_cast<int>(std::ceil(length / 2)));
  const auto at = [&](double t) {
    return CanvasPoint{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.depth + t * (b.depth - a.depth)};
  };
  CanvasPoint start = a;
  bool hidden = false;
  for (int k = 0; k <= steps; ++k) {
    const CanvasPoint middle = at((std::min(k, steps - 1) + 0.5) / steps);
    const bool now = middle.depth + bias < surface.farthest_depth(middle.x, middle.y);
    if (k == 0) hidden = now;
    if (now != hidden || k == steps) {
      const CanvasPoint end = at(static_cast<double>(k) / steps);
      strokes.push_back({start, end, hidden});
      start = end;
      hidden = now;
    }
  }
}

}  // namespace

Mesh drawable_mesh(const Domain& domain) {
  return std::visit([](const auto& shape) { return drawable(shape); }, domain);
}

std::vector<Stroke> outline_of(const Mesh& mesh, const View& view) {
  std::vector<CanvasPoint> points;
  points.reserve(mesh.vertices.size());
  for (const Vector<3>& vertex : mesh.vertices) points.push_back(view(vertex));

  DepthBuffer surface(view.width(), view.height(), 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    surface.draw_triangle(points[a], points[b], points[c], t);
  }
  // An edge lies on the surface that must not hide it; the raster's depth is accurate to about a pixel.
  const double bias = 3;
  std::vector<Stroke> strokes;
  for (const auto& [from, to] : marked_edges(mesh))
    split_where_hidden(points[from], points[to], surface, bias, strokes);
  return strokes;
}

}  // namespace bernal
