#include "sweep/claim.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <chrono>
#include <utility>

namespace fs = std::filesystem;

namespace bernal::sweep {
namespace {

/// Whether the open file is still the one of that name: whoever was done before has removed it.
bool stands_as(int descriptor, const fs::path& file) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::stat(file.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

}  // namespace

Claim::Claim(fs::path file) : file_(std::move(file)) {
  constexpr std::chrono::milliseconds patience(10);  // who only asks whether it is held lets go at once
  constexpr int most_tries = 100;
  for (int k = 0; k < most_tries && !ours_; ++k) {
    std::error_code problem;
    fs::create_directories(file_.parent_path(), problem);
    Descriptor open(::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666));
    const bool may_be_made = problem != std::errc::permission_denied;
    if (!open.is_open() && errno == ENOENT && may_be_made) continue;  // the last has just removed the folder
    lock_ = Lock(std::move(open), patience);
    if (lock_.is_elsewhere()) return;
    // A folder that cannot be written to is refused where the result is written.
    ours_ = !lock_.of().is_open() || stands_as(lock_.of().number(), file_);
  }
}

Claim::~Claim() {
  if (!ours_ || !lock_.of().is_open()) return;
  std::error_code ignored;
  fs::remove(file_, ignored);
  fs::remove(file_.parent_path(), ignored);  // where it was the last one
}

bool is_claimed(const fs::path& file) {
  return is_locked(Descriptor(::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW)));
}

void remove_abandoned(const fs::path& file) {
  std::error_code unknown;
  const auto kind_of = [&](const fs::path& path) { return fs::symlink_status(path, unknown).type(); };
  if (kind_of(file.parent_path()) == fs::file_type::directory && kind_of(file) == fs::file_type::regular)
    const Claim had_and_let_go(file);
}

}  // namespace bernal::sweep
