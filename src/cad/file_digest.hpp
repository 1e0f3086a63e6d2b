#pragma once
#include <filesystem>
#include <string>

namespace bernal {

/// The SHA-256 of a file's bytes, 64 hexadecimal digits: what `sha256sum` prints. Throws Error{bad_mesh}
/// where the file cannot be read. Cost: reading it, and about 3 ns a byte.
std::string sha256_of(const std::filesystem::path& file);

}  // namespace bernal
