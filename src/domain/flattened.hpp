#pragma once
#include "bernal/domain/domain.hpp"
#include "domain/revolved_surface.hpp"

namespace bernal {

/// A solid whose walls are flat.
struct Flattened {
  Mesh mesh;             ///< closed, oriented outwards
  double deviation = 0;  ///< how far a face is at most from the round wall that it stands for
};

/// The mesh of a solid of three dimensions without periods. Flat walls stay where they are. A round wall
/// becomes 256 faces around its axis, a ball 63 rings of 126 faces; they lie inside of the solid
/// (RoundAs::within), or the solid lies inside of them (RoundAs::circumscribed), to rounding. The deviation
/// is below 8e-5 of the largest distance from the axis, of a ball below 7e-4 of its radius. Exact corners of
/// a mesh are dropped. Throws Error{bad_argument} for a polygon. Cost: a microsecond a face.
Flattened flattened(const Domain& solid, RoundAs as);

}  // namespace bernal
