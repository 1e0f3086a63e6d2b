#include "soft/growing_box.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace bernal {
namespace growing_box_test {

/// Tells of overlaps that are given, one a cycle, and remembers how its box grows.
struct Overlaps {
  std::vector<double> to_meet;
  std::vector<double> growths{};
  std::size_t cycle = 0;

  void wear_lists(double) {}
  void sweep(float) {}
  double sweep_to_overlap(float) { return to_meet[cycle++]; }
  double sweep_and_measure(float omega) { return sweep_to_overlap(omega); }
  void grow(double factor) { growths.push_back(factor - 1); }
};

std::vector<double> growths_of(std::vector<double> overlaps, double beta) {
  Overlaps engine{std::move(overlaps)};
  BoxGrowth growth;
  const StageEnd end = grow_apart<3>(
      engine, {.stop = 1e-3, .sweeps = 3, .beta = beta}, growth, [] { return false; },
      [](int, double overlap) { return overlap; }, [](double, double) {});
  EXPECT_EQ(end, StageEnd::converged);
  EXPECT_EQ(engine.cycle, engine.to_meet.size()) << "ends with the first overlap below stop";
  return engine.growths;
}

void expect_near(const std::vector<double>& values, const std::vector<double>& expected) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_NEAR(values[k], expected[k], 1e-12) << k;
}

TEST(GrowApart, GrowsByTheLargestOverlapWhileThatFalls) {
  expect_near(growths_of({0.4, 0.3, 0.1, 0.02, 5e-4}, 20), {0.02, 0.015, 0.005, 0.001});
}

// A pair that met before the lists knew of it: no reason for more room for all.
TEST(GrowApart, GrowsNoFasterForAPairThatMetUnseen) {
  expect_near(growths_of({0.4, 0.2, 0.8, 0.5, 0.1, 5e-4}, 10), {0.04, 0.02, 0.02, 0.02, 0.01});
}

// From 0.0025 to 0.002 by a growth of 0.00025: four times as much, 0.001, would take the rest; 0.9 of it is
// more than a sixth of the overlap, which is the most.
TEST(GrowApart, PredictsTheLastGrowths) {
  expect_near(growths_of({2.5e-3, 2e-3, 5e-4}, 10), {2.5e-4, 2e-3 / 6});
}

}  // namespace growing_box_test
}  // namespace bernal
