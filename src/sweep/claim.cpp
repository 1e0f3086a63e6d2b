#include "sweep/claim.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>
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

/// Whether the lock is had; who only asks whether a claim is held lets go within microseconds.
bool lock(int descriptor) {
  constexpr int most_tries = 10;
  for (int k = 0; k < most_tries; ++k) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || (errno != EWOULDBLOCK && errno != EINTR)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace

Claim::Claim(fs::path file) : file_(std::move(file)) {
  constexpr int most_tries = 100;
  for (int k = 0; k < most_tries; ++k) {
    std::error_code problem;
    fs::create_directories(file_.parent_path(), problem);
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    const bool may_be_made = problem != std::errc::permission_denied;
    if (descriptor_ < 0 && errno == ENOENT && may_be_made) continue;  // the last has just removed the folder
    if (descriptor_ < 0) {  // a folder that cannot be written to is refused where the result is written
      ours_ = true;
      return;
    }
    if (!lock(descriptor_)) return;
    if (stands_as(descriptor_, file_)) {
      ours_ = true;
      return;
    }
    ::close(std::exchange(descriptor_, -1));
  }
}

Claim::~Claim() {
  if (descriptor_ < 0) return;
  std::error_code ignored;
  if (ours_) {
    fs::remove(file_, ignored);
    fs::remove(file_.parent_path(), ignored);  // where it was the last one
  }
  ::close(descriptor_);
}

bool is_claimed(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) return false;
  // A shared lock, that two who ask do not take each other for somebody at work.
  const bool free = ::flock(descriptor, LOCK_SH | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  ::close(descriptor);
  return !free;
}

void remove_abandoned(const fs::path& file) {
  std::error_code unknown;
  const auto kind_of = [&](const fs::path& path) { return fs::symlink_status(path, unknown).type(); };
  if (kind_of(file.parent_path()) == fs::file_type::directory && kind_of(file) == fs::file_type::regular)
    const Claim had_and_let_go(file);
}

}  // namespace bernal::sweep
