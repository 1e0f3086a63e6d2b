#include "cad/cage.hpp"

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
#include <span>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BERNAL_SHADOW_MEMORY 1  // terabytes of addresses, which no limit leaves room for
#endif

namespace bernal::cad {
namespace {

constexpr double gibi = 1024.0 * 1024 * 1024;
/// Of wall time for one of processor time, where the machine has more to do.
constexpr double slower = 20;
/// Between looks at whether the user wants to stop.
constexpr int look_every_ms = 50;
/// Stands at the end of what is whole.
constexpr std::uint64_t end_mark = 0x6265726E616C2121;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

/// Plain values and arrays of them, one after the other, into a file in memory and out of it.
class SoupWriter {
 public:
  explicit SoupWriter(int file) : file_(file) {}

  template <class T>
  void array(std::span<const T> values) {
    number(values.size());
    bytes(values.data(), values.size_bytes());
  }
  void number(std::uint64_t n) { bytes(&n, sizeof n); }
  void real(double x) { bytes(&x, sizeof x); }
  void text(std::string_view words) { array(std::span(words.data(), words.size())); }

 private:
  void bytes(const void* from, std::size_t size) {
    const char* at = static_cast<const char*>(from);
    while (size > 0) {
      const ssize_t written = ::write(file_, at, size);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) throw std::bad_alloc();
      at += written;
      size -= static_cast<std::size_t>(written);
    }
  }

  int file_;
};

class SoupReader {
 public:
  explicit SoupReader(int file) : file_(file), left_(static_cast<std::uint64_t>(lseek(file, 0, SEEK_END))) {
    lseek(file, 0, SEEK_SET);
  }

  template <class Array>
  Array array() {
    Array values;
    const std::uint64_t size = number();
    if (size > left_ / sizeof(typename Array::value_type)) throw Cut();
    values.resize(size);
    bytes(values.data(), size * sizeof(typename Array::value_type));
    return values;
  }
  std::uint64_t number() {
    std::uint64_t n = 0;
    bytes(&n, sizeof n);
    return n;
  }
  double real() {
    double x = 0;
    bytes(&x, sizeof x);
    return x;
  }
  std::string text() { return array<std::string>(); }

  /// What was written is not whole.
  struct Cut {};

 private:
  void bytes(void* to, std::size_t size) {
    char* at = static_cast<char*>(to);
    while (size > 0) {
      const ssize_t got = ::read(file_, at, size);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) throw Cut();
      at += got;
      size -= static_cast<std::size_t>(got);
      left_ -= static_cast<std::uint64_t>(got);
    }
  }

  int file_;
  std::uint64_t left_;
};

void put(SoupWriter& out, const std::optional<FileFacts::Length>& length) {
  out.real(length ? length->metres : 0);
  out.text(length ? length->name : "");
}
std::optional<FileFacts::Length> read_length(SoupReader& in) {
  const double metres = in.real();
  std::string name = in.text();
  if (metres == 0) return {};
  return FileFacts::Length{metres, std::move(name)};
}

void put(SoupWriter& out, const ReadAttempt& attempt) {
  out.text(attempt.failure);
  const PolygonSoup& soup = attempt.soup;
  static_assert(sizeof(Vector<3>) == 3 * sizeof(double));
  out.array(std::span(soup.points));
  std::vector<std::uint32_t> corners, indices;
  for (const auto& polygon : soup.polygons) {
    corners.push_back(static_cast<std::uint32_t>(polygon.size()));
    indices.insert(indices.end(), polygon.begin(), polygon.end());
  }
  out.array(std::span<const std::uint32_t>(corners));
  out.array(std::span<const std::uint32_t>(indices));
  out.number(soup.solids.size());
  for (const Solid& solid : soup.solids) {
    out.text(solid.name);
    out.number(solid.first);
  }
  const FileFacts& facts = attempt.facts;
  put(out, facts.unit);
  put(out, facts.written_in);
  out.number(static_cast<unsigned char>(facts.up));
  out.number(facts.deviation.has_value());
  out.real(facts.deviation ? facts.deviation->outside : 0);
  out.real(facts.deviation ? facts.deviation->inside : 0);
  out.number(facts.deflection.has_value());
  out.real(facts.deflection.value_or(0));
  out.number(facts.notes.size());
  for (const std::string& note : facts.notes) out.text(note);
  out.number(end_mark);
}

