#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/made.hpp"
#include "hard/prefetch.hpp"

namespace bernal {

/// The events to come of a number of things, one for each: a calendar queue over one period.
///
/// The period [0, horizon) is cut into bins of equal length, each a doubly linked list without order; the
/// earliest event is found among the few of the first bin that is not empty. Events at or beyond the horizon
/// are remembered and never come up: who starts the next period asks for all events anew. Events at the same
/// time come up in the order of their ids.
///
/// Cost: O(1) to schedule, and for `next` as long as there are about as many bins as events come up in the
/// period, or half as many, and these are spread evenly: 40 ns an event with 10,000 things, where a binary
/// heap takes more than three times as long (tests/bench/grow_bench.cpp). Memory: 24 bytes a thing, 4 a bin.
/// Source: Paul, J. Comput. Phys. 221, 615 (2007), without its heap.
class Calendar {
 public:
  using Id = std::uint32_t;
  static constexpr Id none = 0xFFFFFFFF;
  static constexpr double never = std::numeric_limits<double>::infinity();

  /// Forgets all events.
  void start_period(std::size_t ids, double horizon, std::size_t bins) {
    events_.assign(ids, Event{});
    bins_.assign(std::max<std::size_t>(1, bins), none);
    horizon_ = horizon;
    bins_per_time_ = static_cast<double>(bins_.size()) / horizon;
    current_ = 0;
  }

  double time(Id id) const { return events_[id].time; }
  /// What the event is: whatever was scheduled.
  Id what(Id id) const { return events_[id].what; }

  /// Replaces the event of `id`. Precondition: time is not before that of the event which came up last.
  void schedule(Id id, double time, Id what) {
    Event& event = events_[id];
    unlink(event);
    event.time = time;
    event.what = what;
    if (time < horizon_) link(id, event);
  }
  /// The event stays where it is and becomes another.
  void change(Id id, Id what) { events_[id].what = what; }

  /// The bin of the event that came up last, and one of those in a later bin, or `none`: for who wants to ask
  /// the memory for what they will need.
  std::size_t bin() const { return current_; }
  Id one_of(std::size_t bin) const { return bin < bins_.size() ? bins_[bin] : none; }
  void prefetch(Id id) const { bernal::prefetch(&events_[id]); }

  /// Whose event is the earliest, or `none` if there is none before the horizon. It stays scheduled.
  Id next() {
    while (current_ < bins_.size() && bins_[current_] == none) ++current_;
    if (current_ == bins_.size()) return none;
    Id earliest = bins_[current_];
    for (Id id = events_[earliest].next; id != none; id = events_[id].next) {
      const double time = events_[id].time, best = events_[earliest].time;
      if (time < best || (time == best && id < earliest)) earliest = id;
    }
    return earliest;
  }

 private:
  static constexpr std::uint32_t unlinked = 0xFFFFFFFF;
  struct Event {
    double time = never;
    Id what = none;
    Id next = none, previous = none;
    std::uint32_t bin = unlinked;
  };

  void unlink(Event& event) {
    if (event.bin == unlinked) return;
    (event.previous == none ? bins_[event.bin] : events_[event.previous].next) = event.next;
    if (event.next != none) events_[event.next].previous = event.previous;
    event.bin = unlinked;
  }
  void link(Id id, Event& event) {
    const auto bin = static_cast<std::size_t>(event.time * bins_per_time_);
    event.bin = static_cast<std::uint32_t>(std::clamp(bin, current_, bins_.size() - 1));
    event.previous = none;
    event.next = bins_[event.bin];
    if (event.next != none) events_[event.next].previous = id;
    bins_[event.bin] = id;
  }

  const Made made_{"collisions"};
  std::vector<Event> events_;
  std::vector<Id> bins_;
  double horizon_ = 0;
  double bins_per_time_ = 0;
  std::size_t current_ = 0;
};

}  // namespace bernal
