#pragma once
#include "bernal/domain/domain.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal::engine {

/// What the engine of a scene brings with it.
inline constexpr const char* engine_effect = "engine";

/// Throws Error{bad_scene}, at the line of the engine or of what does not go with it, where the engine has no
/// walls for the domain, or the scene asks for what an engine does not do. Precondition: the scene is
/// complete, and has an engine.
void require_engine_fits(const Scene& scene, const Domain& domain);

/// What would be started, and where, for so many spheres.
PlanItem planned_engine(const Scene& scene, double spheres);

}  // namespace bernal::engine
