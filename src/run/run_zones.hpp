#pragma once
#include "bernal/run/run.hpp"

namespace bernal {

/// Runs the parts of a plan with zones, one after the other, each by a seed of its own that follows from that
/// of the run; layers onto those below them, whose spheres stay. It has no checkpoints. Cost: that of its
/// parts.
Packing run_zones(const Plan& plan, const RunOptions& options);

}  // namespace bernal
