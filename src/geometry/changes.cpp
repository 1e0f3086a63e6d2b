#include "geometry/changes.hpp"

#include <utility>

#include "geometry/edges.hpp"
#include "geometry/point_numbers.hpp"

namespace bernal {

Mesh mesh_of_box(const Bounds<3>& box) {
  Mesh mesh;
  for (unsigned k = 0; k < 8; ++k)
    mesh.vertices.emplace_back(k & 1 ? box.upper[0] : box.lower[0], k & 2 ? box.upper[1] : box.lower[1],
                               k & 4 ? box.upper[2] : box.lower[2]);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

void keep_only(Mesh& mesh, const std::vector<bool>& kept) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < kept.size(); ++t)
    if (kept[t]) mesh.triangles[count++] = mesh.triangles[t];
  mesh.triangles.resize(count);
}

std::vector<Mesh> split(const Mesh& mesh, const std::vector<std::uint32_t>& part, std::uint32_t count) {
  std::vector<Mesh> parts(count);
  for (std::size_t t = 0; t < part.size(); ++t) parts[part[t]].triangles.push_back(mesh.triangles[t]);
  std::vector<std::uint32_t> number(mesh.vertices.size()), owner(mesh.vertices.size(), no_index);
  for (std::uint32_t p = 0; p < count; ++p)
    renumber(parts[p].triangles, [&](std::uint32_t v) {
      if (owner[v] != p) {
        owner[v] = p;
        number[v] = static_cast<std::uint32_t>(parts[p].vertices.size());
        parts[p].vertices.push_back(mesh.vertices[v]);
      }
      return number[v];
    });
  return parts;
}

void drop_unused_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> number(mesh.vertices.size(), no_index);
  std::vector<Vector<3>> used;
  renumber(mesh.triangles, [&](std::uint32_t v) {
    if (number[v] == no_index) {
      number[v] = static_cast<std::uint32_t>(used.size());
      used.push_back(mesh.vertices[v]);
    }
    return number[v];
  });
  mesh.vertices = std::move(used);
}

void append(Mesh& mesh, const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

void weld_equal_points(Mesh& mesh) {
  PointNumbers<Vector<3>> numbers;
  renumber(mesh.triangles, [&](std::uint32_t v) { return numbers.of(mesh.vertices[v]); });
  mesh.vertices = std::move(numbers.points);
}

void turn_inside_out(Mesh& mesh) {
  for (FaceCorners& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace bernal
