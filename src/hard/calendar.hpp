#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/large_pages.hpp"
#include "core/made.hpp"
#include "hard/prefetch.hpp"

namespace bernal {

/// The pending events of a number of objects, one for each: a calendar queue over one period.
///
/// The period [0, horizon) is divided into days of equal length. For a future day only the ids scheduled for
/// it are noted, one after the other; an id that is rescheduled remains in its old note and is skipped there.
/// When a day begins, its events are sorted; events scheduled later for the same day go to a heap. So
/// scheduling writes to the ends of near days, which stay in the caches for any number of objects, and
/// upcoming events are known far ahead. Events at or beyond the horizon are stored but never come up: the
/// caller schedules all events anew for the next period. Simultaneous events come up in the order of their
/// ids.
///
/// Cost: O(1) to schedule, and O(log d) for `next` with d events a day, if about as many events as expected
/// occur, evenly spread; O(log n) in any case. Memory: 16 bytes an object, and about 16 for notes, at most
/// 40. Source: Paul, J. Comput. Phys. 221, 615 (2007), without its linked lists.
class Calendar {
 public:
  using Id = std::uint32_t;
  static constexpr Id none = 0xFFFFFFFF;
  static constexpr double never = std::numeric_limits<double>::infinity();

  /// Forgets all events.
  void start_period(std::size_t ids, double horizon, std::size_t expected_events) {
    events_.assign(ids, Event{});
    const std::size_t events_a_day = std::clamp(ids / days_a_round, least_a_day, most_a_day);
    days_.assign(expected_events / events_a_day + 1, Day{});
    notes_.clear();
    free_ = none;
    noted_ = 0;
    today_.clear();
    late_.clear();
    at_ = begun_ = 0;
    horizon_ = horizon;
    days_per_time_ = static_cast<double>(days_.size()) / horizon;
  }

  double time(Id id) const { return events_[id].time; }
  /// The event's kind, as scheduled.
  Id what(Id id) const { return events_[id].what; }

  /// Replaces the event of `id`. Precondition: time is not before that of the last event that came up.
  void schedule(Id id, double time, Id what) {
    events_[id] = {time, what};
    if (!(time < horizon_)) return;
    const std::size_t day = day_of(time);
    if (day >= begun_) return note(days_[day], id);
    late_.push_back({time, id});
    std::ranges::push_heap(late_, later);
    if (late_.size() > most_noted * (events_.size() + least_a_day)) drop_what_fell_today();
  }

  /// The object with the earliest event, or `none` if there is none before the horizon. It stays scheduled.
  Id next() {
    for (;;) {
      while (at_ < today_.size() && !stands(today_[at_])) ++at_;
      while (!late_.empty() && !stands(late_.front())) {
        std::ranges::pop_heap(late_, later);
        late_.pop_back();
      }
      const bool any = at_ < today_.size();
      if (!late_.empty() && (!any || later(today_[at_], late_.front()))) return late_.front().id;
      if (any) return today_[at_].id;
      if (begun_ == days_.size()) return none;
      begin_day();
    }
  }

  /// Memory in use.
  std::size_t bytes() const {
    return events_.capacity() * sizeof(Event) + days_.capacity() * sizeof(Day) +
           notes_.capacity() * sizeof(Note) + (today_.capacity() + late_.capacity()) * sizeof(Entry) +
           noted_today_.capacity() * sizeof(Id);
  }

  /// For prefetching: the number of days begun, of today's events that are over, and the object of today's
  /// k-th event (unless others come in between), or `none`.
  std::size_t day() const { return begun_; }
  std::size_t over() const { return at_; }
  Id of_today(std::size_t k) const { return k < today_.size() ? today_[k].id : none; }
  void prefetch(Id id) const { bernal::prefetch(&events_[id]); }

 private:
  /// Events a day: few enough that they fit the first-level cache while they are sorted and few are scheduled
  /// for the current day; not so few that the ends of all days in use exceed the second-level cache.
  static constexpr std::size_t days_a_round = 32, least_a_day = 16, most_a_day = 512;
  /// Noted ids for each object; beyond this, outdated ones are dropped.
  static constexpr std::size_t most_noted = 6;

