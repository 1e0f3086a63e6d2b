#pragma once
#include <string_view>

#include "bernal/core/unit.hpp"
#include "meshes/conforming_surface.hpp"

namespace bernal {

/// Names flat walls by planes that they lie in, for inlets and outlets: "inlet: z = 0, outlet: z = 4 cm",
/// with numbers in the scene's unit where they carry none; planes of one name become one patch. A wall lies
/// in a plane if all corners of its triangles do, to 1e-6 of the diagonal of the surface.
///
/// Throws Error{bad_argument} for another text, for names that parts of meshes have without it or that differ
/// in case alone, for a wall with two names, and for a plane in which no wall lies, with the distance of the
/// nearest parallel one. Cost: O(triangles).
void name_walls(ConformingSurface&, std::string_view text, Unit unit);

}  // namespace bernal
