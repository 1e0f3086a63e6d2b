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

/// Fills in what the scene leaves open: stages, how sizes are drawn, what depends on the dimension. `build`
/// does it, too. Throws Error{bad_scene} for what no file could say, such as a radius below 0 or options that
/// no stage has. A scene that is complete stays as it is.
void complete(Scene& scene);

/// The scene as TOML with every default explicit; reading it back gives an equal scene. A mesh file is
/// written relative to `folder`, if that is not empty, so that the result can be read from there.
/// Precondition of both: the scene is complete.
std::string scene_as_toml(const Scene&, const std::filesystem::path& folder = {});

/// Writes that as a file, with the names of other files relative to its folder. What stands in no file, see
/// `MeshFile::surfaces` and `Start::packing`, is written beside it. Throws Error{cannot_write}.
void write_scene(const Scene&, const std::filesystem::path& file);

/// Only its stages, every default explicit: the protocol, ready to be pasted into another scene.
std::string stages_as_toml(const Scene&);

/// "lognormal, median 1, sigma 0.3, basis number"
std::string sizes_in_words(const SceneSizes&);

/// The stage of that name with its defaults. Throws Error{bad_argument} with the nearest name for another.
Stage stage_named(std::string_view name);

/// What a scene may say: all containers, size distributions and stages, a line each; or every key of the one
/// of that name with its default and its range. Throws Error{bad_argument} with the nearest name for another.
std::string reference(std::string_view name = {});

}  // namespace bernal
