#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace bernal::cad {

/// Decided by the first bytes.
bool is_zip(const std::filesystem::path& file);

/// A zip archive, with or without 64-bit fields. Entry names compare as in packages: ASCII case-insensitive,
/// without a leading slash, with backslashes as slashes. Errors in it are thrown as Error{bad_mesh} in one
/// phrase.
class ZipArchive {
 public:
  /// Throws if it is truncated or damaged, or has more than 10,000 entries.
  explicit ZipArchive(const std::filesystem::path& file);

  /// In the order of the directory, without folders and macOS metadata.
  const std::vector<std::string>& names() const { return names_; }
  /// The name as stored; nullptr if there is none.
  const std::string* find(std::string_view name) const;
  /// Unpacks an entry. Reads no more than the directory states, and checks the checksum. Throws if its size
  /// is impossible, if it is encrypted, or if more than 4 GiB have been unpacked.
  std::string read(const std::string& name);

 private:
  struct Entry {
    std::size_t name;             ///< index into `names_`
    std::uint64_t place, number;  ///< minizip's position of the entry
  };

  std::unique_ptr<void, int (*)(void*)> zip_;
  std::vector<std::string> names_;
  std::map<std::string, Entry> entries_;  ///< by comparable names
  std::uint64_t unpacked_ = 0;
};

}  // namespace bernal::cad
