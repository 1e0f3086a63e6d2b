#pragma once
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace bernal {

/// What is in a file; nothing where it cannot be read, and of what is none: a folder, or a pipe, which would
/// have to be waited for.
inline std::string bytes_of_file(const std::filesystem::path& file) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(file, unknown)) return {};
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace bernal
