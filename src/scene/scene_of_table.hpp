#pragma once
#include <filesystem>

#include <toml++/toml.h>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// The scene that a table of TOML says, as `read_scene` reads it; `file` is where most of it stands. Parts
/// that come from another file keep their place: errors name it, and what they name is meant beside it.
/// Throws as `read_scene`.
Scene scene_of_table(const toml::table& root, const std::filesystem::path& file);

}  // namespace bernal
