#pragma once
#include <filesystem>

#include "files/lock.hpp"

namespace bernal::sweep {

/// That this process alone works at something, as long as it lives: a lock of a file, which the system lets
/// go of however the process ends. Where file systems know no locks everybody has it.
class Claim {
 public:
  /// The folder of the file is made.
  explicit Claim(std::filesystem::path file);
  ~Claim();

  bool is_ours() const { return ours_; }

 private:
  std::filesystem::path file_;
  Lock lock_;
  bool ours_ = false;
};

/// Whether another process has it; nothing is made.
bool is_claimed(const std::filesystem::path& file);

/// Removes the file of a claim that a process which was killed has left; nothing else that has this name.
void remove_abandoned(const std::filesystem::path& file);

}  // namespace bernal::sweep
