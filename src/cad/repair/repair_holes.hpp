#pragma once
#include "cad/repair/repaired_mesh.hpp"

namespace bernal::cad {

/// Fills the holes that are at most `widest` wide, as the diagonal of the bounds of their rim. Without such a
/// bound (infinity) a hole wider than half of the part that it is in is an open top, not a hole, and
/// stays; so do holes at whose rim three or more faces meet, and those whose patch would cross the component
/// itself. Faces are turned until neighbours agree; a one-sided surface is left as it is.
/// The first faces are those given. Cost: O(T log² T), and for holes see Patcher::fill.
RepairedMesh close_holes(Mesh mesh, double widest);

}  // namespace bernal::cad
