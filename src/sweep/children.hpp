#pragma once
#include <sys/types.h>

#include <cstddef>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"

namespace bernal::sweep {

/// Processes that work side by side, whatever becomes of each; what they say on standard error is kept. Those
/// that are there when this ends are killed.
class Children {
 public:
  Children() = default;
  ~Children();
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  /// Program and arguments, without a shell. False where the system has no room for another process; throws
  /// Error{bad_argument} where the program cannot be run.
  bool start(std::size_t of, const std::vector<std::string>& words);
  std::size_t size() const { return children_.size(); }

  struct Ended {
    std::size_t of = 0;  ///< what it was started with
    int signal = 0;      ///< that ended it; 0: none
    int exit_code = 0;
    std::string last_line;  ///< that it said
    double seconds = 0;
  };
  /// Those that have ended since.
  std::vector<Ended> ended();
  void tell_to_stop();
  /// Those that have run for longer than so many seconds.
  void kill_after(double seconds);

 private:
  struct Child {
    std::size_t of;
    pid_t pid;
    int said;  ///< descriptor of a file in memory
    Stopwatch watch = {};
  };
  std::vector<Child> children_;
};

}  // namespace bernal::sweep
