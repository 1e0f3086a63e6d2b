#pragma once
#include <memory>

#include "bernal/domain/container.hpp"

namespace bernal {

/// A container bounded by a closed mesh: a CGAL AABB tree over its triangles. The mesh is copied.
/// Precondition: closed, oriented outwards, no self-intersections (what `read_container_mesh` returns).
/// Cost: building O(T log T); queries O(log T) far from the wall and in the number of near triangles.
std::unique_ptr<Container> make_mesh_container(const Mesh& mesh, WallArithmetic arithmetic,
                                               double resolution);

}  // namespace bernal
