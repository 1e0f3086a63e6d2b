#include "soft/growing_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

/// Tells of a sphere's overlap, half of the largest, where a sweep was to measure each.
struct OverlapsOfEach : Overlaps {
  std::vector<float> last{};

  double sweep_to_overlap(float omega) {
    last.clear();
    return Overlaps::sweep_to_overlap(omega);
  }
  double sweep_and_measure(float omega) {
    const double largest = Overlaps::sweep_to_overlap(omega);
    last = {static_cast<float>(largest / 2)};
    return largest;
  }
  std::vector<float> squeeze() const { return last; }
};

TEST(GrowApart, GrowsByWhatItIsToldOfEachSphere) {
  OverlapsOfEach engine;
  engine.to_meet = {0.5, 0.25, 5e-4};
  BoxGrowth growth;
  const auto of_sphere = [](int, double, const std::vector<float>& squeeze) { return squeeze.at(0); };
  EXPECT_EQ(grow_apart<3>(
                engine, {.stop = 1e-3, .sweeps = 3, .beta = 10}, growth, [] { return false; }, of_sphere,
                [](double, double) {}),
            StageEnd::converged);
  expect_near(engine.growths, {0.025, 0.0125});
}

TEST(ShareOfWork, GrowsAsTheOverlapFallsUntilGrowthsArePredicted) {
  const GrowingBox box{.stop = 3e-6, .sweeps = 100, .beta = 30, .last_overlap = 1e-3};
  const auto share_at = [&](double overlap, double molr) {
    return share_of_work({.molr = molr, .first_overlap = 0.1, .overlap = overlap}, box);
  };
  EXPECT_EQ(share_of_work({}, box), 0) << "before the first growth";
  EXPECT_EQ(share_at(0.1, 0.5), 0);
  EXPECT_NEAR(share_at(0.01, 0.1), 0.9 * std::pow(0.5, 0.6), 1e-12) << "half of the factors";
  EXPECT_NEAR(share_at(1e-3, 0.01), 0.9, 1e-12);
  EXPECT_NEAR(share_at(1e-4, 0.01), 0.9, 1e-12) << "no more until growths are predicted";
  EXPECT_NEAR(share_at(5e-4, 9.4868e-5), 0.95, 1e-4);
  EXPECT_NEAR(share_at(1e-6, 1e-6), 1, 1e-12);
  EXPECT_NEAR(share_of_work({.molr = 0.01, .first_overlap = 1e-4, .overlap = 1e-4}, box), 0.9, 1e-12)
      << "where it begins nearly parted";
}

// From 0.0025 to 0.002 by a growth of 0.00025: four times as much, 0.001, would take the rest; 0.9 of it is
// more than a sixth of the overlap, which is the most.
TEST(GrowApart, PredictsTheLastGrowths) {
  expect_near(growths_of({2.5e-3, 2e-3, 5e-4}, 10), {2.5e-4, 2e-3 / 6});
}

}  // namespace growing_box_test
}  // namespace bernal
