#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/domain/container.hpp"
#include "cad/repair/obstacles.hpp"
#include "domain/rounded.hpp"
#include "support/channels.hpp"
#include "support/meshes.hpp"
#include "support/precise_distance.hpp"

namespace bernal::test {

/// A container that tests/laws holds to the laws of Container. It stands in local coordinates: its diagonal
/// is in [1, 2).
struct ContainerUnderTest {
  std::string name;
  Domain shape;
  double resolution;

  std::unique_ptr<Container> container(WallArithmetic arithmetic = WallArithmetic::filtered) const {
    return make_container(shape, arithmetic, resolution);
  }
  friend void PrintTo(const ContainerUnderTest& tested, std::ostream* out) { *out << tested.name; }
};

/// What an obstacle leaves of a solid.
inline Mesh without(Mesh solid, const Mesh& obstacle) {
  cad::take_out(solid, obstacle, "it");
  return solid;
}

inline ContainerUnderTest localized(std::string name, const Domain& scene) {
  const Frame frame = frame_of(scene);
  return {std::move(name), to_local(scene, frame), frame.resolution};
}

/// A new container is held to every law by one line here. Meshes are small, because the oracle looks at every
/// triangle.
inline std::vector<ContainerUnderTest> containers_under_test() {
  return {
      localized("Cube", Box{{0, 0, 0}, {1, 1, 1}}),
      localized("FlatBoxFarAway", Box{{1e4, -3e4, 5e4}, {5, 0.3, 2}}),
      localized("UprightCylinder", Cylinder{{0, 0, 0}, {0, 0, 1}, 1, 2}),
      localized("ObliqueCylinder", Cylinder{{1, 2, 3}, {1, -2, 0.5}, 0.7, 1.9}),
      localized("FlatCylinderFarAway", Cylinder{{2e4, 1e4, 0}, {1e-3, 2e-3, 1e-3}, 3, 0.5}),
      localized("PeriodicCylinder", Cylinder{{1, 2, 3}, {0, 0, 2}, 1, 2, true}),
      localized("PeriodicCylinderFarAway", Cylinder{{2e4, 1e4, -3e4}, {0, -0.5, 0}, 0.7, 3, true}),
      localized("BoxBetweenTwoWalls", Box{{0.3, -2, 1}, {1, 1.4, 0.8}, {true, false, true}}),
      localized("BoxBetweenFourWallsFarAway", Box{{3e3, 0, -1e4}, {1, 1.4, 0.8}, {false, true, false}}),
      localized("Sphere", Sphere{{0, 0, 0}, 1}),
      localized("SphereFarAway", Sphere{{-7e3, 123.456, 1e4}, 0.6}),
      localized("Cone", Revolved{.profile = {{0, 0}, {1, 0}, {0, 1.5}}}),
      localized("ObliqueFrustum", Revolved{{1, 2, 3}, {1, -2, 0.5}, {{0, 0}, {0.4, 0}, {1, 1.2}, {0, 1.2}}}),
      localized("FlatConeFarAway", Revolved{{2e3, 1e3, 0}, {0, -2, 0}, {{0, 0}, {3, 0.05}, {0, 0.6}}}),
      localized("Tube", Revolved{.profile = {{0.4, 0}, {1, 0}, {1, 1.6}, {0.4, 1.6}}}),
      localized("Hopper", Revolved{.profile = {{0, 0}, {0.2, 0}, {0.2, 0.2}, {1, 1}, {1, 2}, {0, 2}}}),
      localized(
          "ObliqueFlask",
          Revolved{{0, 0, 0}, {1, 1, 3}, {{0, 2}, {0.25, 2}, {0.3, 1.2}, {1, 0.6}, {0.9, 0}, {0, 0.2}}}),
      localized("RoundedCylinder", rounded(Cylinder{{0, 0, 1}, {1, 2, 0}, 1, 1.5}, 0.4)),
      localized("CubeMesh", box_mesh({0, 0, 0}, {1, 1, 1})),
      localized("PrismMesh", prism_mesh(8, 1, 2)),
      localized("LShapeMeshFarAway", translated(l_shape_mesh(), {1e4, -2e4, 3e4})),
      localized("IcosphereMesh", icosphere_mesh(1, 1)),
      localized("TorusMesh", torus_mesh(1, 0.4, 12, 6, 0.05)),
      localized("HelixMesh", helix_mesh(20, 3)),
      localized("BoxAroundABarMesh",
                without(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({-1, 0.3, 0.4}, {3, 0.25, 0.3}))),
      localized("PrismAroundAPipeMesh",
                without(prism_mesh(12, 1, 2),
                        translated(turned(prism_mesh(8, 0.3, 4), {1, 0.2, 0}), {-2, -0.4, 1}))),
      localized("SphereWithCavityMesh", joined(icosphere_mesh(1, 1), inverted(icosphere_mesh(0.5, 0)))),
      localized("OctagonalChannelMesh", repeating(prism_mesh(8, 1, 2))),
      localized("CorrugatedChannelMesh", repeating(corrugated_channel(-1.5, 3, 6, 4))),
      localized("ShortWavesMeshFarAway",
                repeating(translated(corrugated_channel(0, 0.75, 6, 4), {1e3, -2e3, 5e2}))),
  };
}

long double precise_clearance(const Domain& shape, const Vector<3>& point);

/// The same for a mesh that repeats itself: over the walls in all periods that can be nearest; the side is
/// that of the closed period.
inline long double precise_clearance_of_images(const Mesh& mesh, const Vector<3>& point) {
  using Real = long double;
  Vector<3> lower = mesh.vertices.front(), upper = lower;
  for (const Vector<3>& v : mesh.vertices) {
    lower = lower.cwiseMin(v);
    upper = upper.cwiseMax(v);
  }
  const Vector<3> size = upper - lower;
  Real home[3], more[3];
  for (int k = 0; k < 3; ++k) {
    const bool repeats = mesh.periodic[static_cast<std::size_t>(k)];
    home[k] =
        repeats ? point[k] - size[k] * std::floor((Real(point[k]) - lower[k]) / size[k]) : Real(point[k]);
    more[k] = repeats ? 1 : 0;  // the nearest point of a wall is at most half a period away along it
  }
  Real squared = std::numeric_limits<Real>::infinity();
  for (const auto& [i, j, k] : mesh.triangles) {
    bool opening = false;
    for (int axis = 0; axis < 3; ++axis)
      for (const double end : {lower[axis], upper[axis]})
        opening =
            opening || (mesh.periodic[static_cast<std::size_t>(axis)] && mesh.vertices[i][axis] == end &&
                        mesh.vertices[j][axis] == end && mesh.vertices[k][axis] == end);
    if (opening) continue;
    for (Real x = -more[0]; x <= more[0]; ++x)
      for (Real y = -more[1]; y <= more[1]; ++y)
        for (Real z = -more[2]; z <= more[2]; ++z) {
          const Point<Real> p(home[0] - x * size[0], home[1] - y * size[1], home[2] - z * size[2]);
          const Point<Real> offset = precise_offset(
              p, Point<Real>(mesh.vertices[i]), Point<Real>(mesh.vertices[j]), Point<Real>(mesh.vertices[k]));
          squared = std::min(squared, dot(offset, offset));
        }
  }
  Mesh closed = mesh;
  closed.periodic = {};
  const bool inside =
      precise_clearance(closed, Vector<3>(static_cast<double>(home[0]), static_cast<double>(home[1]),
                                          static_cast<double>(home[2]))) > 0;
  return (inside ? 1 : -1) * std::sqrt(squared);
}

/// Signed distance to the wall by the plainest definition, in long double: for a mesh over all its triangles,
/// the side by the sum of their solid angles.
inline long double precise_clearance(const Domain& shape, const Vector<3>& point) {
  using Real = long double;
  const Point<Real> p(point);
  if (const auto* box = std::get_if<Box>(&shape)) {
    const Bounds<3> bounds = bounds_of(*box);
    Real least = std::numeric_limits<Real>::infinity(), squared_outside = 0;
    for (int k = 0; k < 3; ++k) {
      if (box->repeats(k)) continue;
      for (const Real depth : {Real(point[k]) - bounds.lower[k], Real(bounds.upper[k]) - point[k]}) {
        least = std::min(least, depth);
        if (depth < 0) squared_outside += depth * depth;
      }
    }
    return least >= 0 ? least : -std::sqrt(squared_outside);
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    return sphere->radius - norm(p - Point<Real>(sphere->center));
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    const Point<Real> axis(cylinder->axis), w = p - Point<Real>(cylinder->base);
    const Real along = dot(w, axis) / norm(axis);
    const Real lateral = cylinder->radius - norm(cross(w, axis)) / norm(axis);
    if (cylinder->periodic) return lateral;
    const Real axial = std::min(along, cylinder->height - along);
    const Real least = std::min(lateral, axial);
    if (least >= 0) return least;
    return -std::hypot(std::min<Real>(lateral, 0), std::min<Real>(axial, 0));
  }
  if (const auto* revolved = std::get_if<Revolved>(&shape)) {
    const Point<Real> axis(revolved->axis), w = p - Point<Real>(revolved->base);
    const Point<Real> at(norm(cross(w, axis)) / norm(axis), dot(w, axis) / norm(axis), 0);
    Real least = std::numeric_limits<Real>::infinity();
    bool inside = false;
    const auto& corners = revolved->profile;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vector<2>&u = corners[k], &v = corners[(k + 1) % corners.size()];
      const Point<Real> a(u[0], u[1], 0), b(v[0], v[1], 0);
      if (u[0] > 0 || v[0] > 0) least = std::min(least, norm(precise_offset(at, a, b)));
      if ((a.y > at.y) != (b.y > at.y)) inside ^= at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x);
    }
    return inside ? least : -least;
  }
  const Mesh& mesh = std::get<Mesh>(shape);
  if (mesh.repeats()) return precise_clearance_of_images(mesh, point);
  Real squared = std::numeric_limits<Real>::infinity(), solid_angle = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Point<Real> a = mesh.vertices[i], b = mesh.vertices[j], c = mesh.vertices[k];
    const Point<Real> offset = precise_offset(p, a, b, c);
    squared = std::min(squared, dot(offset, offset));
    // van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30 (1983), eq. 8.
    const Point<Real> u = a - p, v = b - p, w = c - p;
    const Real nu = norm(u), nv = norm(v), nw = norm(w);
    solid_angle +=
        2 * std::atan2(dot(u, cross(v, w)), nu * nv * nw + dot(u, v) * nw + dot(v, w) * nu + dot(w, u) * nv);
  }
  return (solid_angle > 2 * std::numbers::pi ? 1 : -1) * std::sqrt(squared);
}

}  // namespace bernal::test
