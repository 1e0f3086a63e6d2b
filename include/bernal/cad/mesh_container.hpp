#pragma once
#include <memory>

#include "bernal/domain/container.hpp"

namespace bernal {

/// A container bounded by a closed mesh: a CGAL AABB tree over its triangles. The mesh is copied.
/// Precondition: closed, oriented outwards, no self-intersections (what `read_container_mesh` returns).
/// Cost: building O(T log T) and 32,768 distances for a field of clearances, through which most queries far
/// from the wall are one look: about a second for 10^6 triangles, so make it once; near the wall O(log T) and
/// the number of triangles between the sphere and its tangent plane.
std::unique_ptr<Container> make_mesh_container(const Mesh& mesh, WallArithmetic arithmetic,
                                               double resolution);

/// The container of any shape: analytic where there is one, else that of the mesh. Throws as these do.
std::unique_ptr<Container> make_container(const Domain& shape, WallArithmetic arithmetic, double resolution);

/// The container of a shape of the scene in the frame where the packer works.
std::unique_ptr<Container> make_local_container(const Domain& of_scene, const Frame& frame,
                                                WallArithmetic arithmetic);

/// `made`, where somebody has made it already; else that of the domain in its own frame, in plain arithmetic.
std::shared_ptr<const Container> local_container(const Domain& of_scene,
                                                 const std::shared_ptr<const Container>& made);

}  // namespace bernal
