#pragma once
#include <memory>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"

namespace bernal {

/// What of a container is neither in one of the spheres nor, seen along `up`, below one: each stands on a
/// column of its own width. The volume is known to some thousandths of the whole. What is asked about the
/// columns is decided in doubles; a sphere meets the plane that touches a column where it is nearest, which
/// is behind the column elsewhere. Cost: of a question a look at the columns around, those that end above the
/// place. Precondition: `up` is a unit vector; the spheres lie in the container, whose periods are across it.
std::shared_ptr<const Container> above_spheres(std::shared_ptr<const Container>, const Spheres<3>&,
                                               const Vector<3>& up);

}  // namespace bernal
