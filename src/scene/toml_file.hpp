#pragma once
#include <filesystem>
#include <ios>
#include <string>
#include <string_view>

#include <toml++/toml.h>

#include "bernal/core/error.hpp"

namespace bernal {

/// The text of a TOML file, which errors call "scene" or so; "the file is larger than 1 MiB, which no scene
/// is" ends in `beyond`. Throws Error{bad_scene} for what is no regular file, cannot be read or is larger.
std::string read_toml_text(const std::filesystem::path& file, std::string_view called,
                           std::streamsize largest, std::string_view beyond);

bool is_blank(std::string_view text);

/// Throws Error{bad_scene} with the place in the file of that name for what is not TOML, or is nested deeper
/// than any scene.
toml::table parse_toml(std::string_view text, const std::filesystem::path& name);

/// Where a part of a file stands; of what nobody wrote only the file, `otherwise`, is known.
Location location_of(const toml::source_region& where, const std::string& otherwise);

/// Where a file is that is named at a place: most often in the scene, and else in what lays values over it.
/// Behind links to folders ".." is what the system takes it for; a file that is a link itself may mean the
/// folder that the link stands in, or the one that it leads to.
std::filesystem::path beside(const Location& place, const std::filesystem::path& file);

}  // namespace bernal
