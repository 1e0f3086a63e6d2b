#pragma once
#include "bernal/core/monitor.hpp"
#include "cad/repair/repaired_mesh.hpp"

namespace bernal::cad {

/// Makes a surface that meets itself one that does not, by this rule:
///
///   crossings within a component: their faces are cut out and the holes filled; where that is not enough,
///     with more and more rings of neighbours. Pieces that this cuts off are dropped if small.
///   closed components that cross each other are bodies: they become their union; those that are oriented
///     against the largest of their group are taken out of it. By CGAL's corefinement, with exact
///     predicates; corners of the cut are rounded.
///
/// What the cut has rounded across something is cut out too; what then remains is counted in `done`. Open
/// components that cross bodies stay: they enclose nothing and have no union with them.
/// Precondition: no degenerate faces. Cost: O(T log² T) for each of up to twenty rounds, and 50 µs a face of
/// bodies that cross; the monitor is heard between rounds and bodies.
RepairedMesh cut_out_crossings(Mesh mesh, const Monitor& monitor = {});

}  // namespace bernal::cad
