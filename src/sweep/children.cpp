#include "sweep/children.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

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

bool Children::start(std::size_t of, const std::vector<std::string>& words) {
  Descriptor said(::memfd_create("bernal-said", MFD_CLOEXEC));
  if (!said.is_open()) return false;
  try {
    Child child = bernal::start({.words = words, .errors = said.number()});
    running_.push_back({of, std::move(child), std::move(said)});
  } catch (const std::system_error& failed) {
    const int why = failed.code().value();
    if (why == EAGAIN || why == ENOMEM || why == EMFILE) return false;
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} cannot be run: {}", words.front(), failed.code().message()));
  }
  return true;
}

std::vector<Children::Ended> Children::ended() {
  std::vector<Ended> all;
  for (auto one = running_.begin(); one != running_.end();) {
    const auto end = one->child.ended();
    if (end) all.push_back({*end, one->of, last_line_of(one->said.number())});
    one = end ? running_.erase(one) : one + 1;
  }
  return all;
}

void Children::tell_to_stop() {
  for (const Running& one : running_) one.child.signal(SIGTERM);
}

void Children::kill_after(double seconds) {
  for (const Running& one : running_)
    if (one.watch.seconds() > seconds) one.child.signal(SIGKILL);
}

}  // namespace bernal::sweep
