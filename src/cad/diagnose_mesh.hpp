#pragma once
#include "bernal/cad/mesh_report.hpp"
#include "cad/counted.hpp"
#include "cad/make_triangles.hpp"

namespace bernal::cad {

/// Says what the mesh is, all but `reader`, and orients it outwards if it can be a container: then `problems`
/// is empty. A cavity inside a component is oriented into the cavity; so are the walls of an island in a
/// cavity outwards again, and so on.
///
/// The order of the questions matters, because each is meaningless without the one before: closed, no
/// degenerate triangle, no self-intersection, two-sided, volume. Cost: O(T log² T), half of it the
/// self-intersections.
MeshReport diagnose_mesh(Triangles& triangles);

/// Twice the area of a triangle, along its normal.
Vector<3> cross_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle);
/// Of the signed tetrahedron between a triangle and a point; least cancels where that is the middle of all.
double six_signed_volumes(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle,
                          const Vector<3>& point);
/// What a closed, consistently oriented surface encloses: above 0 where it is turned outward.
double signed_volume(const Mesh& mesh);

/// Of all vertices, used or not. Precondition: there are any.
Bounds<3> bounds_of_vertices(const Mesh& mesh);
/// Of those that faces use.
Bounds<3> bounds_of_faces(const Mesh& mesh);

}  // namespace bernal::cad
