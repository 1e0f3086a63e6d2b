#pragma once
#include <memory>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"

namespace bernal {

// Spheres and wall in the container's own frame, where rounding errors are as small as they can be: far from
// the origin the scene's coordinates would lose the digits that tell a contact from a gap.

Spheres<3> localised(const Spheres<dynamic>&, const Frame&);
std::unique_ptr<Container> localised(const Shape&, const Frame&);

}  // namespace bernal
