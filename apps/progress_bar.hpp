#pragma once
#include "bernal/core/monitor.hpp"

/// Shows on standard error how far a run has come, once it has taken two seconds: one line redrawn in place
/// on a terminal, else a plain line every ten seconds. As soon as there is one, the first SIGINT or SIGTERM
/// only makes `interrupted()` true, so that a run can end with what it has; the second one kills.
class ProgressBar {
 public:
  /// `silent`: says nothing of an interrupt.
  ProgressBar(bool quiet, bool silent);
  explicit ProgressBar(bool quiet) : ProgressBar(quiet, quiet) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows the progress of what is such a part of all, and stops it when interrupted.
  bernal::Monitor monitor(double from = 0, double to = 1);
  /// Takes the line off the terminal, so that messages can follow.
  void clear();

 private:
  void show(const bernal::Progress&);

  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  bernal::Stopwatch watch_;
  double next_;  ///< seconds
};

bool interrupted();
