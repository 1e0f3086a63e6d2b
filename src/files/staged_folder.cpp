#include "files/staged_folder.hpp"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "files/output_file.hpp"
#include "files/put_in_place.hpp"

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

bool is_busy(const FolderTree& tree) {
  const auto is_there = [&](const char* name) { return tree.kind_of(name) != FolderTree::Kind::missing; };
  return is_there(complete_name) || is_there(placing_name);
}

[[noreturn]] void fail_busy(const fs::path& folder) {
  fail_to_write("cannot be written to",
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
    const Lock turn = turn_in(folder_);
    if (turn.is_elsewhere()) fail_busy(folder_);
    const FolderTree tree(folder_);
    finish_in_turn(tree);
    if (is_busy(tree) && !is_begun(tree)) fail_busy(folder_);  // before a long run, not after it
    remove_abandoned(tree);
    if (stage()) return;
    // Another process that had made the folder too, and failed, may have taken it away.
    if (errno != ENOENT || k == most_tries) fail_to_write("cannot write here", std::strerror(errno), folder_);
  }
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
  if (published_) return;
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) fs::remove(*made, ignored);  // only if empty
}

void StagedFolder::make_folders() {
  std::vector<fs::path> missing;
  std::error_code problem;
  for (fs::path path = fs::absolute(folder_).lexically_normal(); !fs::exists(path, problem) && !problem;
       path = path.parent_path()) {
    if (fs::is_symlink(path))
      fail_to_write("the folder cannot be reached", "a link that leads nowhere", path);
    missing.push_back(path);
  }
  for (auto path = missing.rbegin(); path != missing.rend(); ++path) {
    if (fs::create_directory(*path, problem)) made_.push_back(*path);
    if (problem) fail_to_write("the folder cannot be made", problem.message(), *path);
  }
  if (problem) fail_to_write("the folder cannot be reached", problem.message(), folder_);
  if (!fs::is_directory(folder_, problem))
    fail_to_write("is not a folder", "files are to be written into it", folder_);
}

bool StagedFolder::stage() {
  staging_ = new_staging(folder_);
  if (staging_.empty()) return false;
  lock_ = Lock(FolderTree(folder_).open_folder(staging_.filename()));
  return true;
}

fs::path StagedFolder::add(const std::string& name) {
  names_.push_back(below_ + name);
  const fs::path there = staging_ / names_.back();
  std::error_code problem;
  fs::create_directories(there.parent_path(), problem);
  if (problem) fail_to_write("cannot write here", problem.message(), folder_);
  return there;
}

void StagedFolder::require_room(std::uint64_t bytes) const {
  std::error_code unknown;
  const fs::space_info space = fs::space(staging_, unknown);
  if (unknown || space.available >= bytes) return;
  fail_to_write("has too little room",
                fmt::format("{:.3g} GB are to be written, and {:.3g} GB are free",
                            static_cast<double>(bytes) / 1e9, static_cast<double>(space.available) / 1e9),
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
      fail_to_write("cannot be replaced", "a folder of that name stands there", files.back());
  }
  std::error_code problem;
  fs::create_directory(staging_ / earlier_name, problem);
  if (problem) fail_to_write("cannot write here", problem.message(), staging_);
  OutputFile list(staging_ / replaced_name, folder_);
  for (const std::string& name : replaced) list.append(line_of_replaced(name));
  list.close();

  const Lock turn = turn_in(folder_);
  if (turn.is_elsewhere()) fail_busy(folder_);
  const FolderTree tree(folder_);
  finish_in_turn(tree);
  for (const auto end = std::chrono::steady_clock::now() + longest_wait; is_busy(tree);) {
    if (!is_begun(tree) || std::chrono::steady_clock::now() > end) fail_busy(folder_);
    std::this_thread::sleep_for(between_tries);  // where there are no locks
    finish_in_turn(tree);
  }
  put_in_place(tree, staging_.filename());
  published_ = true;
  // Back to its own name, that it is in nobody's way while it is removed.
  if (tree.move(placing_name, staging_.filename())) staging_ = folder_ / placing_name;
  return files;
}

}  // namespace bernal
