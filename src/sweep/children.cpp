#include "sweep/children.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal::sweep {
namespace {

/// Of what stands at the end of a file.
std::string last_line_of(int file) {
  constexpr off_t most = 4096;
  const off_t size = ::lseek(file, 0, SEEK_END);
  std::string text(most, '\0');
  const ssize_t got = ::pread(file, text.data(), text.size(), size > most ? size - most : 0);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

Children::~Children() {
  for (const Child& child : children_) {
    ::kill(child.pid, SIGKILL);
    ::waitpid(child.pid, nullptr, 0);
    ::close(child.said);
  }
}

bool Children::start(std::size_t of, const std::vector<std::string>& words) {
  const int said = ::memfd_create("bernal-said", MFD_CLOEXEC);
  if (said < 0) return false;
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, said, STDERR_FILENO);
  pid_t pid = -1;
  const int failed = ::posix_spawn(&pid, words.front().c_str(), &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed == 0) {
    children_.push_back({of, pid, said});
    return true;
  }
  ::close(said);
  if (failed == EAGAIN || failed == ENOMEM) return false;
  throw Error(ErrorCode::bad_argument,
              fmt::format("{} cannot be run: {}", words.front(), std::strerror(failed)));
}

std::vector<Children::Ended> Children::ended() {
  std::vector<Ended> all;
  std::erase_if(children_, [&](const Child& child) {
    int status = 0;
    const pid_t got = ::waitpid(child.pid, &status, WNOHANG);
    if (got == 0 || (got < 0 && errno == EINTR)) return false;
    Ended& one = all.emplace_back(Ended{});
    one.of = child.of;
    one.signal = got > 0 && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    one.exit_code = got > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    one.last_line = last_line_of(child.said);
    one.seconds = child.watch.seconds();
    ::close(child.said);
    return true;
  });
  return all;
}

void Children::tell_to_stop() {
  for (const Child& child : children_) ::kill(child.pid, SIGTERM);
}

void Children::kill_after(double seconds) {
  for (const Child& child : children_)
    if (child.watch.seconds() > seconds) ::kill(child.pid, SIGKILL);
}

}  // namespace bernal::sweep
