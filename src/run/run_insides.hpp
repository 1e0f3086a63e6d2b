#pragma once
#include "bernal/run/run.hpp"

namespace bernal {

/// `run` without what lies inside of spheres; `few_places` as in `Task`.
Packing run_spheres(const Plan& plan, const RunOptions& options, std::vector<Vector<3>> few_places = {});

/// `run` of a plan with packings inside of spheres: the spheres first, then each packing that they hold, by a
/// seed of its own that follows from that of the run, in as many threads at a time as the run has; then,
/// keyed by the number of each sphere, which of them it holds and how that is turned. A run that is stopped
/// fills the spheres whose packings are there. Outcome and reason are those of all levels.
Packing run_with_insides(const Plan& plan, const RunOptions& options);

}  // namespace bernal
