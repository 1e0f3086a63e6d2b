#pragma once
#include <string_view>

#include "cad/repair/repaired_mesh.hpp"

namespace bernal::cad {

/// Fills the holes up to `widest` wide (the diagonal of the bounds of the rim). With `widest` infinite, a
/// hole wider than half of its part is an open top and stays. Holes with three or more faces at an edge of
/// the rim, and holes whose patch would cross their component, stay too. Faces are flipped until neighbours
/// agree; a one-sided surface does not change. The given faces come first in the result. Cost: O(T log² T),
/// and for holes see Patcher::fill.
RepairedMesh close_holes(Mesh mesh, double widest);
/// What it says then.
inline constexpr std::string_view no_holes = "no holes to close";

}  // namespace bernal::cad
