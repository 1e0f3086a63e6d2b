#pragma once
#include <filesystem>
#include <string>

namespace bernal::cad {

/// Why a file is no mesh, and what to do about it, told by its name and its first bytes: native CAD formats,
/// archives, web pages, pointers of git-lfs, formats that nobody has tested. Empty where a reader should try.
std::string known_not_to_be_a_mesh(const std::filesystem::path& file);

}  // namespace bernal::cad
