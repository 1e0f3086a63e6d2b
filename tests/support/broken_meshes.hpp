#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "support/meshes.hpp"

// Meshes as they come out of CAD: open, hollow, torn apart and rounded.
namespace bernal::test {

/// Without the triangles that have all corners where `gone` holds.
template <class Gone>
inline Mesh without(Mesh mesh, const Gone& gone) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return gone(mesh.vertices[t[0]]) && gone(mesh.vertices[t[1]]) && gone(mesh.vertices[t[2]]);
  });
  return mesh;
}

/// A closed duct, 1 wide and 1 high, that follows the figure of an eight through itself; its second diagonal
/// lies higher than the first by `step`, so that no faces coincide.
inline Mesh figure_of_eight_mesh(double step = 0.25) {
  const std::vector<Vector<3>> path = {{-3, -3, 0}, {3, 3, 0}, {3, -3, step}, {-3, 3, step}};
  constexpr std::uint32_t n = 4;
  const auto left = [&](std::size_t k) {  // of the way from corner k
    const Vector<3> way = path[(k + 1) % n] - path[k];
    return Vector<3>(Vector<3>(-way[1], way[0], 0).normalized());
  };
  Mesh mesh;
  for (std::size_t k = 0; k < n; ++k) {
    const Vector<3> before = left((k + n - 1) % n), after = left(k);
    const Vector<3> mitre = (before + after) / (1 + before.dot(after)) / 2, up(0, 0, 0.5);
    for (const Vector<3>& corner :
         {Vector<3>(mitre + up), Vector<3>(mitre - up), Vector<3>(-mitre - up), Vector<3>(-mitre + up)})
      mesh.vertices.push_back(path[k] + corner);
  }
  for (std::uint32_t k = 0; k < n; ++k)
    for (std::uint32_t side = 0; side < 4; ++side) {
      const std::uint32_t next = (k + 1) % n, other = (side + 1) % 4;
      mesh.triangles.push_back({4 * k + side, 4 * next + side, 4 * next + other});
      mesh.triangles.push_back({4 * k + side, 4 * next + other, 4 * k + other});
    }
  return mesh;
}
/// What it encloses: where the diagonals meet it winds around twice.
inline double figure_of_eight_volume(double step = 0.25) {
  return std::abs(volume_of(Domain(figure_of_eight_mesh(step)))) - (1 - step);
}

inline Mesh without_top(const Mesh& mesh, double height) {
  return without(mesh, [=](const Vector<3>& v) { return v[2] == height; });
}

/// A vessel of depth 1 and volume 32 whose two legs, up to z = 6 and to z = 8, are both open.
inline Mesh two_chimneys_mesh() {
  const std::vector<std::array<double, 2>> profile = {{0, 0}, {6, 0}, {6, 6}, {4, 6},
                                                      {4, 2}, {2, 2}, {2, 8}, {0, 8}};  // x and z
  constexpr std::uint32_t n = 8, right_end = 2, left_end = 6;
  Mesh mesh;
  for (const double y : {0., 1.})
    for (const auto& [x, z] : profile) mesh.vertices.emplace_back(x, y, z);
  for (std::uint32_t k = 0; k < n; ++k) {
    if (k == right_end || k == left_end) continue;
    const std::uint32_t next = (k + 1) % n;
    mesh.triangles.push_back({k, n + next, next});
    mesh.triangles.push_back({k, n + k, n + next});
  }
  for (const auto& [i, j, k] : std::vector<std::array<std::uint32_t, 3>>{
           {0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}, {0, 5, 6}, {0, 6, 7}}) {
    mesh.triangles.push_back({i, j, k});
    mesh.triangles.push_back({n + i, n + k, n + j});
  }
  return mesh;
}

/// A cup: a prism of height 2 and half width 2 with a square hollow of half width 1 from z = 0.5 up.
inline Mesh cup_mesh() {
  return Mesh{
      {{-2, -2, 0},
       {2, -2, 0},
       {2, 2, 0},
       {-2, 2, 0},
       {-2, -2, 2},
       {2, -2, 2},
       {2, 2, 2},
       {-2, 2, 2},
       {-1, -1, 2},
       {1, -1, 2},
       {1, 1, 2},
       {-1, 1, 2},
       {-1, -1, .5},
       {1, -1, .5},
       {1, 1, .5},
       {-1, 1, .5}},
      {{0, 2, 1},   {0, 3, 2},    {0, 1, 5},    {0, 5, 4},   {1, 2, 6},    {1, 6, 5},    {2, 3, 7},
       {2, 7, 6},   {3, 0, 4},    {3, 4, 7},    {4, 5, 9},   {4, 9, 8},    {5, 6, 10},   {5, 10, 9},
       {6, 7, 11},  {6, 11, 10},  {7, 4, 8},    {7, 8, 11},  {8, 9, 13},   {8, 13, 12},  {9, 10, 14},
       {9, 14, 13}, {10, 11, 15}, {10, 15, 14}, {11, 8, 12}, {11, 12, 15}, {12, 13, 14}, {12, 14, 15}}};
}

/// Its triangles, each with corners of its own.
inline Mesh torn(const Mesh& mesh) {
  Mesh result;
  for (const auto& t : mesh.triangles) {
    const auto first = index(result.vertices.size());
    for (const std::uint32_t v : t) result.vertices.push_back(mesh.vertices[v]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

inline Mesh jittered(Mesh mesh, double by) {
  std::mt19937 draws(7);
  std::uniform_real_distribution<double> between(-by, by);
  for (Vector<3>& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) v[k] += between(draws);
  return mesh;
}

}  // namespace bernal::test
