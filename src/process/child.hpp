#pragma once
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bernal {

struct ChildEnd {
  int code = 0;           ///< that it exited with
  int signal = 0;         ///< that ended it; 0: none did
  double peak_bytes = 0;  ///< of the largest process among it and its descendants that were waited for
};

/// A child process, which is killed where it has not ended before this does.
class Child {
 public:
  /// By the number that fork() returned. One that is `apart` leads a process group, which hears its signals.
  explicit Child(pid_t number, bool apart = false) : number_(number), apart_(apart) {}
  Child(Child&& other) noexcept : number_(std::exchange(other.number_, 0)), apart_(other.apart_) {}
  Child& operator=(Child&& other) noexcept;
  ~Child();

  /// Nothing while it is at work. Once only: then there is no child any more.
  std::optional<ChildEnd> ended() { return reaped(false); }
  ChildEnd wait() { return *reaped(true); }
  void signal(int signal) const;
  /// Asks it to end, and kills it, or the group that it leaves, after `patience` at the latest.
  void stop(std::chrono::seconds patience);

 private:
  std::optional<ChildEnd> reaped(bool waits);
  pid_t number_;  ///< 0: none
  bool apart_;
};

/// A program that is started without a shell. Its standard input is empty.
struct ChildCall {
  std::vector<std::string> words;             ///< the program, found already, and its arguments
  std::vector<std::string> environment = {};  ///< "NAME=value" that this process does not set otherwise
  std::filesystem::path folder = {};          ///< it works there
  int output = -1, errors = -1;               ///< descriptors of the files that take what it prints
  /// In a process group of its own, so that Ctrl-C in a terminal is heard by this process alone; then it gets
  /// SIGTERM when this process dies, and no signal is ignored or blocked.
  bool apart = false;
};

/// Throws std::system_error where it cannot be started.
Child start(const ChildCall& call);

}  // namespace bernal
