#pragma once
#include <memory>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"

namespace bernal {

/// The part of a container that is neither in one of the spheres nor below one, seen along `up`: under each
/// sphere there is a column of its width. The error of the volume is some thousandths of the container's. The
/// columns are decided in doubles. In place of a column a sphere meets the plane that touches it at the
/// nearest point; elsewhere this plane is behind the surface of the column. Cost of a question: a look at the
/// columns around that end above the place. Preconditions: `up` is a unit vector; the spheres lie in the
/// container, whose periods are perpendicular to it.
std::shared_ptr<const Container> above_spheres(std::shared_ptr<const Container>, const Spheres<3>&,
                                               const Vector<3>& up);

}  // namespace bernal