ReadAttempt read_attempt(SoupReader& in) {
  ReadAttempt attempt;
  attempt.failure = in.text();
  PolygonSoup& soup = attempt.soup;
  soup.points = in.array<std::vector<Vector<3>>>();
  const auto corners = in.array<std::vector<std::uint32_t>>();
  const auto indices = in.array<std::vector<std::uint32_t>>();
  soup.polygons.reserve(corners.size());
  auto at = indices.begin();
  for (const std::uint32_t count : corners) {
    if (indices.end() - at < static_cast<std::ptrdiff_t>(count)) throw SoupReader::Cut();
    soup.polygons.emplace_back(at, at + count);
    at += count;
  }
  for (std::uint64_t left = in.number(); left > 0; --left) {
    std::string name = in.text();
    soup.solids.push_back({std::move(name), in.number()});
  }
  FileFacts& facts = attempt.facts;
  facts.unit = read_length(in);
  facts.written_in = read_length(in);
  facts.up = static_cast<char>(in.number());
  const bool has_deviation = in.number() != 0;
  const double outside = in.real(), inside = in.real();
  if (has_deviation) facts.deviation = SurfaceDeviation{outside, inside};
  const bool has_deflection = in.number() != 0;
  const double deflection = in.real();
  if (has_deflection) facts.deflection = deflection;
  for (std::uint64_t left = in.number(); left > 0; --left) facts.notes.push_back(in.text());
  if (in.number() != end_mark) throw SoupReader::Cut();
  return attempt;
}

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

std::string memory_taken(std::string_view reader, const CageLimits& limits) {
  return fmt::format("{} wants more than {:.3g} GiB of memory for it", reader,
                     static_cast<double>(limits.memory) / gibi);
}

/// What the child does.
[[noreturn]] void read_as_child(std::string_view reader, const CageLimits& limits, int result,
                                std::uint64_t addresses, const std::function<ReadAttempt()>& read) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGXFSZ, SIGTERM, SIGPIPE})
    ::signal(signal, SIG_DFL);
  ::signal(SIGINT, SIG_IGN);  // the parent hears it and ends the child
  const int nothing = open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, standard);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, std::ceil(limits.seconds));
  set_limit(RLIMIT_FSIZE, static_cast<double>(limits.memory));
#ifndef BERNAL_SHADOW_MEMORY
  set_limit(RLIMIT_AS, static_cast<double>(addresses + limits.memory));
#else
  static_cast<void>(addresses);
#endif
  int code = 0;
  try {
    ReadAttempt attempt;
    try {
      attempt = read();
      if (attempt.failure.find("bad_alloc") != std::string::npos)
        attempt = {{}, memory_taken(reader, limits), {}};
    } catch (const std::bad_alloc&) {
      attempt = {{}, memory_taken(reader, limits), {}};
    } catch (const std::exception& error) {
      attempt = {{}, error.what(), {}};
    }
    SoupWriter out(result);
    put(out, attempt);
  } catch (...) {
    code = 1;
  }
  _exit(code);
}

std::string what_befell(std::string_view reader, const CageLimits& limits, int status) {
  const auto too_long = [&] {
    return fmt::format("{} takes longer than {:.0f} s over it", reader, limits.seconds);
  };
  if (!WIFSIGNALED(status)) return memory_taken(reader, limits);
  if (WTERMSIG(status) == SIGXCPU) return too_long();
  if (WTERMSIG(status) == SIGXFSZ) return memory_taken(reader, limits);
  if (WTERMSIG(status) == SIGKILL) return fmt::format("{} was killed over it", reader);
  return fmt::format("{} crashes on it ({})", reader, strsignal(WTERMSIG(status)));
}

int status_at_end_of(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return status;
}

}  // namespace

CageLimits cage_limits(std::uint64_t file_size) {
  const auto size = static_cast<double>(file_size);
  return {static_cast<std::uint64_t>(gibi + 100 * size), 5 + size / 1e6};
}

ReadAttempt read_in_cage(std::string_view reader, const CageLimits& limits,
                         const std::function<ReadAttempt()>& read) {
  const auto refuse = [&](std::string_view what) {
    throw Error(ErrorCode::bad_mesh,
                fmt::format("no process for {}: {} ({})", reader, what, strerror(errno)));
  };
  Descriptor result(memfd_create("bernal", MFD_CLOEXEC));
  int ends[2];
  if (result.number() < 0) refuse("no file in memory");
  if (pipe2(ends, O_CLOEXEC) != 0) refuse("no pipe");
  Descriptor here(ends[0]), there(ends[1]);
  const std::uint64_t addresses = addresses_in_use();
  const pid_t child = fork();
  if (child < 0) refuse("fork failed");
  if (child == 0) read_as_child(reader, limits, result.number(), addresses, read);
  there.close();

  // The pipe closes when the child ends.
  using Clock = std::chrono::steady_clock;
  const auto latest = Clock::now() + std::chrono::duration<double>(slower * limits.seconds);
  pollfd end{here.number(), POLLIN, 0};
  bool late = false;
  try {
    for (int ready = 0; ready == 0 && !late;) {
      ready = poll(&end, 1, look_every_ms);
      if (ready < 0 && errno == EINTR) ready = 0;
      throw_if_interrupted();
      late = ready == 0 && Clock::now() > latest;
    }
  } catch (...) {
    kill(child, SIGKILL);
    status_at_end_of(child);
    throw;
  }
  if (late) kill(child, SIGKILL);
  const int status = status_at_end_of(child);
  if (late)
    return {{}, fmt::format("{} takes longer than {:.0f} s over it", reader, slower * limits.seconds), {}};
  try {
    SoupReader in(result.number());
    return read_attempt(in);
  } catch (const SoupReader::Cut&) {
    return {{}, what_befell(reader, limits, status), {}};
  }
}

}  // namespace bernal::cad
