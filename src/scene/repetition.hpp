#pragma once
#include "bernal/scene/scene.hpp"
#include "scene/entry.hpp"

namespace bernal::schema {

/// Whether the scene packs a tilted periodic box.
bool is_tilted(const Scene&);

/// Whether the scene packs a mesh that repeats itself.
bool is_repeated_mesh(const Scene&);

/// Refuses a tilt that is none of its box. A cell much longer than wide is none either: how many images lie
/// within reach of a point is bounded by that.
void tilt_rule(const PeriodicBox&, const Section&);

/// Throws Error{bad_scene} for what the scene asks for beside stages and outputs, which say it themselves,
/// and what knows neither tilted boxes nor meshes that repeat themselves.
void require_repetition_known(const Scene&);

}  // namespace bernal::schema
