#pragma once
#include <filesystem>
#include <vector>

namespace bernal {

/// The files that a scene is read from: its own, and all that it names, which stand now, the distributions
/// and lines in files included that a scene holds once it is read. None where the file is no scene.
std::vector<std::filesystem::path> sources_of_scene(const std::filesystem::path& file);

}  // namespace bernal
