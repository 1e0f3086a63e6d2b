#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "cad/open_ends.hpp"
#include "geometry/changes.hpp"

namespace bernal::test {

/// A channel along z, from z = lower on, closed: its section at height z is a polygon of so many sides about
/// (x, y) = `middle`, with corners at the distance radius(share of the period, share of a turn).
inline Mesh closed_channel(const std::function<double(double, double)>& radius, std::uint32_t sides,
                           std::uint32_t rings, double lower, double period,
                           const Vector<2>& middle = Vector<2>::Zero()) {
  Mesh mesh;
  for (std::uint32_t ring = 0; ring <= rings; ++ring)
    for (std::uint32_t side = 0; side < sides; ++side) {
      const double share = static_cast<double>(ring % rings) / rings,
                   turn = static_cast<double>(side) / sides;
      const double r = radius(share, turn), angle = 2 * std::numbers::pi * turn;
      mesh.vertices.emplace_back(middle[0] + r * std::cos(angle), middle[1] + r * std::sin(angle),
                                 lower + period * ring / rings);
    }
  const auto corner = [&](std::uint32_t ring, std::uint32_t side) { return ring * sides + side % sides; };
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t a = corner(ring, side), b = corner(ring, side + 1), c = corner(ring + 1, side + 1),
                          d = corner(ring + 1, side);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  for (std::uint32_t side = 1; side + 1 < sides; ++side) {
    mesh.triangles.push_back({corner(0, 0), corner(0, side + 1), corner(0, side)});
    mesh.triangles.push_back({corner(rings, 0), corner(rings, side), corner(rings, side + 1)});
  }
  return mesh;
}

/// What goes on along these axes: its ends are openings.
inline Mesh repeating(Mesh mesh, const std::array<bool, 3>& axes = {false, false, true}) {
  cad::open_ends(mesh, axes, 1e-9);
  return mesh;
}

/// Without its ends.
inline Mesh open_channel(Mesh closed) {
  const Mesh repeated = repeating(closed);
  std::vector<bool> kept(repeated.triangles.size());
  for (std::size_t t = 0; t < kept.size(); ++t) {
    const auto z = [&](std::size_t k) { return repeated.vertices[repeated.triangles[t][k]][2]; };
    kept[t] = z(0) != z(1) || z(1) != z(2);
  }
  keep_only(closed, kept);
  return closed;
}

/// A corrugated tube: one wave a period.
inline Mesh corrugated_channel(double lower = -1.5, double period = 3, std::uint32_t sides = 12,
                               std::uint32_t rings = 8) {
  return closed_channel(
      [](double share, double) { return 1 + 0.25 * std::cos(2 * std::numbers::pi * share); }, sides, rings,
      lower, period);
}

/// The surface of { f < 0 } in the box [lower, lower + n·step), f repeating itself: by marching through the
/// six tetrahedra of each cube of a grid; closed in the faces of the box.
class LevelSet {
 public:
  using Node = std::array<int, 3>;
  LevelSet(std::function<double(const Vector<3>&)> f, const Node& n, const Vector<3>& lower, double step)
      : f_(std::move(f)), n_(n), lower_(lower), step_(step) {}

  Mesh mesh() {
    for (int x = 0; x < n_[0]; ++x)
      for (int y = 0; y < n_[1]; ++y)
        for (int z = 0; z < n_[2]; ++z) add_cube({x, y, z});
    weld_equal_points(mesh_);
    drop_unused_vertices(mesh_);
    std::vector<bool> kept;
    for (const auto& [a, b, c] : mesh_.triangles) kept.push_back(a != b && b != c && c != a);
    keep_only(mesh_, kept);
    return mesh_;
  }

