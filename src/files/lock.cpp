#include "files/lock.hpp"

#include <sys/file.h>

#include <thread>

namespace bernal {

Lock::Lock(Descriptor of, std::chrono::milliseconds patience) : of_(std::move(of)), why_not_(errno) {
  constexpr std::chrono::milliseconds between_tries(1);
  using Clock = std::chrono::steady_clock;
  for (const auto end = Clock::now() + patience; of_.is_open();) {
    why_not_ = ::flock(of_.number(), LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    if (!is_elsewhere() && why_not_ != EINTR) return;
    if (Clock::now() > end) return;
    std::this_thread::sleep_for(between_tries);
  }
}

bool is_locked(const Descriptor& file) {
  // A shared lock, that two who ask do not take each other for somebody at work.
  return file.is_open() && ::flock(file.number(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace bernal
