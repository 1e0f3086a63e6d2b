#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace bernal::engine {

struct ChildCall {
  std::vector<std::string> words;        ///< the program, found already, and its arguments
  std::vector<std::string> environment;  ///< "NAME=value" that this process does not set otherwise
  std::filesystem::path folder;          ///< it works there
  std::filesystem::path output;          ///< what it prints, on both streams, replaces this file
};

struct ChildEnd {
  int code = 0;           ///< that it exited with
  int signal = 0;         ///< that ended it; 0: none did
  double peak_bytes = 0;  ///< of the largest process among it and its descendants that were waited for
};

/// Runs a program in a process group of its own, so that Ctrl-C in a terminal is heard by this process alone,
/// and calls `look` some times a second until it has ended. What `look` throws passes through when the child
/// and its descendants have ended: by SIGTERM, and after some seconds by SIGKILL. The child gets SIGTERM when
/// this process dies. Standard input is empty. Throws EngineError where it cannot be started.
ChildEnd run_child(const ChildCall& call, const std::function<void()>& look);

}  // namespace bernal::engine
