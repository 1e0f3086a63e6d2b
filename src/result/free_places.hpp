#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace bernal {

/// The folder of a file, "." where its name has none. Throws Error{cannot_write} for a name that ends in a
/// folder.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Throws Error{cannot_write} where a file of a result, or something that is no file, would be replaced by
/// one of these in the folder.
void require_free(const std::filesystem::path& folder, const std::vector<std::string>& names);

}  // namespace bernal
