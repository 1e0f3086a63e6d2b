#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// Reads and checks a TOML scene. Throws Error{bad_scene} with file, line and remedy: unknown names come with
/// the nearest valid one, absurd values with the range. A relative mesh `file` is resolved against the
/// scene's folder.
Scene read_scene(const std::filesystem::path& file);

/// The same for text that stands in no file; `name` is what errors call it.
Scene parse_scene(std::string_view toml, const std::filesystem::path& name);

/// The scene as TOML with every default explicit; reading it back gives an equal scene. A mesh file is written
/// relative to `folder`, if that is not empty, so that the result can be read from there.
std::string scene_as_toml(const Scene&, const std::filesystem::path& folder = {});

/// Only its stages, every default explicit: the protocol, ready to be pasted into another scene.
std::string stages_as_toml(const Scene&);

}  // namespace bernal
