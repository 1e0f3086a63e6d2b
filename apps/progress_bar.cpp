#include "progress_bar.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "say.hpp"

namespace {

constexpr double silence = 2, between_redraws = 0.1, between_lines = 10;  ///< seconds
constexpr std::chrono::milliseconds between_ticks(100);

/// Signals this soon after the first one count as the same one: `timeout` sends a signal to the command and
/// to its group, and a queue to a step and to each of its processes.
constexpr double at_once = 0.5;  ///< seconds

std::atomic<bool> signalled = false;
std::atomic<double> first_signal = 0;  // by the clock below
std::atomic<bool> no_message = false;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<double>::is_always_lock_free,
              "a signal handler may touch nothing else");

double monotonic_seconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

extern "C" void on_signal(int number) {
  if (signalled) {
    if (monotonic_seconds() < first_signal + at_once) return;
    std::signal(number, SIG_DFL);
    raise(number);  // kills as soon as this returns
    return;
  }
  first_signal = monotonic_seconds();
  signalled = true;
  constexpr std::string_view message = "\nbernal: stopping at the next safe point; once more kills\n";
  if (!no_message) [[maybe_unused]]
    const auto written = write(STDERR_FILENO, message.data(), message.size());
}

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string bar(double fraction) {
  constexpr int width = 24;
  const int done = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * width);
  return fmt::format("[{:#<{}}{:.<{}}] {:3.0f} %", "", done, "", width - done, 100 * fraction);
}

}  // namespace

bool interrupted() { return signalled; }

ProgressBar::ProgressBar(bool quiet, bool silent)
    : quiet_(quiet),
      silent_(silent),
      terminal_(isatty(STDERR_FILENO) == 1),
      next_(terminal_ ? silence : between_lines) {
  if (!quiet) ticker_ = std::thread([this] { tick(); });
}

ProgressBar::~ProgressBar() {
  clear();
  if (!ticker_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  end_.notify_one();
  ticker_.join();
}

bernal::Monitor ProgressBar::monitor(double from, double to) {
  no_message = silent_;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
  return {[=, this](bernal::Progress progress) {
            progress.fraction = from + (to - from) * progress.fraction;
            take(progress);
          },
          interrupted};
}

void ProgressBar::now(std::string_view activity) { take({activity, -1, {}}); }

void ProgressBar::take(const bernal::Progress& progress) {
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  activity_ = progress.activity;
  detail_ = progress.detail;
  fraction_ = progress.fraction;
  draw();
}

void ProgressBar::tick() {
  std::unique_lock lock(mutex_);
  while (!end_.wait_for(lock, between_ticks, [this] { return over_; })) draw();
}

void ProgressBar::draw() {
  const double now = watch_.seconds();
  if (now < next_ || activity_.empty()) return;
  next_ = now + (terminal_ ? between_redraws : between_lines);

  std::string line = fmt::format("{:>5.0f} s  {:<8}  ", std::floor(now), activity_);
  if (fraction_ >= 0) line += bar(fraction_) + "  ";
  line += detail_;
  if (!terminal_) {
    say(stderr, "{}\n", line);
    return;
  }
  line.resize(std::min(line.size(), terminal_width() - 1));
  say(stderr, "\r\x1b[K{}", line);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  const std::lock_guard lock(mutex_);
  activity_.clear();
  if (!drawn_) return;
  say(stderr, "\r\x1b[K");
  drawn_ = false;
}
