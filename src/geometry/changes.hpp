#pragma once
#include <vector>

#include "bernal/geometry/mesh.hpp"

namespace bernal {

/// Moves every vertex v to to(v); exact corners are no longer stated then.
template <class To>
void move_vertices(Mesh& mesh, const To& to) {
  for (Vector<3>& v : mesh.vertices) v = to(v);
  mesh.exact = nullptr;
}

/// The surface of a box: corner k is upper along x, y, z where bits 0, 1, 2 of k are set.
Mesh mesh_of_box(const Bounds<3>&);

/// Drops the triangles that are not kept.
void keep_only(Mesh&, const std::vector<bool>& kept);

/// The parts of a mesh, each with the vertices that its triangles use; `part` says to which of `count` each
/// triangle belongs. Cost: O(T + V).
std::vector<Mesh> split(const Mesh&, const std::vector<std::uint32_t>& part, std::uint32_t count);

/// Numbers the vertices anew, in the order in which the triangles first use them, without the unused ones.
void drop_unused_vertices(Mesh&);

/// The triangles of another surface too, with vertices of their own.
void append(Mesh&, const Mesh& other);

/// Equal points become one, in the order in which triangles use them.
void weld_equal_points(Mesh&);

/// The same triangles, each seen from its other side.
void turn_inside_out(Mesh&);

}  // namespace bernal
