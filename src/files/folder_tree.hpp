#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files/descriptor.hpp"

namespace bernal {

/// What stands in a folder and in the folders below it, from where no link leads out: names are relative to
/// it and followed from one open folder to the next, so that not even who puts a link in the place of a
/// folder meanwhile leads anybody elsewhere. The folder itself is the one that a user named and may be
/// reached by links. Nothing here replaces what stands anywhere.
class FolderTree {
 public:
  enum class Kind : std::uint8_t { missing, regular, folder, other };  ///< other: a link, a pipe, a device

  explicit FolderTree(const std::filesystem::path& folder);

  const std::filesystem::path& path() const { return path_; }
  /// A folder of that name, or the tree's own for an empty one; where it cannot be opened errno says why.
  Descriptor open_folder(const std::filesystem::path& name = {}) const;

  /// Missing too where the way there is none: a link, or no folder.
  Kind kind_of(const std::filesystem::path& name) const;
  /// Of a regular file; nothing of all else.
  std::optional<std::string> text_of(const std::filesystem::path& name) const;
  /// The regular files in a folder and below it, by names relative to that; what is called `but` is left out.
  std::vector<std::filesystem::path> files_below(const std::filesystem::path& name,
                                                 const std::string& but = {}) const;

  /// Each returns why it could not: words of the system, or of what is in the way; nothing where it could.
  using Complaint = std::optional<std::string>;
  Complaint move(const std::filesystem::path& from, const std::filesystem::path& to) const;
  Complaint make_folder(const std::filesystem::path& name) const;

  /// A folder that is empty.
  bool remove_folder(const std::filesystem::path& name) const;
  /// The folder with the regular files and the folders in it; what else stands in it stays, and then the
  /// folder too.
  void remove_all(const std::filesystem::path& name) const;

 private:
  Descriptor folder_of(const std::filesystem::path& name) const;

  std::filesystem::path path_;
  Descriptor root_;
};

}  // namespace bernal
