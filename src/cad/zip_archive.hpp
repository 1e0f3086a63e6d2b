#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace bernal::cad {

/// By its first bytes.
bool is_zip(const std::filesystem::path& file);

/// What stands in an archive, or why that cannot be had.
struct ZipEntry {
  std::string content;
  std::string trouble;  ///< one phrase; empty if all is there
};

/// Looks through the directory of the archive, and reads the first entry whose name ends so, whatever the
/// case. No more is read than the directory says, and it is held against its checksum. Refused are more than
/// 10,000 entries, and sizes that packing cannot have come from.
ZipEntry zip_entry(const std::filesystem::path& archive, std::string_view ending);

}  // namespace bernal::cad
