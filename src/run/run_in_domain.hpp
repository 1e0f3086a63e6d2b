#pragma once
#include <chrono>

#include "bernal/run/run.hpp"

namespace bernal {

/// Seconds since it was made.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Both run the plan's stages and fill in the spheres, the domain if it follows from them, what ran and the
/// outcome; `packing` comes with what the plan and the call already say.
void run_in_container(const Plan& plan, const Monitor& monitor, const Stopwatch& watch, Packing& packing);
void run_in_periodic_box(const Plan& plan, const Monitor& monitor, const Stopwatch& watch, Packing& packing);

}  // namespace bernal
