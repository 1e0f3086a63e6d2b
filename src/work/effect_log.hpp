#pragma once
#include <chrono>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bernal/run/packing.hpp"
#include "core/made.hpp"

namespace bernal {

/// Counts what each effect of a run did and how long it took. One writer: the thread that runs the stages.
class EffectLog {
 public:
  /// The entry of that name, made at first use; the order of first uses is the order of the report.
  Effect& operator[](std::string_view name) {
    for (Effect& e : effects_) {
      if (e.name == name) return e;
    }
    return effects_.emplace_back(Effect{std::string(name), 0, 0});
  }
  std::vector<Effect> all() const { return {effects_.begin(), effects_.end()}; }

 private:
  std::deque<Effect> effects_;  // entries stay where they are
};

/// What both did, under the name of the first.
inline Effect& operator+=(Effect& effect, const Effect& other) {
  effect.calls += other.calls;
  effect.seconds += other.seconds;
  return effect;
}
inline Effect operator+(Effect one, const Effect& other) { return one += other; }

/// Adds the time of its own life, and one call, to an effect, which is `effect_in_progress` as long. Cost:
/// about 50 ns.
class EffectTimer {
 public:
  explicit EffectTimer(Effect& effect)
      : effect_(effect),
        outer_(std::exchange(effect_in_progress, effect.name.c_str())),
        start_(Clock::now()) {}
  ~EffectTimer() {
    effect_in_progress = outer_;
    ++effect_.calls;
    effect_.seconds += std::chrono::duration<double>(Clock::now() - start_).count();
  }
  EffectTimer(const EffectTimer&) = delete;
  EffectTimer& operator=(const EffectTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  Effect& effect_;
  const char* const outer_;
  Clock::time_point start_;
};

}  // namespace bernal
