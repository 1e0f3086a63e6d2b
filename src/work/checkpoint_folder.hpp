#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "core/archive.hpp"
#include "files/lock.hpp"
#include "scene/run_archive.hpp"

namespace bernal {

/// Whose a checkpoint is: what a run depends on. With other packings, another scene or seed nothing can go on
/// from it.
struct CheckpointOwner {
  Program program;    ///< that wrote it: every one of its packings number can go on
  std::string scene;  ///< complete, as text, less what is below
  std::string files;  ///< the SHA-256 of CAD files and starts
  std::uint64_t seed = 0;
  void archive(Archive& a) { a(program, scene, files, seed); }
};

/// The checkpoints of a run, in a folder of their own inside the one that will hold its result:
/// `.bernal-checkpoint`. The last one is `latest`; it takes the place of the one before it, by renaming, once
/// all of it is on the disk, and that one stays as `before`. So whenever a process is killed, at least one
/// is whole, once there has been one.
///
/// A file is a name and a format number, its owner, what the run writes, the number of bytes so far and a
/// 64-bit sum of them: a file that was cut short, or of which any bit has changed, is told from a whole one.
///
/// From its beginning a run holds a lock of the folder, so that no other takes it for abandoned or writes its
/// own there.
class CheckpointFolder {
 public:
  /// Of the folder that will hold the result. Nothing is made yet.
  explicit CheckpointFolder(const std::filesystem::path& result);
  /// Takes away what `claim` has made, if nothing is in it.
  ~CheckpointFolder();
  CheckpointFolder(const CheckpointFolder&) = delete;
  CheckpointFolder& operator=(const CheckpointFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }

  /// Makes the folder and holds its lock until this ends. False where another run holds it. Throws
  /// Error{cannot_write} where it cannot be made.
  bool claim();

  /// Writes one, whose contents `write` gives. Throws Error{cannot_write} where that cannot be, and where
  /// another run holds the folder; the earlier ones are what they were.
  void write(CheckpointOwner& owner, const std::function<void(Archive&)>& write);

  /// The latest that is whole, after its owner; null if there is none. `note` says in a sentence what was
  /// wrong with one that had to be passed over, `by` who wrote it. Throws Error{bad_argument} where that is
  /// another's, naming what differs, and where another run holds the folder.
  std::unique_ptr<Archive> open(const CheckpointOwner& owner, std::string& note, Program& by);

  /// Whether there is one, whole or not.
  static bool stands_in(const std::filesystem::path& result);
  /// Takes all of them away, unless another run is at work with them.
  static void remove_from(const std::filesystem::path& result);

 private:
  bool hold();
  std::filesystem::path folder_;
  bool made_result_ = false;  // the folder that will hold the result
  Lock lock_;
};

}  // namespace bernal
