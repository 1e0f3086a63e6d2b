#pragma once
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Whether a closed mesh, which does not cross itself, is convex, to rounding: in one piece, and at every
/// edge the next face does not rise above the one before. Cost: O(faces log faces).
bool is_convex(const Mesh& mesh);

}  // namespace bernal
