#pragma once
#include "bernal/plan/plan.hpp"

namespace bernal {

/// Throws Error{bad_scene} where the stages only move spheres, and there is no start.
void require_stage_that_places(const Scene& scene);

/// Throws Error{bad_scene} where no stage heeds what the scene asks of the accuracy; and where spheres may
/// overlap, of stages that would, as they fill this box. Precondition of the second: what is expected is
/// known.
void require_effect_of_accuracy(const Scene& scene);
void require_overlap(const Plan& plan);

/// Throws Error{bad_scene} where a stage has demands on containers that this one does not meet. Precondition:
/// what is expected is known.
void require_fit_for_stages(const Plan& plan);

}  // namespace bernal
