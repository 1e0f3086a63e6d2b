#pragma once
#include <filesystem>
#include <iterator>
#include <string>

#include "files/input_file.hpp"

namespace bernal {

/// What is in a file; nothing where it cannot be read, and of what is none: a folder, or a pipe, which would
/// have to be waited for.
inline std::string bytes_of_file(const std::filesystem::path& file) {
  InputFile in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace bernal
