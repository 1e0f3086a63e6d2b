#pragma once
#include <cstdint>
#include <filesystem>

namespace bernal {

/// What a name stands for, through links; only a regular file is opened to be read: pipes and devices may
/// never end.
enum class FileKind : std::uint8_t { regular, missing, folder, other };

inline FileKind kind_of_file(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto status = std::filesystem::status(file, unknown);
  return std::filesystem::is_regular_file(status) ? FileKind::regular
         : std::filesystem::is_directory(status)  ? FileKind::folder
         : std::filesystem::exists(status)        ? FileKind::other
                                                  : FileKind::missing;
}

}  // namespace bernal
