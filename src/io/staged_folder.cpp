#include "io/staged_folder.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "io/output_file.hpp"

namespace fs = std::filesystem;

namespace bernal {

bool stands(const fs::path& file) {
  std::error_code unknown;
  return fs::symlink_status(file, unknown).type() != fs::file_type::not_found;
}

bool is_name_in(const fs::path& folder, const fs::path& name) {
  if (!name.has_filename() || name.is_absolute() || name != name.lexically_normal() || name == "." ||
      *name.begin() == "..")
    return false;
  for (fs::path below = name.parent_path(); !below.empty(); below = below.parent_path()) {
    std::error_code unknown;
    if (fs::is_symlink(folder / below, unknown)) return false;
  }
  return true;
}

namespace {

/// What the staging folder is called once all is written, while what the files replace moves to
/// `earlier_name` below it; and then, while they move into their places.
constexpr const char* complete_name = ".bernal-complete";
constexpr const char* placing_name = ".bernal-placing";
constexpr const char* earlier_name = ".earlier";
/// In it, which files it replaces, a line each; nothing that lacks it is touched.
constexpr const char* replaced_name = ".replaced";

/// For another process that publishes in the same folder, which takes milliseconds.
constexpr std::chrono::seconds longest_wait(30);
constexpr std::chrono::milliseconds between_tries(2);

[[noreturn]] void fail(const std::string& what, const std::string& why, const fs::path& path) {
  throw Error(ErrorCode::cannot_write, what + ": " + why, {path.string()});
}

/// Of an open folder, for this process; -1 where another one holds it or, as errno then says, file systems
/// know no locks.
int locked(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  const int why = errno;
  if (descriptor >= 0) ::close(descriptor);
  errno = why;
  return -1;
}

/// Whether nobody is at work with a folder of which a lock cannot be had: file systems know none, and it has
/// stood for much longer than publishing takes.
bool is_left(const fs::path& folder, int why_no_lock) {
  constexpr std::chrono::seconds long_enough(10);
  if (why_no_lock != ENOLCK && why_no_lock != EOPNOTSUPP && why_no_lock != ENOSYS) return false;
  std::error_code unknown;
  const auto changed = fs::last_write_time(folder, unknown);
  return !unknown && fs::file_time_type::clock::now() > changed + long_enough;
}

/// Whoever makes, moves or removes in a folder what others could take for theirs does it in turn. Where file
/// systems know no locks everybody has it.
class Turn {
 public:
  explicit Turn(const fs::path& folder)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    const auto end = std::chrono::steady_clock::now() + longest_wait;
    while (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK && errno != EINTR) break;
      if (std::chrono::steady_clock::now() > end) {
        came_ = false;
        break;
      }
      std::this_thread::sleep_for(between_tries);
    }
  }
  ~Turn() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  bool came() const { return came_; }

 private:
  int descriptor_;
  bool came_ = true;
};

/// What stands in a folder, as far as it can be told.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code problem;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end; at.increment(problem))
    entries.push_back(at->path());
  return entries;
}

/// A new folder with a name that nobody else has; empty where none can be made.
fs::path new_staging(const fs::path& folder) {
  std::string pattern = (folder / fmt::format("{}XXXXXX", staging_prefix)).string();
  return ::mkdtemp(pattern.data()) == nullptr ? fs::path() : fs::path(pattern);
}

/// The staging folders of all who write there, or did.
std::vector<fs::path> stagings_in(const fs::path& folder) {
  std::vector<fs::path> stagings = entries_of(folder);
  std::erase_if(stagings,
                [](const fs::path& entry) { return !entry.filename().string().starts_with(staging_prefix); });
  return stagings;
}

/// Staging folders whose processes were killed.
void remove_abandoned(const fs::path& folder) {
  for (const fs::path& entry : stagings_in(folder)) {
    const int lock = locked(entry);
    if (lock < 0) continue;
    std::error_code ignored;
    fs::remove_all(entry, ignored);
    ::close(lock);
  }
}

/// Moves files so that they can be moved back.
class Moves {
 public:
  /// Makes the folder that is missing there.
  void move(const fs::path& from, const fs::path& to) {
    make_folder(to.parent_path());
    std::error_code problem;
    fs::rename(from, to, problem);
    if (problem) fail("cannot be replaced", problem.message(), to);
    done_.emplace_back(from, to);
  }
  void take_back() {
    std::error_code ignored;
    for (; !done_.empty(); done_.pop_back()) fs::rename(done_.back().second, done_.back().first, ignored);
    for (; !made_.empty(); made_.pop_back()) fs::remove(made_.back(), ignored);
  }

