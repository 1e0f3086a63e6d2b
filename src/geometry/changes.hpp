#pragma once
#include <vector>

#include "bernal/geometry/mesh.hpp"

namespace bernal {

/// Moves every vertex v to to(v); exact corners and the surface of the file are dropped.
template <class To>
void move_vertices(Mesh& mesh, const To& to) {
  for (Vector<3>& v : mesh.vertices) v = to(v);
  mesh.exact = nullptr;
  mesh.surface = nullptr;
}

/// The surface of a box: corner k is upper along x, y, z if bits 0, 1, 2 of k are set.
Mesh mesh_of_box(const Bounds<3>&);

/// Drops the triangles that are not kept.
void keep_only(Mesh&, const std::vector<bool>& kept);

/// Splits a mesh into `count` parts, each with the vertices that its triangles use; `part` is the part of
/// each triangle. Cost: O(T + V).
std::vector<Mesh> split(const Mesh&, const std::vector<std::uint32_t>& part, std::uint32_t count);

/// Renumbers the vertices in the order in which the triangles first use them, without unused ones.
void drop_unused_vertices(Mesh&);

/// Appends another surface with its own vertices.
void append(Mesh&, const Mesh& other);

/// Merges equal points, in the order in which triangles use them.
void weld_equal_points(Mesh&);

/// Reverses the orientation of all triangles.
void turn_inside_out(Mesh&);

}  // namespace bernal
