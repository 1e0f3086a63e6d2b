#include "engine/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "bernal/engine/engine_error.hpp"

extern char** environ;

namespace bernal::engine {
namespace {

using namespace std::chrono_literals;

constexpr auto between_looks = 50ms;
/// For an engine that is asked to end, to do so.
constexpr auto patience = 5s;

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> all;
  for (std::string& word : words) all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

std::vector<std::string> environment_with(const std::vector<std::string>& more) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry; ++entry) all.emplace_back(*entry);
  for (const std::string& entry : more) {
    const std::string name = entry.substr(0, entry.find('=') + 1);
    bool is_set = false;
    for (const std::string& other : all) is_set = is_set || other.starts_with(name);
    if (!is_set) all.push_back(entry);
  }
  return all;
}

/// Ends with an errno in the pipe where the program cannot be started. Between fork and exec only what is
/// safe in a process of several threads.
[[noreturn]] void become(char* const* words, char* const* environment, const char* folder, int output,
                         int report) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  for (const int number : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM, SIGHUP, SIGQUIT}) signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0 && output >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(output, STDOUT_FILENO) >= 0 &&
      dup2(output, STDERR_FILENO) >= 0 && chdir(folder) == 0)
    execve(words[0], words, environment);
  const int why = errno;
  [[maybe_unused]] const ssize_t written = write(report, &why, sizeof why);
  _exit(127);
}

/// A descriptor that closes with its scope.
struct Open {
  int number;
  explicit Open(int n) : number(n) {}
  ~Open() { close(); }
  Open(const Open&) = delete;
  Open& operator=(const Open&) = delete;
  void close() {
    if (number >= 0) ::close(number);
    number = -1;
  }
};

bool has_ended(pid_t child, int& status, rusage& used) {
  const pid_t ended = wait4(child, &status, WNOHANG, &used);
  return ended == child || (ended < 0 && errno != EINTR);
}

/// The group first, whose leader passes the signal on to ranks in groups of their own.
void end_group(pid_t child) {
  int status = 0;
  rusage used{};
  kill(-child, SIGTERM);
  for (const auto end = std::chrono::steady_clock::now() + patience;
       std::chrono::steady_clock::now() < end;) {
    if (has_ended(child, status, used)) {
      kill(-child, SIGKILL);  // what its leader left
      return;
    }
    std::this_thread::sleep_for(between_looks);
  }
  kill(-child, SIGKILL);
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
}

[[noreturn]] void refuse_start(const std::string& program, int why) {
  throw EngineError(
      fmt::format("\"{}\" cannot be started: {}; \"executable\" and \"command\" in [engine] say what is",
                  program, strerror(why)));
}

}  // namespace

ChildEnd run_child(const ChildCall& call, const std::function<void()>& look) {
  std::vector<std::string> words = call.words, environment = environment_with(call.environment);
  const std::vector<char*> argv = pointers(words), envp = pointers(environment);
  const std::string folder = call.folder.string();
  Open output(open(call.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (output.number < 0)
    throw Error(ErrorCode::cannot_write, fmt::format("cannot be written: {}", strerror(errno)),
                {call.output.string()});
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) refuse_start(words[0], errno);
  Open here(ends[0]), there(ends[1]);
  const pid_t child = fork();
  if (child < 0) refuse_start(words[0], errno);
  if (child == 0) become(argv.data(), envp.data(), folder.c_str(), output.number, there.number);
  setpgid(child, child);  // whichever of both is first
  there.close();
  int why = 0;
  ssize_t got = 0;
  while ((got = read(here.number, &why, sizeof why)) < 0 && errno == EINTR) continue;
  int status = 0;
  rusage used{};
  if (got == sizeof why) {
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    refuse_start(words[0], why);
  }
  try {
    while (!has_ended(child, status, used)) {
      look();
      std::this_thread::sleep_for(between_looks);
    }
  } catch (...) {
    end_group(child);
    throw;
  }
  ChildEnd end;
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (WIFEXITED(status)) end.code = WEXITSTATUS(status);
  end.peak_bytes = 1024.0 * static_cast<double>(used.ru_maxrss);
  return end;
}

}  // namespace bernal::engine
