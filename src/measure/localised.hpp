#pragma once
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Spheres in the container's own frame, where rounding errors are as small as they can be: far from the
/// origin the scene's coordinates would lose the digits that tell a contact from a gap. The wall there is
/// `make_local_container`'s.
Spheres<3> localised(const Spheres<dynamic>&, const Frame&);
Boundary<3> localised(const Boundary<3>&, const Frame&);

}  // namespace bernal
