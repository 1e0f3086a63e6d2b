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

namespace {

constexpr std::string_view staging_prefix = ".bernal-staging-";
/// What the staging folder is called once all is written, while what the files replace moves to
/// `earlier_name` below it; and then, while they move into their places.
constexpr const char* complete_name = ".bernal-complete";
constexpr const char* placing_name = ".bernal-placing";
constexpr const char* earlier_name = ".earlier";
/// In it, which files it replaces, a line each; nothing that lacks it is touched.
constexpr const char* replaced_name = ".replaced";

/// For another process that publishes in the same folder, which takes milliseconds.
constexpr int most_waits = 600;
constexpr std::chrono::milliseconds wait(50);

[[noreturn]] void fail(const std::string& what, const std::string& why, const fs::path& path) {
  throw Error(ErrorCode::cannot_write, what + ": " + why, {path.string()});
}

/// Of an open folder, for this process; -1 where another one holds it or file systems know no locks.
int locked(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  if (descriptor >= 0) ::close(descriptor);
  return -1;
}

/// What stands in a folder, as far as it can be told.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code problem;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end; at.increment(problem))
    entries.push_back(at->path());
  return entries;
}

/// Staging folders whose processes were killed.
void remove_abandoned(const fs::path& folder) {
  for (const fs::path& entry : entries_of(folder)) {
    const std::string name = entry.filename().string();
    if (!name.starts_with(staging_prefix)) continue;
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
  void move(const fs::path& from, const fs::path& to) {
    std::error_code problem;
    fs::rename(from, to, problem);
    if (problem) fail("cannot be replaced", problem.message(), to);
    done_.emplace_back(from, to);
  }
  void take_back() {
    std::error_code ignored;
    for (; !done_.empty(); done_.pop_back()) fs::rename(done_.back().second, done_.back().first, ignored);
  }

 private:
  std::vector<std::pair<fs::path, fs::path>> done_;
};

bool is_new(const fs::path& file) {
  return file.filename() != earlier_name && file.filename() != replaced_name;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
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
    for (const std::string& name : lines_of(complete / replaced_name)) {
      const fs::path before = folder / fs::path(name).filename();
      std::error_code unknown;
      if (stands(before) && !fs::is_directory(fs::symlink_status(before, unknown)))
        moves.move(before, complete / earlier_name / before.filename());
    }
    moves.move(complete, placing);
  }
  if (!stands(placing / replaced_name)) return;
  for (const fs::path& file : entries_of(placing)) {
    if (!is_new(file)) continue;
    const fs::path place = folder / file.filename();
    if (stands(place)) make_way(place, moves);
    moves.move(file, place);
  }
}

}  // namespace

// Delegating: once the first constructor is through, the destructor tidies up whatever the body throws.
StagedFolder::StagedFolder(fs::path folder) : StagedFolder(std::move(folder), NothingMadeYet{}) {
  make_folders();
  finish_publishing(folder_);
  remove_abandoned(folder_);
  stage();
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

void StagedFolder::stage() {
  std::string pattern = (folder_ / (std::string(staging_prefix) + "XXXXXX")).string();
  if (::mkdtemp(pattern.data()) == nullptr) fail("cannot write here", std::strerror(errno), folder_);
  staging_ = pattern;
  lock_ = locked(staging_);
}

fs::path StagedFolder::add(const std::string& name) {
  const fs::path path(name);
  const std::string first = path.begin()->string();
  if (first == name) {
    names_.push_back(name);
  } else {
    if (std::ranges::find(names_, first) == names_.end()) names_.push_back(first);
    std::error_code problem;
    fs::create_directories(staging_ / path.parent_path(), problem);
    if (problem) fail("the folder cannot be made", problem.message(), folder_ / path.parent_path());
  }
  return staging_ / path;
}

void StagedFolder::write(const std::string& name, std::string_view text) {
  OutputFile file(add(name));
  file.append(text);
  file.close();
}

std::vector<fs::path> StagedFolder::publish(const std::vector<std::string>& replaced) {
  std::vector<fs::path> files;
  for (const std::string& name : names_) {
    std::error_code unknown;
    files.push_back(folder_ / name);
    if (fs::is_directory(fs::symlink_status(files.back(), unknown)) && !fs::is_directory(staging_ / name))
      fail("cannot be replaced", "a folder of that name stands there", files.back());
  }
  std::error_code problem;
  fs::create_directory(staging_ / earlier_name, problem);
  if (problem) fail("cannot write here", problem.message(), staging_);
  OutputFile list(staging_ / replaced_name);
  for (const std::string& name : replaced) list.append(name + "\n");
  list.close();
  const auto is_busy = [&] { return stands(folder_ / complete_name) || stands(folder_ / placing_name); };
  for (int k = 0; k < most_waits; ++k) {  // for another process that publishes, or was killed over it
    finish_publishing(folder_);
    if (!is_busy()) break;
    std::this_thread::sleep_for(wait);
  }
  if (is_busy())
    fail("cannot be written to",
         fmt::format("another run puts its files there; if none does, remove {} and {}", complete_name,
                     placing_name),
         folder_);
  Moves moves;
  try {
    moves.move(staging_, folder_ / complete_name);
    put_in_place(folder_, moves);
  } catch (const Error&) {
    moves.take_back();
    throw;
  }
  staging_ = folder_ / placing_name;
  published_ = true;
  return files;
}

void finish_publishing(const fs::path& folder) {
  for (const char* name : {complete_name, placing_name}) {
    if (!stands(folder / name / replaced_name)) continue;  // it is none of ours
    const int lock = locked(folder / name);
    if (lock < 0) return;  // it is being done
    Moves moves;
    std::error_code ignored;
    try {
      put_in_place(folder, moves);
      fs::remove_all(folder / placing_name, ignored);
    } catch (const Error& error) {
      moves.take_back();
      ::close(lock);
      fail("holds a result that a run was killed over, and that cannot be put into its place",
           fmt::format("{}; make the folder writable and try again", error.what()), folder);
    }
    ::close(lock);
  }
}

}  // namespace bernal
