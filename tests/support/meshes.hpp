#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "bernal/domain/domain.hpp"

// Meshes to test with, all closed and oriented outwards, and writers that keep every double.
namespace bernal::test {

inline std::uint32_t index(std::size_t i) { return static_cast<std::uint32_t>(i); }

/// The prism over a polygon (x, y), counterclockwise, from z = 0 to `height`; `caps` triangulates the
/// polygon.
inline Mesh extrude(const std::vector<std::array<double, 2>>& polygon, double height,
                    const std::vector<std::array<std::uint32_t, 3>>& caps) {
  const std::uint32_t n = index(polygon.size());
  Mesh mesh;
  for (const double z : {0.0, height})
    for (const auto& [x, y] : polygon) mesh.vertices.emplace_back(x, y, z);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
  }
  for (const auto& [i, j, k] : caps) {
    mesh.triangles.push_back({i, k, j});
    mesh.triangles.push_back({n + i, n + j, n + k});
  }
  return mesh;
}

/// A regular prism about the z axis, corners at distance `radius` from it.
inline Mesh prism_mesh(std::uint32_t sides, double radius, double height) {
  std::vector<std::array<double, 2>> polygon;
  std::vector<std::array<std::uint32_t, 3>> caps;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    if (i >= 2) caps.push_back({0, i - 1, i});
  }
  return extrude(polygon, height, caps);
}

inline Mesh box_mesh(const Vector<3>& corner, const Vector<3>& size) {
  Mesh mesh =
      extrude({{0, 0}, {size[0], 0}, {size[0], size[1]}, {0, size[1]}}, size[2], {{0, 1, 2}, {0, 2, 3}});
  for (Vector<3>& v : mesh.vertices) v += corner;
  return mesh;
}

/// Two arms of width 1 and length 2: a reflex edge along (1, 1, z). Volume 3 `height`.
inline Mesh l_shape_mesh(double height = 1) {
  return extrude({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, height,
                 {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}});
}

/// A square tube along x: its half width at each of the given x, which do not fall.
inline Mesh square_tube_mesh(const std::vector<std::array<double, 2>>& rings) {
  Mesh mesh;
  for (const auto& [x, half] : rings)
    for (const auto& [y, z] : {std::array{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
      mesh.vertices.emplace_back(x, half * y, half * z);
  const std::uint32_t last = 4 * index(rings.size() - 1);
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {last, last + 1, last + 2}, {last, last + 2, last + 3}};
  for (std::uint32_t ring = 0; ring < last; ring += 4)
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t j = (i + 1) % 4;
      mesh.triangles.push_back({ring + i, ring + j, ring + 4 + j});
      mesh.triangles.push_back({ring + i, ring + 4 + j, ring + 4 + i});
    }
  return mesh;
}

/// Two cubes of edge 2 whose centres lie on the x axis, joined by a neck of length 1 and half width `half`:
/// from x = 0 to 2 and from 3 to 5.
inline Mesh two_cubes_mesh(double half) {
  return square_tube_mesh({{0, 1}, {2, 1}, {2, half}, {3, half}, {3, 1}, {5, 1}});
}

/// A box of 4 x 2 x `height` with a baffle across its middle, 0.02 thick, that ends `gap` above y = 0.
inline Mesh baffle_mesh(double gap, double height) {
  return extrude({{0, 0}, {4, 0}, {4, 2}, {2.01, 2}, {2.01, gap}, {1.99, gap}, {1.99, 2}, {0, 2}}, height,
                 {{0, 5, 6}, {0, 6, 7}, {1, 2, 3}, {1, 3, 4}, {0, 1, 4}, {0, 4, 5}});
}

/// A closed tube about the closed curve `center(u)`, u in [0, 1), with rings of `radius(u, v)`; the rings are
/// built on the unit vectors `first(u)` and `second(u)`, with first × second along the curve.
template <typename Center, typename Radius, typename First, typename Second>
Mesh closed_tube(std::uint32_t along, std::uint32_t around, Center center, Radius radius, First first,
                 Second second) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < along; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      const double u = double(i) / along, v = double(j) / around, angle = 2 * std::numbers::pi * v;
      mesh.vertices.push_back(center(u) +
                              radius(u, v) * (std::cos(angle) * first(u) + std::sin(angle) * second(u)));
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return (i % along) * around + j % around; };
  for (std::uint32_t i = 0; i < along; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return mesh;
}

/// A torus about the z axis with 2·along·around triangles; `bumps` is the relative height of a ripple.
inline Mesh torus_mesh(double major, double minor, std::uint32_t along, std::uint32_t around,
                       double bumps = 0) {
  const auto outward = [](double u) {
    const double angle = 2 * std::numbers::pi * u;
    return Vector<3>(std::cos(angle), std::sin(angle), 0);
  };
  return closed_tube(
      along, around, [=](double u) -> Vector<3> { return major * outward(u); },
      [=](double u, double v) {
        return minor *
               (1 + bumps * std::sin(40 * std::numbers::pi * u) * std::sin(16 * std::numbers::pi * v));
      },
      outward, [](double) { return Vector<3>(0, 0, -1); });
}

