#pragma once
#include "bernal/scene/scene.hpp"

namespace bernal::schema {

/// Whether the scene packs a mesh that repeats itself.
bool is_repeated_mesh(const Scene&);

/// Throws Error{bad_scene} for what the scene asks for beside stages and outputs, which say it themselves,
/// and what does not know a mesh that repeats itself.
void require_repetition_known(const Scene&);

}  // namespace bernal::schema
