#pragma once
#include <chrono>
#include <string_view>
#include <vector>

#include "bernal/run/packing.hpp"

namespace bernal {

/// Counts what each effect of a run did and how long it took. One writer: the thread that runs the stages.
class EffectLog {
 public:
  /// The entry of that name, made at first use; the order of first uses is the order of the report.
  Effect& operator[](std::string_view name) {
    for (Effect& e : effects_) {
      if (e.name == name) return e;
    }
    return effects_.emplace_back(Effect{std::string(name)});
  }
  const std::vector<Effect>& all() const { return effects_; }

 private:
  std::vector<Effect> effects_;
};

/// Adds the time of its own life, and one call, to an effect.
class EffectTimer {
 public:
  EffectTimer(EffectLog& log, std::string_view name) : log_(log), name_(name), start_(Clock::now()) {}
  ~EffectTimer() {
    Effect& e = log_[name_];
    ++e.calls;
    e.seconds += std::chrono::duration<double>(Clock::now() - start_).count();
  }
  EffectTimer(const EffectTimer&) = delete;
  EffectTimer& operator=(const EffectTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  EffectLog& log_;
  std::string_view name_;
  Clock::time_point start_;
};

}  // namespace bernal
