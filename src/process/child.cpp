#include "process/child.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <thread>

#include "files/descriptor.hpp"

extern char** environ;

namespace bernal {
namespace {

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
[[noreturn]] void become(const ChildCall& call, char* const* words, char* const* environment,
                         const sigset_t& blocked, int report) {
  if (call.apart) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
  }
  for (int number = 1; number < NSIG; ++number) {
    struct sigaction now {};
    const bool is_ignored = sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
    if (call.apart || !is_ignored) signal(number, SIG_DFL);
  }
  sigprocmask(SIG_SETMASK, &blocked, nullptr);
  const int nothing = open("/dev/null", O_RDWR);
  const auto or_nothing = [&](int file) { return file < 0 ? nothing : file; };
  if (nothing >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(or_nothing(call.output), STDOUT_FILENO) >= 0 &&
      dup2(or_nothing(call.errors), STDERR_FILENO) >= 0 &&
      (call.folder.empty() || chdir(call.folder.c_str()) == 0))
    execve(words[0], words, environment);
  const int why = errno;
  [[maybe_unused]] const ssize_t written = write(report, &why, sizeof why);
  _exit(127);
}

}  // namespace

Child& Child::operator=(Child&& other) noexcept {
  std::swap(number_, other.number_);
  std::swap(apart_, other.apart_);
  return *this;
}

Child::~Child() {
  signal(SIGKILL);
  reaped(true);
}

std::optional<ChildEnd> Child::reaped(bool waits) {
  int status = 0;
  rusage used{};
  pid_t got = 0;
  while (number_ > 0 && (got = wait4(number_, &status, waits ? 0 : WNOHANG, &used)) < 0 && errno == EINTR)
    continue;
  if (got == 0 && !waits) return std::nullopt;
  number_ = 0;
  ChildEnd end;
  if (got > 0 && WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (got > 0 && WIFEXITED(status)) end.code = WEXITSTATUS(status);
  end.peak_bytes = 1024.0 * static_cast<double>(used.ru_maxrss);
  return end;
}

void Child::signal(int signal) const {
  if (number_ > 0) kill(apart_ ? -number_ : number_, signal);
}

void Child::stop(std::chrono::seconds patience) {
  constexpr std::chrono::milliseconds between_looks(50);
  if (number_ <= 0) return;
  const pid_t all = apart_ ? -number_ : number_;
  signal(SIGTERM);
  for (const auto end = std::chrono::steady_clock::now() + patience;
       std::chrono::steady_clock::now() < end && !ended();)
    std::this_thread::sleep_for(between_looks);
  if (apart_ || number_ > 0) kill(all, SIGKILL);  // what a leader left, too
  reaped(true);
}

Child start(const ChildCall& call) {
  std::vector<std::string> words = call.words, environment = environment_with(call.environment);
  const std::vector<char*> argv = pointers(words), envp = pointers(environment);
  const auto refuse = [&](int why) { throw std::system_error(why, std::generic_category(), words[0]); };
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) refuse(errno);
  const Descriptor here(ends[0]);
  Descriptor there(ends[1]);
  // No handler of this process acts in the child, and nothing is lost that comes before the program has its
  // own.
  sigset_t all, before, none;
  sigfillset(&all);
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t number = fork();
  if (number == 0) become(call, argv.data(), envp.data(), call.apart ? none : before, there.number());
  const int no_fork = errno;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (number < 0) refuse(no_fork);
  if (call.apart) setpgid(number, number);  // whichever of both is first
  Child child(number, call.apart);
  there.close();
  int why = 0;
  ssize_t got = 0;
  while ((got = read(here.number(), &why, sizeof why)) < 0 && errno == EINTR) continue;
  if (got == sizeof why) refuse(why);
  return child;
}

}  // namespace bernal
