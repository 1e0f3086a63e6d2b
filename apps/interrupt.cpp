#include "interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

namespace {

std::atomic<bool> signalled = false;
std::atomic<bool> silent = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch nothing else");

extern "C" void on_signal(int) {
  signalled = true;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  constexpr std::string_view message = "\nbernal: stopping at the next safe point; once more kills\n";
  if (!silent) [[maybe_unused]]
    const auto written = write(STDERR_FILENO, message.data(), message.size());
}

}  // namespace

void watch_for_interrupts(bool quiet) {
  silent = quiet;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() { return signalled; }
