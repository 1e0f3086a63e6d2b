#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// What a file would hold that a scene names and whose content it has itself: a surface as OFF, the spheres
/// of a start as .npy, both with the same doubles; nothing where the name is that of a file.
std::optional<std::string> content_given(const Scene&, const std::filesystem::path& name);

/// Whether there is such content, at no cost.
bool is_given(const Scene&, const std::filesystem::path& name);

/// The files that a scene names: those of its container, then that of its start.
std::vector<std::filesystem::path*> files_named_in(Scene&);

}  // namespace bernal