/// A tube wound three times around a torus: a closed helix whose turns come near each other, with edges and
/// corners that are nearest points from inside as well as from outside.
inline Mesh helix_mesh(std::uint32_t along = 96, std::uint32_t around = 10) {
  constexpr double turn = 2 * std::numbers::pi;
  const auto center = [](double u) {
    const double angle = 3 * turn * u;
    return Vector<3>((2 + std::cos(turn * u)) * std::cos(angle), (2 + std::cos(turn * u)) * std::sin(angle),
                     2 * std::sin(turn * u));
  };
  const auto ahead = [=](double u) -> Vector<3> {
    return (center(u + 1e-6) - center(u - 1e-6)).normalized();
  };
  const auto first = [=](double u) -> Vector<3> { return ahead(u).cross(Vector<3>::UnitZ()).normalized(); };
  return closed_tube(
      along, around, center, [](double, double) { return 0.35; }, first,
      [=](double u) -> Vector<3> { return ahead(u).cross(first(u)); });
}

/// The same surface, each triangle divided `levels` times into four.
inline Mesh divided(Mesh mesh, int levels) {
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto between = [&](std::uint32_t i, std::uint32_t j) {
      const auto [entry, is_new] = middle.try_emplace(std::minmax(i, j), index(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(0.5 * (mesh.vertices[i] + mesh.vertices[j]));
      return entry->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [i, j, k] : mesh.triangles) {
      const std::uint32_t ij = between(i, j), jk = between(j, k), ki = between(k, i);
      finer.insert(finer.end(), {{i, ij, ki}, {j, jk, ij}, {k, ki, jk}, {ij, jk, ki}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

/// An icosahedron, each triangle divided `levels` times into four, on the sphere of the given radius.
inline Mesh icosphere_mesh(double radius, int levels) {
  const double g = std::numbers::phi;
  Mesh mesh{{{-1, g, 0},
             {1, g, 0},
             {-1, -g, 0},
             {1, -g, 0},
             {0, -1, g},
             {0, 1, g},
             {0, -1, -g},
             {0, 1, -g},
             {g, 0, -1},
             {g, 0, 1},
             {-g, 0, -1},
             {-g, 0, 1}},
            {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  mesh = divided(std::move(mesh), levels);
  for (Vector<3>& v : mesh.vertices) v = radius * v.normalized();
  return mesh;
}

inline Mesh scaled(Mesh mesh, double factor) {
  for (Vector<3>& v : mesh.vertices) v *= factor;
  return mesh;
}

inline Mesh translated(Mesh mesh, const Vector<3>& by) {
  for (Vector<3>& v : mesh.vertices) v += by;
  return mesh;
}

inline Mesh inverted(Mesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

inline void append(Mesh& mesh, const Mesh& other) {
  const std::uint32_t first = index(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [i, j, k] : other.triangles) mesh.triangles.push_back({first + i, first + j, first + k});
}

inline Mesh joined(Mesh mesh, const Mesh& other) {
  test::append(mesh, other);
  return mesh;
}

/// The z axis turned to a direction.
inline Mesh turned(Mesh mesh, const Vector<3>& direction) {
  const Vector<3> z = direction.normalized(), x = z.unitOrthogonal(), y = z.cross(x);
  for (Vector<3>& v : mesh.vertices) v = v[0] * x + v[1] * y + v[2] * z;
  return mesh;
}

/// Two cubes of edge 1 whose nearest corners are so far apart, along a diagonal of space.
inline Mesh cubes_apart(double distance) {
  return joined(box_mesh({0, 0, 0}, {1, 1, 1}),
                box_mesh(Vector<3>::Constant(1 + distance / std::numbers::sqrt3), {1, 1, 1}));
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

inline std::string as_off(const Mesh& mesh) {
  std::ostringstream out;
  out.precision(17);
  out << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
  for (const Vector<3>& v : mesh.vertices) out << v[0] << ' ' << v[1] << ' ' << v[2] << '\n';
  for (const auto& [i, j, k] : mesh.triangles) out << "3 " << i << ' ' << j << ' ' << k << '\n';
  return out.str();
}

inline std::string as_obj(const Mesh& mesh) {
  std::ostringstream out;
  out.precision(17);
  for (const Vector<3>& v : mesh.vertices) out << "v " << v[0] << ' ' << v[1] << ' ' << v[2] << '\n';
  for (const auto& [i, j, k] : mesh.triangles) out << "f " << i + 1 << ' ' << j + 1 << ' ' << k + 1 << '\n';
  return out.str();
}

inline std::string as_text_stl(const Mesh& mesh, const std::string& name = "part", int digits = 17) {
  std::ostringstream out;
  out.precision(digits);
  out << "solid " << name << '\n';
  for (const auto& t : mesh.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t i : t) {
      const Vector<3>& v = mesh.vertices[i];
      out << "vertex " << v[0] << ' ' << v[1] << ' ' << v[2] << '\n';
    }
    out << "endloop\nendfacet\n";
  }
  out << "endsolid " << name << '\n';
  return out.str();
}

inline std::string as_binary_stl(const Mesh& mesh, std::string header = "binary") {
  header.resize(80);
  std::string out = header;
  const auto append = [&](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  append(index(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) append(0.0F);
    for (const std::uint32_t i : t)
      for (int k = 0; k < 3; ++k) append(static_cast<float>(mesh.vertices[i][k]));
    append(std::uint16_t{0});
  }
  return out;
}

}  // namespace bernal::test
