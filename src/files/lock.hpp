#pragma once
#include <cerrno>
#include <chrono>

#include "files/descriptor.hpp"

namespace bernal {

/// A lock of an open file or folder, which the system lets go of however the process ends.
class Lock {
 public:
  Lock() = default;
  /// Tries for so long. What is not open is not locked.
  explicit Lock(Descriptor of, std::chrono::milliseconds patience = {});

  bool is_held() const { return why_not_ == 0; }
  /// Whether another one holds it. If neither, it cannot be opened, or file systems know no locks.
  bool is_elsewhere() const { return why_not_ == EWOULDBLOCK; }
  int why_not() const { return why_not_; }  ///< an errno
  const Descriptor& of() const { return of_; }

 private:
  Descriptor of_;
  int why_not_ = EBADF;
};

/// Whether somebody holds a lock of it; who only asks is in nobody's way.
bool is_locked(const Descriptor&);

}  // namespace bernal
