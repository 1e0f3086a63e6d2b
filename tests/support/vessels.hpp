#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "support/meshes.hpp"

// Thick-walled open vessels, and what they hold in closed form.
namespace bernal::test {

/// One corner of a profile that is revolved: its distance from the z axis, height, and in how many corners
/// the circle that it makes is divided.
struct Ring {
  double r, z;
  std::uint32_t corners = 48;
};

/// The solid whose profile is that closed polygon, counterclockwise in (r, z), revolved about z; corners on
/// the axis have r = 0. Neighbouring rings with other numbers of corners are sewn.
inline Mesh revolved(const std::vector<Ring>& profile) {
  Mesh mesh;
  std::vector<std::uint32_t> first;
  for (const Ring& ring : profile) {
    first.push_back(index(mesh.vertices.size()));
    const std::uint32_t n = ring.r == 0 ? 1 : ring.corners;
    for (std::uint32_t k = 0; k < n; ++k) {
      const double angle = 2 * std::numbers::pi * k / n;
      mesh.vertices.emplace_back(ring.r * std::cos(angle), ring.r * std::sin(angle), ring.z);
    }
  }
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const std::size_t j = (i + 1) % profile.size();
    const std::uint32_t m = profile[i].r == 0 ? 1 : profile[i].corners;
    const std::uint32_t n = profile[j].r == 0 ? 1 : profile[j].corners;
    if (m == 1 && n == 1) continue;
    for (std::uint32_t a = 0, b = 0; a < (m == 1 ? 0 : m) || b < (n == 1 ? 0 : n);) {
      const std::uint32_t here = first[i] + a % m, there = first[j] + b % n;
      const bool along_first = n == 1 || (m > 1 && (a + 1) * std::uint64_t{n} <= (b + 1) * std::uint64_t{m});
      if (along_first) {
        mesh.triangles.push_back({here, first[i] + ++a % m, there});
      } else {
        mesh.triangles.push_back({here, first[j] + (b + 1) % n, there});
        ++b;
      }
    }
  }
  return mesh;
}

/// Between regular polygons about the z axis, whose corners lie on the rings, one above the other.
inline double revolved_volume(const std::vector<Ring>& inner) {
  double volume = 0;
  for (std::size_t i = 0; i + 1 < inner.size(); ++i) {
    const auto& [r, z, n] = inner[i];
    const auto& [s, w, unused] = inner[i + 1];
    volume += n * std::sin(2 * std::numbers::pi / n) / 2 * (w - z) * (r * r + r * s + s * s) / 3;
  }
  return volume;
}

/// Those boxes between neighbouring numbers of `edges` that are solid: walls along axes.
inline Mesh box_work_mesh(const std::array<std::vector<double>, 3>& edges,
                          const std::function<bool(const Vector<3>& middle)>& is_solid) {
  Mesh mesh;
  std::map<std::array<std::size_t, 3>, std::uint32_t> corners;
  const auto corner = [&](const std::array<std::size_t, 3>& at) {
    const auto [entry, is_new] = corners.try_emplace(at, index(mesh.vertices.size()));
    if (is_new) mesh.vertices.emplace_back(edges[0][at[0]], edges[1][at[1]], edges[2][at[2]]);
    return entry->second;
  };
  const auto solid = [&](std::array<std::ptrdiff_t, 3> cell) {
    Vector<3> middle;
    for (std::size_t k = 0; k < 3; ++k) {
      if (cell[k] < 0 || cell[k] + 1 >= std::ssize(edges[k])) return false;
      const auto i = static_cast<std::size_t>(cell[k]);
      middle[static_cast<int>(k)] = (edges[k][i] + edges[k][i + 1]) / 2;
    }
    return is_solid(middle);
  };
  for (std::ptrdiff_t x = 0; x + 1 < std::ssize(edges[0]); ++x)
    for (std::ptrdiff_t y = 0; y + 1 < std::ssize(edges[1]); ++y)
      for (std::ptrdiff_t z = 0; z + 1 < std::ssize(edges[2]); ++z) {
        if (!solid({x, y, z})) continue;
        for (std::size_t k = 0; k < 3; ++k)
          for (const std::ptrdiff_t side : {0, 1}) {
            std::array<std::ptrdiff_t, 3> next{x, y, z};
            next[k] += 2 * side - 1;
            if (solid(next)) continue;
            std::array<std::size_t, 3> at{static_cast<std::size_t>(x), static_cast<std::size_t>(y),
                                          static_cast<std::size_t>(z)};
            at[k] += static_cast<std::size_t>(side);
            std::array<std::uint32_t, 4> face;
            for (std::size_t c = 0; c < 4; ++c) {
              auto here = at;
              here[(k + 1) % 3] += c == 1 || c == 2;
              here[(k + 2) % 3] += c >= 2;
              face[c] = corner(here);
            }
            if (side == 0) std::swap(face[1], face[3]);
            mesh.triangles.push_back({face[0], face[1], face[2]});
            mesh.triangles.push_back({face[0], face[2], face[3]});
          }
      }
  return mesh;
}

}  // namespace bernal::test
