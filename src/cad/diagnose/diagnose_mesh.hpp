#pragma once
#include "bernal/cad/mesh_report.hpp"
#include "cad/diagnose/counted.hpp"
#include "cad/read/make_triangles.hpp"

namespace bernal::cad {

/// Says what the mesh is, all but `reader`, and orients it outwards if it can be a container: then `problems`
/// is empty. A cavity inside a component is oriented into the cavity; so are the walls of an island in a
/// cavity outwards again, and so on.
///
/// The order of the questions matters, because each is meaningless without the one before: closed, no
/// degenerate triangle, no self-intersection, two-sided, volume. Cost: O(T log² T), half of it the
/// self-intersections.
MeshReport diagnose_mesh(Triangles& triangles);

}  // namespace bernal::cad
