#pragma once
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "bernal/core/monitor.hpp"

/// Shows the progress of a run on standard error: on a terminal, after the first two seconds, one line that
/// is redrawn; in files and pipes a line every ten seconds, and none before. After `monitor()` was called the
/// first SIGINT or SIGTERM only makes `interrupted()` true, so that the run can end with what it has; a
/// signal more than half a second later kills the process.
class ProgressBar {
 public:
  /// `silent`: prints nothing, also at an interrupt.
  ProgressBar(bool quiet, bool silent);
  explicit ProgressBar(bool quiet) : ProgressBar(quiet, quiet) {}
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Names what is being done now, without a fraction.
  void now(std::string_view activity);
  /// A monitor for a part of the whole work, which shows its progress and stops it at an interrupt.
  bernal::Monitor monitor(double from = 0, double to = 1);
  /// Removes the line from the terminal, before messages.
  void clear();

 private:
  void take(const bernal::Progress&);
  void tick();
  void draw();

  bool quiet_, silent_;
  bool terminal_;
  bernal::Stopwatch watch_;
  std::mutex mutex_;  // of all below
  std::condition_variable end_;
  std::string activity_, detail_;
  double fraction_ = -1;
  double next_;  ///< seconds
  bool drawn_ = false, over_ = false;
  std::thread ticker_;  // redraws when no news comes; does not run if nothing is shown
};

bool interrupted();
