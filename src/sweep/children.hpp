#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "files/descriptor.hpp"
#include "process/child.hpp"

namespace bernal::sweep {

/// Processes that work side by side, whatever becomes of each; what they say on standard error is kept. Those
/// that are there when this ends are killed.
class Children {
 public:
  /// Program and arguments, without a shell. False where the system has no room for another process; throws
  /// Error{bad_argument} where the program cannot be run.
  bool start(std::size_t of, const std::vector<std::string>& words);
  std::size_t size() const { return running_.size(); }

  struct Ended : ChildEnd {
    std::size_t of = 0;     ///< what it was started with
    std::string last_line;  ///< that it said
  };
  /// Those that have ended since.
  std::vector<Ended> ended();
  void tell_to_stop();
  /// Those that have run for longer than so many seconds.
  void kill_after(double seconds);

 private:
  struct Running {
    std::size_t of;
    Child child;
    Descriptor said;  ///< a file in memory
    Stopwatch watch = {};
  };
  std::vector<Running> running_;
};

}  // namespace bernal::sweep
