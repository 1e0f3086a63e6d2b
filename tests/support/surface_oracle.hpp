#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "meshes/conforming_surface.hpp"

// What every surface that beds are meshed from is: closed about each region, of the volume that is stated,
// without triangles that cross, the same at opposite ends.
namespace bernal {
namespace conforming_surface_test {

constexpr double pi = std::numbers::pi;

inline Solids solids_in(const Spheres<dynamic>& spheres, const Domain& domain, ContactTreatment contact,
                        double gap = 0.01) {
  return solids_of(spheres, domain, {.contact = contact, .gap = gap, .bridge_radius = 0.2});
}

/// Balls at random places that overlap nothing, as many as some tries find.
inline Spheres<dynamic> scattered(const Domain& domain, double radius, int tries, unsigned seed) {
  std::mt19937 engine(seed);
  const Bounds<3> bounds = bounds_of(domain);
  const Boundary<3> boundary = boundary_of<3>(domain);
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  Spheres<dynamic> spheres(3);
  for (int t = 0; t < tries; ++t) {
    Vector<3> p;
    for (int k = 0; k < 3; ++k) {
      const double inset = boundary.repeats(k) ? 0 : radius;
      p[k] = std::uniform_real_distribution(bounds.lower[k] + inset, bounds.upper[k] - inset)(engine);
    }
    if (cylinder != nullptr && std::hypot(p[0], p[1]) > cylinder->radius - radius) continue;
    bool is_free = true;
    for (std::size_t j = 0; j < spheres.size() && is_free; ++j)
      is_free = boundary.minimum_image(p - spheres.center(j)).norm() > 2 * radius;
    if (is_free) spheres.push_back(p, radius);
  }
  return spheres;
}

/// Four balls on a floor's corner: contacts with each other, the floor and two walls.
inline Spheres<dynamic> touching() {
  Spheres<dynamic> spheres(3);
  for (const Vector<3>& c : {Vector<3>(1, 1, 1), Vector<3>(3, 1, 1), Vector<3>(2, 1 + std::sqrt(3.0), 1),
                             Vector<3>(2, 1 + 1 / std::sqrt(3.0), 1 + 2 * std::sqrt(2.0 / 3))})
    spheres.push_back(c, 1);
  return spheres;
}

/// Edges that are not met once in each sense, over all regions.
inline std::size_t open_edges(const ConformingSurface& surface) {
  std::map<std::tuple<int, std::uint32_t, std::uint32_t>, std::array<int, 2>> seen;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const std::size_t side : {0u, 1u}) {
      const int region = surface.patches[surface.patch[t]].regions[side];
      if (region == SurfacePatch::nothing) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
        ++seen[{region, std::min(a, b), std::max(a, b)}][(a < b) == (side == 0)];
      }
    }
  return static_cast<std::size_t>(std::ranges::count_if(seen, [](const auto& edge) {
    return edge.second != std::array{1, 1};
  }));
}

/// V - E + F of all triangles around a region.
inline long euler_number(const ConformingSurface& surface, int region) {
  std::set<std::uint32_t> vertices;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  long faces = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& regions = surface.patches[surface.patch[t]].regions;
    if (regions[0] != region && regions[1] != region) continue;
    ++faces;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
      vertices.insert(a);
      edges.insert(std::minmax(a, b));
    }
  }
  return static_cast<long>(vertices.size()) - static_cast<long>(edges.size()) + faces;
}

/// Whether the open segment from a to b passes through the inside of a triangle, by more than rounding: flat
/// faces are in one plane to rounding only.
inline bool passes_through(const Vector<3>& a, const Vector<3>& b, const std::array<Vector<3>, 3>& t) {
  const auto volume = [](const Vector<3>& p, const Vector<3>& q, const Vector<3>& r, const Vector<3>& s) {
    return (q - p).cross(r - p).dot(s - p);
  };
  const double above = volume(t[0], t[1], t[2], a), below = volume(t[0], t[1], t[2], b);
  const double reach =
      std::max({(t[1] - t[0]).norm(), (t[2] - t[0]).norm(), (a - t[0]).norm(), (b - t[0]).norm()});
  const double rounding = 4e-15 * reach * reach;
  if (above * below >= 0 || std::min(std::abs(above), std::abs(below)) < rounding) return false;
  const double x = volume(a, b, t[0], t[1]), y = volume(a, b, t[1], t[2]), z = volume(a, b, t[2], t[0]);
  return (x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0);
}

/// Pairs of an edge and a triangle without a common corner that cross, by a search in cells of their own.
inline std::size_t crossings(const ConformingSurface& surface) {
  double cell = 0;
  const auto corner = [&](std::size_t t, std::size_t k) -> const Vector<3>& {
    return surface.vertices[surface.triangles[t][k]];
  };
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) cell = std::max(cell, (corner(t, k) - corner(t, (k + 1) % 3)).norm());
  cell *= 0.3;
  std::map<std::array<int, 3>, std::vector<std::size_t>> cells;
  const auto for_cells = [&](std::size_t t, const auto& visit) {
    const Vector<3> lower = corner(t, 0).cwiseMin(corner(t, 1)).cwiseMin(corner(t, 2)) / cell;
    const Vector<3> upper = corner(t, 0).cwiseMax(corner(t, 1)).cwiseMax(corner(t, 2)) / cell;
    for (int x = static_cast<int>(std::floor(lower[0])); x <= upper[0]; ++x)
      for (int y = static_cast<int>(std::floor(lower[1])); y <= upper[1]; ++y)
        for (int z = static_cast<int>(std::floor(lower[2])); z <= upper[2]; ++z) visit(std::array{x, y, z});
  };
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for_cells(t, [&](const std::array<int, 3>& at) { cells[at].push_back(t); });
  std::size_t found = 0;
  for (const auto& [at, in] : cells)
    for (const std::size_t s : in)
      for (const std::size_t t : in) {
        if (s == t) continue;
        const auto &one = surface.triangles[s], &other = surface.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t a = one[k], b = one[(k + 1) % 3];
          if (std::ranges::find(other, a) != other.end() || std::ranges::find(other, b) != other.end())
            continue;
          found += passes_through(surface.vertices[a], surface.vertices[b],
                                  {corner(t, 0), corner(t, 1), corner(t, 2)});
        }
      }
  return found;
}

inline void expect_sound(const ConformingSurface& surface, double volume_error) {
  EXPECT_EQ(open_edges(surface), 0u);
  EXPECT_EQ(crossings(surface), 0u);
  EXPECT_NEAR(surface.statement.meshed_fluid_volume, surface.statement.fluid_volume,
              volume_error * surface.statement.fluid_volume);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const auto& [lower, upper] : surface.periodic[axis])
      for (int k = 0; k < 3; ++k)
        if (k != static_cast<int>(axis)) {
          ASSERT_EQ(surface.vertices[lower][k], surface.vertices[upper][k]);
        }
}

}  // namespace conforming_surface_test
}  // namespace bernal
