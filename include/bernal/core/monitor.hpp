#pragma once
#include <chrono>
#include <functional>
#include <string_view>

namespace bernal {

/// How far a long piece of work has come.
struct Progress {
  std::string_view activity;  ///< "compress", "refill", …
  double fraction = 0;        ///< in [0, 1]; negative where it is not known
  std::string_view detail;    ///< "21,304 spheres, packing fraction 0.5312"
};

/// What a long piece of work tells its caller and asks of it. Both members may be empty.
/// `on_progress` is called from one thread, at most some tens of times a second.
/// `cancelled` is asked at every safe point; once it has answered true the work ends with a valid partial
/// result and the outcome `cancelled`.
struct Monitor {
  std::function<void(const Progress&)> on_progress;
  std::function<bool()> cancelled;

  void report(const Progress& p) const {
    if (on_progress) on_progress(p);
  }
  bool stop() const { return cancelled && cancelled(); }
};

/// Thrown by work that has no partial result once its monitor has said stop, and caught by what has one.
struct Cancelled {};

/// Seconds since it was made.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace bernal
