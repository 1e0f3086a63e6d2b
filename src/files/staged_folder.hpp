#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "files/lock.hpp"

namespace bernal {

/// Whether anything has that name, a link that leads nowhere included.
bool stands(const std::filesystem::path& file);

/// Whether the name, as a list of files has it, is one of a file in the folder or in folders below it that
/// no link leads out of.
bool is_name_in(const std::filesystem::path& folder, const std::filesystem::path& name);

/// Files that appear in a folder all together or not at all, in the place of those of an earlier result.
///
/// They are written into a staging folder inside the target, where they are on the same file system and
/// `rename` is atomic. `publish` gives it the name of what is complete, moves the files of the earlier result
/// out of the way and the new ones into their places, and takes that back if one of these fails. Whoever is
/// killed before has changed nothing; whoever is killed after leaves what the next who writes there completes
/// (`files/put_in_place.hpp`) and who reads there takes for the result (`scene/unpublished.hpp`), never a new
/// file beside an old one. Whoever else publishes in the same folder meanwhile waits for its turn, which is a
/// lock of the folder. A file of somebody else that stands in a place is kept under another name. Names may
/// lead into folders below, "case/system/controlDict": those that are missing are made, no link is followed,
/// and those of an earlier result that are empty then go. What is left of the staging goes with the object,
/// and so do folders that only it needed, and staging folders of processes that were killed. Throws
/// Error{cannot_write} with the path and the system's words.
class StagedFolder {
 public:
  explicit StagedFolder(std::filesystem::path folder);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Where the file that will be called `name` is to be written. Precondition: `is_name_in`.
  std::filesystem::path add(const std::string& name);
  /// Throws unless so many bytes are free there.
  void require_room(std::uint64_t bytes) const;
  /// Writes all of that file.
  void write(const std::string& name, std::string_view text);
  std::filesystem::path written(const std::string& name) const { return staging_ / below_ / name; }
  /// All that have been added, with the folders below.
  const std::vector<std::string>& names() const { return names_; }

  /// While it lives the names that `add`, `write` and `written` are given are names in a folder below: that of
  /// a part that could stand for itself.
  class Below {
   public:
    Below(StagedFolder& staged, const std::string& folder) : staged_(staged), outer_(staged.below_) {
      staged.below_ = outer_ + folder + "/";
    }
    ~Below() { staged_.below_ = outer_; }
    Below(const Below&) = delete;
    Below& operator=(const Below&) = delete;

   private:
    StagedFolder& staged_;
    std::string outer_;
  };
  /// "inside/pebble/template-001/", or nothing.
  const std::string& below() const { return below_; }

  /// Gives every added file its final name; returns those, in the order of `add`. The files `replaced`, of an
  /// earlier result, go, whether new ones have their names or not. A link, a device or a pipe is none, and is
  /// kept where a new file takes its place.
  std::vector<std::filesystem::path> publish(const std::vector<std::string>& replaced);
  /// The same where whatever has the name of a new file is an earlier one.
  std::vector<std::filesystem::path> publish() { return publish(names_); }

 private:
  struct NothingMadeYet {};
  StagedFolder(std::filesystem::path folder, NothingMadeYet) : folder_(std::move(folder)) {}
  void make_folders();
  bool stage();

  std::filesystem::path folder_;
  std::filesystem::path staging_;
  Lock lock_;                                ///< of the staging folder, while this process lives
  std::vector<std::filesystem::path> made_;  ///< folders that did not exist, outermost first
  std::vector<std::string> names_;
  std::string below_;
  bool published_ = false;
};

}  // namespace bernal