 private:
  void make_folder(const fs::path& folder) {
    std::error_code problem;
    if (folder.empty() || fs::is_directory(folder, problem)) return;
    make_folder(folder.parent_path());
    if (fs::create_directory(folder, problem)) made_.push_back(folder);
    if (problem) fail("the folder cannot be made", problem.message(), folder);
  }

  std::vector<std::pair<fs::path, fs::path>> done_;
  std::vector<fs::path> made_;
};

/// What is new in a folder that was staged, relative to it.
std::vector<fs::path> new_files_in(const fs::path& staged) {
  std::vector<fs::path> files;
  std::error_code problem;
  for (fs::recursive_directory_iterator at(staged, problem), end; !problem && at != end;
       at.increment(problem)) {
    const fs::path name = at->path().lexically_relative(staged);
    std::error_code unknown;
    const bool folder = fs::is_directory(at->symlink_status(unknown));
    if (folder && name == earlier_name) at.disable_recursion_pending();
    if (!folder && name != replaced_name) files.push_back(name);
  }
  return files;
}

/// A name in one line, whatever it has in it.
std::string line_of(const std::string& name) {
  std::string line;
  for (const char c : name) line += c == '\n' ? "\\n" : c == '\\' ? "\\\\" : std::string(1, c);
  return line;
}
std::string name_of_line(const std::string& line) {
  std::string name;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const bool escaped = line[k] == '\\' && k + 1 < line.size();
    if (escaped) ++k;
    name += escaped && line[k] == 'n' ? '\n' : line[k];
  }
  return name;
}

std::vector<std::string> names_in(const fs::path& list) {
  std::ifstream in(list);
  std::vector<std::string> names;
  for (std::string line; std::getline(in, line);) names.push_back(name_of_line(line));
  return names;
}

/// Whoever wrote a file there keeps it.
void make_way(const fs::path& file, Moves& moves) {
  fs::path kept;
  for (int k = 1; kept.empty() || stands(kept); ++k)
    kept = fs::path(file).concat(k == 1 ? ".kept" : ".kept-" + std::to_string(k));
  moves.move(file, kept);
}

/// From whatever point on: what is complete takes the place of the earlier result.
void put_in_place(const fs::path& folder, Moves& moves) {
  const fs::path complete = folder / complete_name, placing = folder / placing_name;
  if (stands(complete / replaced_name)) {
    for (const std::string& name : names_in(complete / replaced_name)) {
      const fs::path before = folder / name;
      std::error_code unknown;
      if (is_name_in(folder, name) && fs::is_regular_file(fs::symlink_status(before, unknown)))
        moves.move(before, complete / earlier_name / name);
    }
    moves.move(complete, placing);
  }
  if (!stands(placing / replaced_name)) return;
  for (const fs::path& name : new_files_in(placing)) {
    const fs::path place = folder / name;
    if (stands(place)) make_way(place, moves);
    moves.move(placing / name, place);
  }
  for (const std::string& name : names_in(placing / replaced_name)) {
    if (!is_name_in(folder, name)) continue;
    std::error_code ignored;  // where something is left in it
    for (fs::path below = fs::path(name).parent_path(); !below.empty(); below = below.parent_path())
      if (fs::is_directory(folder / below, ignored)) fs::remove(folder / below, ignored);
  }
}

/// What a process left that was killed: no folder of ours that another one is at work with.
void finish_in_turn(const fs::path& folder) {
  for (const char* name : {complete_name, placing_name}) {
    if (!stands(folder / name / replaced_name)) continue;  // it is none of ours
    const int lock = locked(folder / name), why = errno;
    if (lock < 0 && !is_left(folder / name, why)) return;  // it is being done
    Moves moves;
    std::error_code ignored;
    try {
      put_in_place(folder, moves);
    } catch (const Error& error) {
      moves.take_back();
      ::close(lock);
      fail("holds a result that a run was killed over, and that cannot be put into its place",
           fmt::format("{}; make the folder writable and try again", error.what()), folder);
    }
    // Under a name of its own, that whoever is killed over this blocks nobody.
    fs::path done = new_staging(folder);
    fs::rename(folder / placing_name, done, ignored);
    fs::remove_all(done, ignored);
    ::close(lock);
  }
}

/// By one of ours.
bool is_begun(const fs::path& folder) {
  return stands(folder / complete_name / replaced_name) || stands(folder / placing_name / replaced_name);
}

bool is_busy(const fs::path& folder) {
  return stands(folder / complete_name) || stands(folder / placing_name);
}

