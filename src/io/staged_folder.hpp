#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace bernal {

/// Files that appear in a folder all together or not at all.
///
/// They are written into a staging folder inside the target, where they are on the same file system and
/// `rename` is atomic; `publish` renames them over earlier ones, and takes that back if one rename fails.
/// What is left of the staging goes with the object, and so do folders that only it needed. Throws
/// Error{cannot_write} with the path and the system's words.
class StagedFolder {
 public:
  explicit StagedFolder(std::filesystem::path folder);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Where the file that will be called `name` is to be written.
  std::filesystem::path add(const std::string& name);
  /// Writes all of that file.
  void write(const std::string& name, std::string_view text);
  /// Gives every added file its final name; returns those, in the order of `add`.
  std::vector<std::filesystem::path> publish();

 private:
  struct NothingMadeYet {};
  StagedFolder(std::filesystem::path folder, NothingMadeYet) : folder_(std::move(folder)) {}
  void make_folders();
  void take_back(const std::vector<std::filesystem::path>& files) const;
  std::filesystem::path earlier(const std::string& name) const;

  std::filesystem::path folder_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> made_;  ///< folders that did not exist, outermost first
  std::vector<std::string> names_;
  bool published_ = false;
};

}  // namespace bernal
