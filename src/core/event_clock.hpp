#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>

namespace bernal {

/// The time of events that are shorter than two looks at the clock: of those after the first 64, which are
/// timed one by one as they may have to wait for memory and are all where there are no more, one in 64 is
/// timed, and the sum scaled.
///
/// The n-th event is timed where the fraction of n times the golden ratio is below 1/64: as evenly spread as
/// every 64th, but out of step with whatever repeats itself every few events. Error: the spread of single
/// events over the root of how many were timed, some 1 % from a million events on; each timed one contains
/// about 25 ns of the clock, which is taken off. Cost: 1 ns an event.
class EventClock {
 public:
  using ArchivedAsBytes = void;
  using Clock = std::chrono::steady_clock;

  static constexpr std::uint64_t first = 64;
  static constexpr bool is_timed(std::uint64_t n) { return n < first || n * 0x9E3779B97F4A7C15U >> 58 == 0; }
  /// Of all events, those after the first having been timed so often and taken so long.
  static double seconds_of(std::uint64_t events, double of_first, std::uint64_t timed, double seconds) {
    if (events <= first) return of_first;
    const auto more = static_cast<double>(events - first);
    return of_first + (timed > 0 ? seconds / static_cast<double>(timed) : of_first / first) * more;
  }
  static double seconds_since(Clock::time_point start) {
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return seconds > clock() ? seconds - clock() : 0.1 * seconds;
  }

  /// Adds the seconds of its own life.
  class Seconds {
   public:
    explicit Seconds(double& sum) : sum_(sum), start_(Clock::now()) {}
    ~Seconds() { sum_ += seconds_since(start_); }
    Seconds(const Seconds&) = delete;
    Seconds& operator=(const Seconds&) = delete;

   private:
    double& sum_;
    const Clock::time_point start_;
  };

  /// An event that lasts as long as this lives.
  class Event {
   public:
    explicit Event(EventClock& clock) : clock_(clock), start_(clock.start()) {}
    ~Event() { clock_.stop(start_); }
    Event(const Event&) = delete;
    Event& operator=(const Event&) = delete;

   private:
    EventClock& clock_;
    const Clock::time_point start_;
  };

  std::uint64_t events() const { return events_; }
  double seconds() const { return seconds_of(events_, of_first_, timed_, seconds_); }

 private:
  /// Before an event and after it: what comes between counts.
  Clock::time_point start() const { return is_timed(events_) ? Clock::now() : Clock::time_point(); }
  void stop(Clock::time_point start) {
    const bool is_first = events_++ < first;
    if (start == Clock::time_point()) return;
    const double seconds = seconds_since(start);
    if (is_first) {
      of_first_ += seconds;
    } else {
      ++timed_;
      seconds_ += seconds;
    }
  }

  /// What two looks in a row take.
  static double clock() {
    static const double least = [] {
      auto shortest = Clock::duration::max();
      for (int k = 0; k < 32; ++k) {
        const Clock::time_point start = Clock::now();
        shortest = std::min(shortest, Clock::now() - start);
      }
      return std::chrono::duration<double>(shortest).count();
    }();
    return least;
  }

  std::uint64_t events_ = 0, timed_ = 0;
  double of_first_ = 0, seconds_ = 0;
};

}  // namespace bernal
