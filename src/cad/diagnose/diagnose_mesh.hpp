#pragma once
#include "bernal/cad/mesh_report.hpp"
#include "cad/diagnose/counted.hpp"
#include "cad/read/make_triangles.hpp"

namespace bernal::cad {

/// Describes the mesh in a report (all but `reader`) and orients it outwards if it can be a container;
/// `problems` is empty then. A cavity inside a component is oriented into the cavity, the walls of an island
/// in a cavity outwards, and so on.
///
/// The tests are ordered, because each presupposes the one before: closed, no degenerate triangle, no
/// self-intersection, two-sided, volume. Cost: O(T log² T), half of it for the self-intersections.
MeshReport diagnose_mesh(Triangles& triangles);

}  // namespace bernal::cad
