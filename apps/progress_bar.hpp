#pragma once
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "bernal/core/monitor.hpp"

/// Shows on standard error how far a run has come, once it has taken two seconds: one line redrawn in place
/// on a terminal, else a plain line every ten seconds, whether or not there is news. As soon as somebody has
/// its monitor, the first SIGINT or SIGTERM only makes `interrupted()` true, so that a run can end with what
/// it has; one that comes more than half a second later kills.
class ProgressBar {
 public:
  /// `silent`: says nothing of an interrupt.
  ProgressBar(bool quiet, bool silent);
  explicit ProgressBar(bool quiet) : ProgressBar(quiet, quiet) {}
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// What is being done now, where nobody knows how far that is.
  void now(std::string_view activity);
  /// Shows the progress of what is such a part of all, and stops it when interrupted.
  bernal::Monitor monitor(double from = 0, double to = 1);
  /// Takes the line off the terminal, so that messages can follow.
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
  std::thread ticker_;  // draws where no news comes; only where something is to be shown
};

bool interrupted();
