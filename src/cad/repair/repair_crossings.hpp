#pragma once
#include "bernal/core/monitor.hpp"
#include "cad/repair/repaired_mesh.hpp"

namespace bernal::cad {

/// Removes the self-intersections of a surface:
///
///   crossings within a component: their faces are cut out and the holes filled, with more and more rings of
///     neighbours if that is not enough. Pieces that this cuts off are dropped if small.
///   closed components that cross each other are bodies: they become their union; those oriented against the
///     largest of their group are subtracted. By CGAL's corefinement, with exact predicates; corners of the
///     cut are rounded.
///
/// Crossings that this rounding makes are cut out too; what remains is counted in `done`. Open components
/// that cross bodies stay: they enclose nothing, so there is no union. Precondition: no degenerate faces.
/// Cost: O(T log² T) for each of up to twenty rounds, and 50 µs a face of crossing bodies; the monitor is
/// polled between rounds and bodies.
RepairedMesh cut_out_crossings(Mesh mesh, const Monitor& monitor = {});

}  // namespace bernal::cad
