#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace bernal::cad {

/// By its first bytes.
bool is_zip(const std::filesystem::path& file);

/// A zip archive, with or without the fields of 64 bits. Names of entries are compared as those of packages
/// are: whatever the case of ASCII letters, without a slash in front, slashes for backslashes. What is wrong
/// with it is refused as Error{bad_mesh} in one phrase.
class ZipArchive {
 public:
  /// Throws where it is cut short or damaged, or holds more than 10,000 entries.
  explicit ZipArchive(const std::filesystem::path& file);

  /// In the order of the directory; folders and what macOS adds are left out.
  const std::vector<std::string>& names() const { return names_; }
  /// As it stands in the archive; nullptr where there is none.
  const std::string* find(std::string_view name) const;
  /// Unpacks one of the names. No more is read than the directory says, and it is held against its checksum.
  /// Throws where its size is none that packing comes to, it is encrypted, or more than 4 GiB have been
  /// unpacked.
  std::string read(const std::string& name);

 private:
  struct Entry {
    std::size_t name;             ///< which of the names
    std::uint64_t place, number;  ///< as minizip finds it again
  };

  std::unique_ptr<void, int (*)(void*)> zip_;
  std::vector<std::string> names_;
  std::map<std::string, Entry> entries_;  ///< by comparable names
  std::uint64_t unpacked_ = 0;
};

}  // namespace bernal::cad
