#pragma once
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace bernal {

/// What is in a file; nothing where it cannot be read.
inline std::string bytes_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace bernal
