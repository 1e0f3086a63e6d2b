#include "io/staged_folder.hpp"

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "bernal/core/error.hpp"
#include "io/output_file.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& why, const fs::path& path) {
  throw Error(ErrorCode::cannot_write, what + ": " + why, {path.string()});
}

}  // namespace

// Delegating: once the first constructor is through, the destructor tidies up whatever the body throws.
StagedFolder::StagedFolder(fs::path folder) : StagedFolder(std::move(folder), NothingMadeYet{}) {
  make_folders();
  std::string pattern = (folder_ / ".bernal-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) fail("cannot write here", std::strerror(errno), folder_);
  staging_ = pattern;
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

fs::path StagedFolder::add(const std::string& name) {
  names_.push_back(name);
  return staging_ / name;
}

void StagedFolder::write(const std::string& name, std::string_view text) {
  OutputFile file(add(name));
  file.append(text);
  file.close();
}

std::vector<fs::path> StagedFolder::publish() {
  std::vector<fs::path> files;
  for (const std::string& name : names_) {
    std::error_code problem, ignored;
    const fs::path file = folder_ / name;
    fs::create_hard_link(file, earlier(name), ignored);  // none where there is no earlier file
    fs::rename(staging_ / name, file, problem);
    if (problem) {
      take_back(files);
      fail("cannot be replaced", problem.message(), file);
    }
    files.push_back(file);
  }
  published_ = true;
  return files;
}

void StagedFolder::take_back(const std::vector<fs::path>& files) const {
  for (const fs::path& file : files) {
    std::error_code ignored;
    const fs::path before = earlier(file.filename().string());
    if (fs::exists(before, ignored)) {
      fs::rename(before, file, ignored);
    } else {
      fs::remove(file, ignored);
    }
  }
}

fs::path StagedFolder::earlier(const std::string& name) const { return staging_ / (name + ".earlier"); }

}  // namespace bernal
