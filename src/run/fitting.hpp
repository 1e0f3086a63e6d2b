#pragma once
#include "bernal/domain/shape.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal {

/// No sphere larger than this fits into the shape: exact for the analytic ones; for a mesh an upper bound
/// from its bounds and its volume.
double largest_fitting_radius(const Shape& shape);

/// Throws Error{bad_scene} at the scene's sizes, with the remedy, if a sphere of that radius cannot fit.
void require_fitting(const Scene& scene, const Shape& container, double radius);

}  // namespace bernal
