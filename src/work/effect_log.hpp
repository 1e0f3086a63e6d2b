#pragma once
#include <chrono>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bernal/scene/packing.hpp"
#include "core/made.hpp"
#include "scene/run_archive.hpp"

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
  /// The same with the time of what is in progress in this thread.
  std::vector<Effect> all_so_far() const;
  /// Those that there were in an earlier process: in their order, if nothing has been counted yet.
  void go_on_from(const std::vector<Effect>& earlier) {
    for (const Effect& e : earlier) (*this)[e.name] = e;
  }

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
        around_(std::exchange(innermost_, this)),
        start_(Clock::now()) {}
  ~EffectTimer() {
    innermost_ = around_;
    effect_in_progress = outer_;
    ++effect_.calls;
    effect_.seconds += seconds();
  }
  EffectTimer(const EffectTimer&) = delete;
  EffectTimer& operator=(const EffectTimer&) = delete;

 private:
  friend class EffectLog;
  using Clock = std::chrono::steady_clock;
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  inline static thread_local const EffectTimer* innermost_ = nullptr;
  Effect& effect_;
  const char* const outer_;
  const EffectTimer* const around_;
  Clock::time_point start_;
};

inline std::vector<Effect> EffectLog::all_so_far() const {
  std::vector<Effect> so_far = all();
  for (const EffectTimer* timer = EffectTimer::innermost_; timer; timer = timer->around_)
    for (std::size_t k = 0; k < effects_.size(); ++k)
      if (&timer->effect_ == &effects_[k]) so_far[k].seconds += timer->seconds();
  return so_far;
}

}  // namespace bernal
