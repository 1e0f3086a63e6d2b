#pragma once
#include "bernal/run/run.hpp"

namespace bernal {

/// The run of a scene whose spheres are to be as large as so many fit, see `Scene::largest`: runs of the same
/// scene with given sizes, larger ones after each that places all spheres and smaller ones after several
/// seeds that do not, until the largest scale that the stages place is known to 2e-5. The stages leave
/// gaps, relaxation of up to 1e-4 of the radii, by which the spheres are smaller than they could be. The
/// result is that of the run with the largest ones, and its scene, with their size and its seed, runs again
/// to the same bits. Precondition: the plan is one of `build`. No time decides anything, so that one seed
/// gives one packing. Cost: up to some hundred such runs; where the container is a CAD file, each reads it.
Packing run_largest(const Plan& plan, const RunOptions& options);

}  // namespace bernal
