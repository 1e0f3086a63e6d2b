#pragma once
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/folder.hpp"

namespace bernal::testing {

/// How a process ended and what it said.
struct Ended {
  int status = -1;  ///< exit code; 128 + signal where one killed it
  std::string out;
  std::string err;
};

/// A process with its outputs kept in files, so that no pipe can fill up and block it.
class Process {
 public:
  /// `input` is the file that it reads as its standard input.
  explicit Process(const std::vector<std::string>& words, const std::string& input = "/dev/null") {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, input.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out().c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err().c_str(), O_WRONLY | O_CREAT, 0600);
    const int failed = posix_spawnp(&pid_, argv[0], &files, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (failed != 0) throw std::runtime_error("cannot start " + words.front());
  }

  /// Its standard error so far.
  std::string said() const { return text_of(err()); }

  void signal(int number) const { kill(pid_, number); }
  pid_t pid() const { return pid_; }

  /// Waits until it has a handler of its own for a signal; false where it ends before.
  bool listens_to(int number) const {
    for (;;) {
      std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
      for (std::string line; std::getline(status, line);) {
        if (line.starts_with("State:\tZ")) return false;
        if (line.starts_with("SigCgt:") &&
            (std::stoull(line.substr(7), nullptr, 16) >> (number - 1) & 1) != 0)
          return true;
      }
      usleep(1000);
    }
  }

  Ended wait() const {
    int status = 0;
    waitpid(pid_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(out()), text_of(err())};
  }

 private:
  std::string out() const { return (folder_.path() / "out").string(); }
  std::string err() const { return (folder_.path() / "err").string(); }

  Folder folder_;
  pid_t pid_ = -1;
};

/// The built command with these words after its name.
inline Process start_bernal(std::vector<std::string> words, const std::string& input = "/dev/null") {
  words.insert(words.begin(), BERNAL_COMMAND);
  return Process(words, input);
}
inline Ended bernal(std::vector<std::string> words, const std::string& input = "/dev/null") {
  return start_bernal(std::move(words), input).wait();
}

}  // namespace bernal::testing