[[noreturn]] void fail_busy(const fs::path& folder) {
  fail("cannot be written to",
       fmt::format("another run puts its files there; if none does, remove {} and {}", complete_name,
                   placing_name),
       folder);
}

}  // namespace

// Delegating: once the first constructor is through, the destructor tidies up whatever the body throws.
StagedFolder::StagedFolder(fs::path folder) : StagedFolder(std::move(folder), NothingMadeYet{}) {
  constexpr int most_tries = 5;
  for (int k = 1;; ++k) {
    make_folders();
    const Turn turn(folder_);
    if (!turn.came()) fail_busy(folder_);
    finish_in_turn(folder_);
    remove_abandoned(folder_);
    if (stage()) return;
    // Another process that had made the folder too, and failed, may have taken it away.
    if (errno != ENOENT || k == most_tries) fail("cannot write here", std::strerror(errno), folder_);
  }
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
  if (lock_ >= 0) ::close(lock_);
  if (published_) return;
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) fs::remove(*made, ignored);  // only if empty
}

void StagedFolder::make_folders() {
  std::vector<fs::path> missing;
  std::error_code problem;
  for (fs::path path = fs::absolute(folder_).lexically_normal(); !fs::exists(path, problem) && !problem;
       path = path.parent_path()) {
    if (fs::is_symlink(path)) fail("the folder cannot be reached", "a link that leads nowhere", path);
    missing.push_back(path);
  }
  for (auto path = missing.rbegin(); path != missing.rend(); ++path) {
    if (fs::create_directory(*path, problem)) made_.push_back(*path);
    if (problem) fail("the folder cannot be made", problem.message(), *path);
  }
  if (problem) fail("the folder cannot be reached", problem.message(), folder_);
  if (!fs::is_directory(folder_, problem))
    fail("is not a folder", "files are to be written into it", folder_);
}

bool StagedFolder::stage() {
  staging_ = new_staging(folder_);
  if (staging_.empty()) return false;
  lock_ = locked(staging_);
  return true;
}

fs::path StagedFolder::add(const std::string& name) {
  names_.push_back(name);
  const fs::path there = staging_ / name;
  std::error_code problem;
  fs::create_directories(there.parent_path(), problem);
  if (problem) fail("cannot write here", problem.message(), folder_);
  return there;
}

void StagedFolder::require_room(std::uint64_t bytes) const {
  std::error_code unknown;
  const fs::space_info space = fs::space(staging_, unknown);
  if (unknown || space.available >= bytes) return;
  fail("has too little room",
       fmt::format("{:.3g} GB are to be written, and {:.3g} GB are free", static_cast<double>(bytes) / 1e9,
                   static_cast<double>(space.available) / 1e9),
       folder_);
}

void StagedFolder::write(const std::string& name, std::string_view text) {
  OutputFile file(add(name));
  file.append(text);
  file.close();
}

std::vector<fs::path> StagedFolder::publish(const std::vector<std::string>& replaced) {
  std::vector<fs::path> files;
  for (const std::string& name : names_) {
    files.push_back(folder_ / name);
    std::error_code unknown;
    if (fs::is_directory(fs::symlink_status(files.back(), unknown)))
      fail("cannot be replaced", "a folder of that name stands there", files.back());
  }
  std::error_code problem;
  fs::create_directory(staging_ / earlier_name, problem);
  if (problem) fail("cannot write here", problem.message(), staging_);
  OutputFile list(staging_ / replaced_name, folder_);
  for (const std::string& name : replaced) list.append(line_of(name) + "\n");
  list.close();

  const Turn turn(folder_);
  if (!turn.came()) fail_busy(folder_);
  finish_in_turn(folder_);
  for (const auto end = std::chrono::steady_clock::now() + longest_wait; is_busy(folder_);) {
    if (!is_begun(folder_) || std::chrono::steady_clock::now() > end) fail_busy(folder_);
    std::this_thread::sleep_for(between_tries);  // where there are no locks
    finish_in_turn(folder_);
  }
  Moves moves;
  try {
    moves.move(staging_, folder_ / complete_name);
    put_in_place(folder_, moves);
  } catch (const Error&) {
    moves.take_back();
    throw;
  }
  published_ = true;
  // Back to its own name, that it is in nobody's way while it is removed.
  fs::rename(folder_ / placing_name, staging_, problem);
  if (problem) staging_ = folder_ / placing_name;
  return files;
}

void finish_publishing(const fs::path& folder) {
  if (!is_begun(folder) && stagings_in(folder).empty()) return;
  const Turn turn(folder);
  if (!turn.came()) return;
  finish_in_turn(folder);
  remove_abandoned(folder);
}

}  // namespace bernal
