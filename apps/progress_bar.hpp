#pragma once
#include <chrono>
#include <string>

#include "bernal/core/monitor.hpp"

/// Shows on standard error how far a run has come, once it has taken two seconds: one line redrawn in place
/// on a terminal, else a plain line every ten seconds.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const bernal::Progress&);
  /// Takes the line off the terminal, so that messages can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  Clock::time_point start_;
  Clock::time_point next_;
};
