#pragma once
#include <cmath>
#include <numbers>
#include <span>

#include "bernal/domain/domain.hpp"

// Small closed meshes with integer vertices, outward orientation.

namespace bernal::meshes {

inline Mesh tetrahedron() {
  return {{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {0, 0, 8}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// An extruded polygon, given counter-clockwise and with the triangulation of its area.
inline Mesh prism(std::span<const std::array<double, 2>> polygon,
                  std::span<const std::array<std::uint32_t, 3>> area, double bottom, double top) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const double z : {bottom, top})
    for (const auto& p : polygon) mesh.vertices.push_back({p[0], p[1], z});
  for (const auto& t : area) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, j + n});
    mesh.triangles.push_back({i, j + n, i + n});
  }
  return mesh;
}

inline Mesh cube(double lower = 0, double upper = 8) {
  const std::array<double, 2> square[] = {{lower, lower}, {upper, lower}, {upper, upper}, {lower, upper}};
  const std::array<std::uint32_t, 3> area[] = {{0, 1, 2}, {0, 2, 3}};
  return prism(square, area, lower, upper);
}

inline Mesh l_shape() {
  const std::array<double, 2> outline[] = {{0, 0}, {8, 0}, {8, 4}, {4, 4}, {4, 8}, {0, 8}};
  const std::array<std::uint32_t, 3> area[] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  return prism(outline, area, 0, 8);
}

inline Mesh regular_prism(std::uint32_t sides, double radius, double height) {
  std::vector<std::array<double, 2>> outline;
  std::vector<std::array<std::uint32_t, 3>> area;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  for (std::uint32_t i = 2; i < sides; ++i) area.push_back({0, i - 1, i});
  return prism(outline, area, 0, height);
}

inline Mesh flipped(Mesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

inline Mesh joined(Mesh a, const Mesh& b) {
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

/// A cube with a cubic hole that no opening leads to.
inline Mesh cube_with_cavity() { return joined(cube(), flipped(cube(3, 5))); }

/// scale x + offset, component by component, as rounded.
inline Mesh moved(Mesh mesh, double scale, const Vector<3>& offset) {
  for (auto& v : mesh.vertices) v = scale * v + offset;
  return mesh;
}

}  // namespace bernal::meshes
