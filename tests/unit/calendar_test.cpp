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
  for (const std::size_t bins : {std::size_t{1}, std::size_t{7}, std::size_t{3000}}) {
    SCOPED_TRACE(bins);
    Random random(5, stream(Stream::test));
    constexpr Calendar::Id count = 200;
    constexpr double horizon = 10;
    Calendar calendar;
    calendar.start_period(count, horizon, bins);
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

TEST(Calendar, ChangesWhatWithoutWhen) {
  Calendar calendar;
  calendar.start_period(2, 1, 4);
  calendar.schedule(1, 0.25, 7);
  calendar.change(1, 8);
  EXPECT_EQ(calendar.next(), 1u);
  EXPECT_EQ(calendar.what(1), 8u);
  EXPECT_EQ(calendar.time(1), 0.25);
}

}  // namespace calendar_test
}  // namespace bernal
