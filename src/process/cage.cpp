#include "process/cage.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <new>
#include <utility>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "core/parallel.hpp"
#include "files/descriptor.hpp"
#include "process/child.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BERNAL_SHADOW_MEMORY 1  // terabytes of addresses, which no limit leaves room for
#define BERNAL_TIMES_AS_SLOW 4
#else
#define BERNAL_TIMES_AS_SLOW 1
#endif

namespace bernal {
namespace {

constexpr double gibi = 1024.0 * 1024 * 1024;
/// Of wall time for one of processor time, where the machine has more to do.
constexpr double slower = 20;
/// Between looks at whether the user wants to stop.
constexpr int look_every_ms = 50;
/// Of the message of an exception; a pipe holds it, though nobody reads it yet.
constexpr std::size_t most_of_message = 1000;
/// Stands at the end of what is whole.
constexpr std::uint64_t end_mark = 0x6265726E616C2121;

/// Bytes of addresses that this process has already.
std::uint64_t addresses_in_use() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void set_limit(int resource, double most) {
  rlimit bound{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &bound) != 0) return;
  const auto value = static_cast<rlim_t>(most);
  if (bound.rlim_cur != RLIM_INFINITY && bound.rlim_cur <= value) return;
  bound.rlim_cur = value;
  setrlimit(static_cast<__rlimit_resource>(resource), &bound);
}

/// Whether all of it is there.
bool read_all(int file, const std::function<void(Archive&)>& values) {
  const off_t size = lseek(file, 0, SEEK_END);
  if (size <= 0) return false;
  void* const mapped = mmap(nullptr, static_cast<std::size_t>(size), PROT_READ, MAP_PRIVATE, file, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  bool whole = false;
  try {
    ArchiveFromBytes archive({static_cast<const char*>(mapped), static_cast<std::size_t>(size)});
    values(archive);
    std::uint64_t mark = 0;
    archive(mark);
    whole = mark == end_mark;
  } catch (const Error&) {  // it breaks off
  }
  munmap(mapped, static_cast<std::size_t>(size));
  return whole;
}

enum ExitCode : int { done, out_of_memory, failed };

/// What the child does. The message of an exception goes into the pipe.
[[noreturn]] void work_as_child(const CageLimits& limits, const Descriptor& result, int pipe,
                                std::uint64_t addresses, const std::function<void()>& work,
                                const std::function<void(Archive&)>& values) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGXFSZ, SIGTERM, SIGPIPE})
    ::signal(signal, SIG_DFL);
  ::signal(SIGINT, SIG_IGN);  // the parent hears it and ends the child
  const int nothing = open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, standard);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, std::ceil(BERNAL_TIMES_AS_SLOW * limits.seconds));
  set_limit(RLIMIT_FSIZE, static_cast<double>(limits.memory));
#ifndef BERNAL_SHADOW_MEMORY
  set_limit(RLIMIT_AS, static_cast<double>(addresses + limits.memory));
#else
  static_cast<void>(addresses);
#endif
  stay_in_this_thread();
  const auto fail = [&](std::string_view message) {
    message = message.substr(0, most_of_message);
    _exit(write(pipe, message.data(), message.size()) < 0 ? out_of_memory : failed);
  };
  try {
    work();
    std::string bytes;
    ArchiveToBytes archive(bytes);
    values(archive);
    std::uint64_t mark = end_mark;
    archive(mark);
    if (!result.write(bytes)) throw std::bad_alloc();
  } catch (const std::bad_alloc&) {
    _exit(out_of_memory);
  } catch (const std::exception& error) {
    fail(error.what());
  } catch (...) {
    fail("an exception without a message");
  }
  _exit(done);
}

std::string memory_taken(std::string_view who, const CageLimits& limits) {
  return fmt::format("{} wants more than {:.3g} GiB of memory for it", who,
                     static_cast<double>(limits.memory) / gibi);
}

std::string what_befell(std::string_view who, const CageLimits& limits, const ChildEnd& end, int pipe) {
  if (end.signal == 0 && end.code == failed) {
    std::string message(most_of_message, '\0');
    message.resize(
        static_cast<std::size_t>(std::max<ssize_t>(0, read(pipe, message.data(), message.size()))));
    return message.empty() ? fmt::format("{} gives it up", who) : plain_text(message);
  }
  if (end.signal == 0 || end.signal == SIGXFSZ) return memory_taken(who, limits);
  if (end.signal == SIGXCPU) return fmt::format("{} takes longer than {:.0f} s over it", who, limits.seconds);
  if (end.signal == SIGKILL) return fmt::format("{} was killed over it", who);
  return fmt::format("{} crashes on it ({})", who, strsignal(end.signal));
}

}  // namespace

std::string run_in_cage(std::string_view who, const CageLimits& limits, const std::function<void()>& work,
                        const std::function<void(Archive&)>& values) {
  const auto refuse = [&](std::string_view what) {
    throw Error(ErrorCode::bad_mesh, fmt::format("no process for {}: {} ({})", who, what, strerror(errno)));
  };
  const Descriptor result(memfd_create("bernal", MFD_CLOEXEC));
  int ends[2];
  if (!result.is_open()) refuse("no file in memory");
  if (pipe2(ends, O_CLOEXEC) != 0) refuse("no pipe");
  const Descriptor here(ends[0]);
  Descriptor there(ends[1]);
  const std::uint64_t addresses = addresses_in_use();
  const pid_t number = fork();
  if (number < 0) refuse("fork failed");
  if (number == 0) work_as_child(limits, result, there.number(), addresses, work, values);
  Child child(number);
  there.close();

  // The pipe closes when the child ends.
  using Clock = std::chrono::steady_clock;
  const auto latest = Clock::now() + std::chrono::duration<double>(slower * limits.seconds);
  pollfd end{here.number(), POLLIN, 0};
  bool late = false;
  for (int ready = 0; ready == 0 && !late;) {
    ready = poll(&end, 1, look_every_ms);
    if (ready < 0 && errno == EINTR) ready = 0;
    throw_if_interrupted();
    late = ready == 0 && Clock::now() > latest;
  }
  if (late) child.signal(SIGKILL);
  const ChildEnd ended = child.wait();
  if (late) return fmt::format("{} takes longer than {:.0f} s over it", who, slower * limits.seconds);
  if (read_all(result.number(), values)) return {};
  return what_befell(who, limits, ended, here.number());
}

}  // namespace bernal