  struct Event {
    double time = never;
    Id what = none;
  };
  struct Entry {
    double time;
    Id id;
  };
  static constexpr std::uint32_t ids_a_note = 15;
  struct alignas(64) Note {
    Id ids[ids_a_note];
    std::uint32_t next;
  };
  struct Day {
    std::uint32_t note = none;
    std::uint32_t free = 0;  // free entries in that note
  };

  static bool later(const Entry& a, const Entry& b) {
    return a.time > b.time || (a.time == b.time && a.id > b.id);
  }
  bool stands(const Entry& entry) const { return events_[entry.id].time == entry.time; }
  std::size_t day_of(double time) const {
    return std::min(static_cast<std::size_t>(time * days_per_time_), days_.size() - 1);
  }

  void note(Day& day, Id id) {
    if (day.free == 0 && noted_ > most_noted * events_.size() + ids_a_note * days_.size()) drop_what_fell();
    append(day, id);
  }
  void append(Day& day, Id id) {
    if (day.free == 0) {
      std::uint32_t fresh = free_;
      if (fresh != none) {
        free_ = notes_[fresh].next;
      } else {
        fresh = static_cast<std::uint32_t>(notes_.size());
        notes_.emplace_back();
      }
      notes_[fresh].next = day.note;
      day = {fresh, ids_a_note};
      noted_ += ids_a_note;
    }
    notes_[day.note].ids[--day.free] = id;
  }
  /// Calls visit(id) for the ids noted for a day, and frees its notes.
  template <class Visit>
  void take_notes(Day& day, Visit&& visit) {
    std::uint32_t used = day.free;
    for (std::uint32_t at = day.note; at != none; used = 0) {
      Note& note = notes_[at];
      for (std::uint32_t k = used; k < ids_a_note; ++k) visit(note.ids[k]);
      noted_ -= ids_a_note;
      const std::uint32_t next = note.next;
      note.next = free_;
      free_ = at;
      at = next;
    }
    day = {};
  }
  void begin_day() {
    const std::size_t day = begun_++;
    today_.clear();
    at_ = 0;
    noted_today_.clear();
    take_notes(days_[day], [&](Id id) { noted_today_.push_back(id); });
    constexpr std::size_t ahead = 16;
    for (std::size_t k = 0; k < noted_today_.size(); ++k) {
      if (k + ahead < noted_today_.size()) prefetch(noted_today_[k + ahead]);
      const Id id = noted_today_[k];
      const double time = events_[id].time;
      if (time < horizon_ && day_of(time) == day) today_.push_back({time, id});
    }
    std::ranges::sort(today_, [](const Entry& a, const Entry& b) { return later(b, a); });
  }
  void drop_what_fell() {
    std::vector<Id> standing;
    for (std::size_t day = begun_; day < days_.size(); ++day) {
      standing.clear();
      take_notes(days_[day], [&](Id id) {
        const double time = events_[id].time;
        if (time < horizon_ && day_of(time) == day) standing.push_back(id);
      });
      std::ranges::sort(standing);
      standing.erase(std::ranges::unique(standing).begin(), standing.end());
      for (const Id id : standing) append(days_[day], id);
    }
  }

  /// A sorted range is a heap.
  void drop_what_fell_today() {
    std::erase_if(late_, [&](const Entry& entry) { return !stands(entry); });
    std::ranges::sort(late_, [](const Entry& a, const Entry& b) { return later(b, a); });
    const auto same = [](const Entry& a, const Entry& b) { return a.time == b.time && a.id == b.id; };
    late_.erase(std::ranges::unique(late_, same).begin(), late_.end());
  }

  const Made made_{"collisions"};
  LargePageVector<Event> events_;
  std::vector<Day> days_;
  LargePageVector<Note> notes_;
  std::uint32_t free_ = none;        // the first unused note
  std::size_t noted_ = 0;            // entries in the notes of all days
  std::vector<Entry> today_, late_;  // sorted; a heap
  std::vector<Id> noted_today_;
  std::size_t at_ = 0, begun_ = 0;  // index in today_; days begun, the last of which is today
  double horizon_ = 0;
  double days_per_time_ = 0;
};

}  // namespace bernal
