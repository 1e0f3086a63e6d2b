#pragma once
#include <memory>

#include "bernal/domain/container.hpp"

namespace bernal {

/// A container bounded by a closed mesh: a CGAL AABB tree over its triangles. The mesh is copied.
/// Precondition: closed, oriented outwards, no self-intersections (what `read_container_mesh` returns).
/// Cost: building takes O(T log T) and 32,768 distances, about a second for 10^6 triangles, so make it once.
/// One that repeats itself is held with its images as far as clearances reach: at least three times as many
/// triangles. Throws Error{bad_argument} where those are more than 32 periods on either side.
/// Far from the wall a query is one look-up in a field of clearances; near the wall it is O(log T) plus the
/// triangles between the sphere and its tangent plane.
std::unique_ptr<Container> make_mesh_container(const Mesh& mesh, WallArithmetic arithmetic,
                                               double resolution);

/// The container of any domain: analytic if the shape has a formula, else a mesh container. Throws what these
/// throw.
std::unique_ptr<Container> make_container(const Domain& shape, WallArithmetic arithmetic, double resolution);

/// The container of a domain given in the scene's unit, in the packer's frame.
std::unique_ptr<Container> make_local_container(const Domain& of_scene, const Frame& frame,
                                                WallArithmetic arithmetic);

/// Returns `made` if it is not null, else makes the container of the domain in its own frame, in plain
/// arithmetic.
std::shared_ptr<const Container> local_container(const Domain& of_scene,
                                                 const std::shared_ptr<const Container>& made);

}  // namespace bernal