 private:
  double value(Node node) {
    for (std::size_t k = 0; k < 3; ++k) node[k] %= n_[k];
    const auto [found, is_new] = values_.try_emplace(node, 0);
    if (is_new) {
      const double v = f_(place(node));
      found->second = std::abs(v) > 1e-6 ? v : 1e-6;
    }
    return found->second;
  }
  Vector<3> place(const Node& node) const { return lower_ + step_ * Vector<3>(node[0], node[1], node[2]); }
  Vector<3> crossing(Node from, Node to) {
    if (to < from) std::swap(from, to);
    const double a = value(from), b = value(to);
    return place(from) + a / (a - b) * (place(to) - place(from));
  }
  /// Facing away from a point.
  void add(const std::vector<Vector<3>>& polygon, const Vector<3>& away_from) {
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      Vector<3> a = polygon[0], b = polygon[k], c = polygon[k + 1];
      if ((b - a).cross(c - a).dot(away_from - a) > 0) std::swap(b, c);
      const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
      for (const Vector<3>& v : {a, b, c}) mesh_.vertices.push_back(v);
      mesh_.triangles.push_back({first, first + 1, first + 2});
    }
  }
  void add_cube(const Node& corner) {
    std::array<std::size_t, 3> axes{0, 1, 2};
    do {
      std::array<Node, 4> corners{corner, corner, corner, corner};
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t after = k + 1; after < 4; ++after) ++corners[after][axes[k]];
      add_tetrahedron(corners);
    } while (std::ranges::next_permutation(axes).found);
  }
  void add_tetrahedron(const std::array<Node, 4>& corners) {
    std::vector<Node> in, out;
    for (const Node& c : corners) (value(c) < 0 ? in : out).push_back(c);
    if (in.size() == 1)
      add({crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[0], out[2])}, place(in[0]));
    if (in.size() == 3)
      add({crossing(in[0], out[0]), crossing(in[1], out[0]), crossing(in[2], out[0])},
          (place(in[0]) + place(in[1]) + place(in[2])) / 3);
    if (in.size() == 2)
      add({crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[1], out[1]),
           crossing(in[1], out[0])},
          0.5 * (place(in[0]) + place(in[1])));
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::vector<Node> face;
      for (std::size_t k = 0; k < 4; ++k)
        if (k != left_out) face.push_back(corners[k]);
      for (std::size_t k = 0; k < 3; ++k)
        for (const int end : {0, n_[k]})
          if (std::ranges::all_of(face, [&](const Node& c) { return c[k] == end; }))
            add_face(face, place(corners[left_out]));
    }
  }
  void add_face(const std::vector<Node>& face, const Vector<3>& behind) {
    std::vector<Vector<3>> polygon;
    for (std::size_t k = 0; k < 3; ++k) {
      const Node &a = face[k], &b = face[(k + 1) % 3];
      if (value(a) < 0) polygon.push_back(place(a));
      if ((value(a) < 0) != (value(b) < 0)) polygon.push_back(crossing(a, b));
    }
    if (polygon.size() >= 3) add(polygon, behind);
  }

  std::function<double(const Vector<3>&)> f_;
  Node n_;
  Vector<3> lower_;
  double step_;
  std::map<Node, double> values_;
  Mesh mesh_;
};

/// The void between balls on a simple cubic lattice of edge 2, so large that they overlap: a pore goes on
/// through every face. Its coordinates begin at `lower`.
inline Mesh void_of_simple_cubic(int cells, const Vector<3>& lower = Vector<3>::Zero()) {
  const auto f = [&](const Vector<3>& p) {
    Vector<3> d = p - lower;
    for (double& x : d) x -= 2 * std::nearbyint(0.5 * x);
    return 1.08 - d.norm();
  };
  return LevelSet(f, {cells, cells, cells}, lower, 2.0 / cells).mesh();
}

/// The void of a gyroid of edge 2.
inline Mesh void_of_gyroid(int cells) {
  const auto f = [](const Vector<3>& p) {
    const Vector<3> a = std::numbers::pi * p;
    return std::sin(a[0]) * std::cos(a[1]) + std::sin(a[1]) * std::cos(a[2]) +
           std::sin(a[2]) * std::cos(a[0]) - 0.3;
  };
  return LevelSet(f, {cells, cells, cells}, Vector<3>::Zero(), 2.0 / cells).mesh();
}

/// Of rows x, y, z, r.
inline Spheres<dynamic> spheres(const std::vector<std::array<double, 4>>& rows) {
  Spheres<dynamic> made(3);
  for (const auto& [x, y, z, r] : rows) made.push_back(Vector<3>(x, y, z), r);
  return made;
}

}  // namespace bernal::test
