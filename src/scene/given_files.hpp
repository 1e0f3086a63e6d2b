#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// What a file would hold that a scene names and whose content it has itself: a surface as OFF, the spheres
/// of a start and a long list of sizes as .npy, all with the same doubles; nothing where the name is that of
/// a file.
std::optional<std::string> content_given(const Scene&, const std::filesystem::path& name);

/// Whether there is such content, at no cost.
bool is_given(const Scene&, const std::filesystem::path& name);

/// The files that a scene names: those of its container, obstacles and zones, then that of its start, then
/// those that `put_long_lists_beside` has named.
std::vector<std::filesystem::path*> files_named_in(Scene&);

/// Names a file for every list of more than a thousand sizes, which a scene that people may read does not
/// hold: to be called for a scene that is written into a folder, with these files beside it.
void put_long_lists_beside(Scene&);

}  // namespace bernal
