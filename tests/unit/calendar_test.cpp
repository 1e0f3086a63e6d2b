#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "bernal/core/random.hpp"
#include "hard/calendar.hpp"

namespace bernal {
namespace calendar_test {

/// The oracle is a sorted set. Events are replaced as collisions replace them: two or three for each that
/// comes up.
TEST(Calendar, BringsEventsUpInOrder) {
  for (const std::size_t expected : {std::size_t{1}, std::size_t{70}, std::size_t{3000}}) {
    SCOPED_TRACE(expected);
    Random random(5, stream(Stream::test));
    constexpr Calendar::Id count = 200;
    constexpr double horizon = 10;
    Calendar calendar;
    calendar.start_period(count, horizon, expected);
    std::set<std::pair<double, Calendar::Id>> oracle;
    const auto schedule = [&](Calendar::Id id, double time) {
      oracle.erase({calendar.time(id), id});
      calendar.schedule(id, time, id + 1);
      if (time < horizon) oracle.insert({time, id});
    };
    for (Calendar::Id id = 0; id < count; ++id) schedule(id, random.uniform(0, 1));
    double now = 0;
    int came_up = 0;
    for (Calendar::Id id; (id = calendar.next()) != Calendar::none; ++came_up) {
      ASSERT_FALSE(oracle.empty());
      ASSERT_EQ(std::pair(calendar.time(id), id), *oracle.begin());
      EXPECT_EQ(calendar.what(id), id + 1);
      ASSERT_GE(calendar.time(id), now);
      now = calendar.time(id);
      schedule(id, now + random.uniform(0, 2));
      const auto other = static_cast<Calendar::Id>(random.uniform() * count);
      schedule(other, random.uniform() < 0.1 ? now : now + random.uniform(0, 1));
    }
    EXPECT_TRUE(oracle.empty());
    EXPECT_GT(came_up, 1000);
  }
}

TEST(Calendar, BreaksTiesById) {
  Calendar calendar;
  calendar.start_period(3, 1, 4);
  calendar.schedule(2, 0.5, 0);
  calendar.schedule(0, 0.5, 0);
  calendar.schedule(1, 0.5, 0);
  EXPECT_EQ(calendar.next(), 0u);
  calendar.schedule(0, 2, 0);  // beyond the horizon
  EXPECT_EQ(calendar.next(), 1u);
  EXPECT_EQ(calendar.time(0), 2);
}

/// One pair that collides ever again, and forgets each time what it had to do in many days to come, and in
/// one. The calendar drops what no longer stands, and keeps what does: the far events of all others come up.
TEST(Calendar, KeepsWhatStandsAmongMuchThatFell) {
  constexpr Calendar::Id count = 64;
  Random random(6, stream(Stream::test));
  Calendar calendar;
  calendar.start_period(count, 1, 20 * count);
  for (Calendar::Id id = 2; id < count; ++id) calendar.schedule(id, 0.5 + 0.4 * random.uniform(), id);
  const std::size_t before = calendar.bytes();
  for (int k = 0; k < 100000; ++k) {
    calendar.schedule(0, 0.95, 0);
    calendar.schedule(1, 0.5 + 0.4 * random.uniform(), 1);
  }
  // 4 bytes for each of 15 noted ids, and for the note's next: 6 noted for each thing and a note for each
  // day.
  EXPECT_LT(calendar.bytes() - before, 2 * 64 * (6 * count / 15 + 20 * count / 16 + 2));
  double now = 0;
  std::set<Calendar::Id> came_up;
  for (Calendar::Id id; (id = calendar.next()) != Calendar::none;) {
    EXPECT_GE(calendar.time(id), now);
    now = calendar.time(id);
    EXPECT_TRUE(came_up.insert(id).second) << id;
    calendar.schedule(id, Calendar::never, id);
  }
  EXPECT_EQ(came_up.size(), count);
}

/// Where the calendar drops what fell to note one more event, and this leaves room in a note of that day,
/// what stood in the note before is gone: each event that is scheduled once is foreseen once.
TEST(Calendar, ForeseesNothingTwiceAfterItDroppedWhatFell) {
  constexpr Calendar::Id count = 16, fallen = 10;  // the others have been noted last
  for (int turns = 0; turns < 500; ++turns) {
    Calendar calendar;
    calendar.start_period(count, 1, 48);
    for (Calendar::Id id = 1; id < count; ++id) calendar.schedule(id, 0.6 + 0.001 * id, id);
    for (Calendar::Id id = 1; id <= fallen; ++id) calendar.schedule(id, Calendar::never, id);
    for (int k = 0; k < turns; ++k) calendar.schedule(0, 0.6 + 1e-5 * k, 0);
    ASSERT_NE(calendar.next(), Calendar::none);
    std::multiset<Calendar::Id> foreseen;
    for (std::size_t k = calendar.over(); calendar.of_today(k) != Calendar::none; ++k)
      foreseen.insert(calendar.of_today(k));
    for (Calendar::Id id = 1; id < count; ++id)
      ASSERT_EQ(foreseen.count(id), id > fallen ? 1u : 0u)
          << "event " << id << " after " << turns << " turns";
  }
}

/// The same within the day at hand, of which there is one.
TEST(Calendar, KeepsWhatStandsAmongMuchThatFellToday) {
  Random random(8, stream(Stream::test));
  Calendar calendar;
  calendar.start_period(3, 1, 1);
  calendar.schedule(0, 0.1, 0);
  EXPECT_EQ(calendar.next(), 0u);
  const std::size_t before = calendar.bytes();
  for (int k = 0; k < 100000; ++k) {
    calendar.schedule(0, 0.95, 0);
    calendar.schedule(1, random.uniform(0.2, 0.9), 1);
    calendar.schedule(2, 0.97, 2);
  }
  EXPECT_LT(calendar.bytes() - before, 8000u);
  for (const Calendar::Id id : {1u, 0u, 2u}) {
    EXPECT_EQ(calendar.next(), id);
    calendar.schedule(id, Calendar::never, id);
  }
  EXPECT_EQ(calendar.next(), Calendar::none);
}

/// What is foreseen for today is what comes up, as long as nothing is scheduled in between.
TEST(Calendar, TellsWhatComesUpToday) {
  constexpr Calendar::Id count = 300;
  Random random(7, stream(Stream::test));
  Calendar calendar;
  calendar.start_period(count, 1, count);
  for (Calendar::Id id = 0; id < count; ++id) calendar.schedule(id, random.uniform(), id);
  std::size_t day = 0, foreseen = 0;
  for (Calendar::Id id; (id = calendar.next()) != Calendar::none; ++foreseen) {
    EXPECT_EQ(calendar.of_today(calendar.over()), id);
    day = calendar.day();
    calendar.schedule(id, Calendar::never, id);
  }
  EXPECT_EQ(foreseen, count);
  EXPECT_GT(day, 10u);
  EXPECT_EQ(calendar.of_today(calendar.over()), Calendar::none);
}

/// All at one time, as of spheres that touch from the start: a sorted list that is made by insertion, or one
/// that is searched through for each event, would take some 10^10 steps here.
TEST(Calendar, TakesManyEventsAtOneTime) {
  constexpr Calendar::Id count = 200000;
  Calendar calendar;
  calendar.start_period(count, 1, count);
  for (Calendar::Id id = 0; id < count; ++id) calendar.schedule(count - 1 - id, 0, 0);
  for (Calendar::Id id = 0; id < count; ++id) {
    ASSERT_EQ(calendar.next(), id);
    calendar.schedule(id, 0, 1);  // it comes up again, at once
    ASSERT_EQ(calendar.next(), id);
    ASSERT_EQ(calendar.what(id), 1u);
    calendar.schedule(id, 2, 0);
  }
  EXPECT_EQ(calendar.next(), Calendar::none);
}

}  // namespace calendar_test
}  // namespace bernal
