#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "bernal/core/random.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "support/scenes.hpp"
#include "support/scenes_under_test.hpp"

// What is true of every packing, whatever its scene. A new container, size distribution or stage is held to
// these laws by its example in data/scenes, or by one line here.
namespace bernal {
namespace packings_test {

using testing::box;
using testing::expect_certified;
using testing::plan_of;
using testing::relax;
using testing::run_with;
using testing::SceneUnderTest;
using testing::unequal_edges;

std::string in_camel_case(const std::string& snake) {
  std::string name;
  for (std::size_t i = 0; i < snake.size(); ++i) {
    if (snake[i] == '_') continue;
    const bool first = i == 0 || snake[i - 1] == '_';
    name += first ? static_cast<char>(std::toupper(static_cast<unsigned char>(snake[i]))) : snake[i];
  }
  return name;
}

std::vector<SceneUnderTest> scenes_under_test() {
  std::vector<SceneUnderTest> scenes;
  for (const auto& file : testing::example_scenes()) {
    scenes.push_back({in_camel_case(file.stem().string()),
                      [file] { return build(testing::small(read_scene(file), 500)); }});
  }
  std::ranges::move(testing::own_scenes(), std::back_inserter(scenes));
  return scenes;
}

class EveryPacking : public ::testing::TestWithParam<SceneUnderTest> {};

INSTANTIATE_TEST_SUITE_P(, EveryPacking, ::testing::ValuesIn(scenes_under_test()),
                         [](const auto& tested) { return tested.param.name; });

void expect_certified_and_what_was_asked_for(const Plan& plan, const Packing& packing) {
  expect_certified(packing);
  EXPECT_FALSE(packing.reason.empty());
  const Target& target = plan.scene.target;
  // Every scene here asks for something that its stages can do.
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  // The box is to follow from the packing, not the other way round.
  if (plan.box_follows && target.packing_fraction) {
    EXPECT_NEAR(packing.packing_fraction(), *target.packing_fraction, 1e-12);
  } else if (plan.box_follows) {
    EXPECT_GT(packing.packing_fraction(), 0.5);
  }
  if (target.count) {
    EXPECT_EQ(packing.spheres.size(), static_cast<std::size_t>(*target.count));
  } else if (target.packing_fraction) {
    EXPECT_GE(packing.packing_fraction(), *target.packing_fraction * (1 - 1e-12));
  } else {
    // Insertion alone ends at 0.30; compression and refilling bring it well beyond, in any container this
    // wide.
    EXPECT_GT(packing.packing_fraction(), 0.35);
  }
}

void expect_another_of_another_seed(const Plan& plan, const Packing& packing) {
  const Packing of_other_seed = run(plan, {.seed = plan.scene.seed + 1, .threads = 1});
  EXPECT_NE(hash_of(of_other_seed.spheres), hash_of(packing.spheres));
  EXPECT_EQ(of_other_seed.seed, plan.scene.seed + 1);
}

// The packer works in a frame whose scale is a power of two, so such a factor leaves it with the same bits;
// and so does the number of threads.
void expect_same_bits_at_powers_of_two_in_threads(const SceneUnderTest& tested, const Packing& packing) {
  for (const auto& [factor, threads] : {std::pair{0x1p10, 2}, std::pair{0x1p-20, 1}}) {
    const ::testing::ScopedTrace trace(__FILE__, __LINE__, std::to_string(threads) + " threads");
    const Packing scaled = run_with(testing::scaled(tested.plan(), factor), threads);
    ASSERT_EQ(scaled.spheres.size(), packing.spheres.size());
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      ASSERT_EQ(scaled.spheres.center(i), factor * packing.spheres.center(i)) << i;
      ASSERT_EQ(scaled.spheres.r[i], factor * packing.spheres.r[i]) << i;
    }
    EXPECT_EQ(bounds_of<dynamic>(scaled.domain).size(), factor * bounds_of<dynamic>(packing.domain).size());
  }
}

void expect_certified_at_any_scale_and_far_away(const SceneUnderTest& tested) {
  const double size = bounds_of<dynamic>(tested.plan().domain).size().norm();
  const Vector<3> far = 1e4 * size * Vector<3>(0.6, -1, 0.3);
  Plan plans[] = {testing::scaled(tested.plan(), 1e-6), testing::scaled(tested.plan(), 1e6),
                  testing::shifted(tested.plan(), far)};
  for (const Plan& elsewhere : plans) {
    const Packing packing = run_with(elsewhere);
    EXPECT_GE(packing.spheres.size(), 40u);
    expect_certified(packing);
  }
}

/// The radii are those that the seed draws, in their order and to the last bit; in a container less those
/// that found no place: no more than the window of work/supply.hpp holds.
void expect_radii_that_were_drawn(const Plan& plan, const Packing& packing) {
  const double largest = std::ranges::max(packing.spheres.r);
  const bool cut = std::isinf(plan.radii->max());  // then draws beyond the container's room are not asked for
  RadiusSequence sequence(*plan.radii, packing.seed, *plan.scene.draw, plan.start.spheres.r);
  std::size_t passed_over = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    double drawn = sequence.next();
    for (; drawn != packing.spheres.r[i] && passed_over < packing.spheres.size(); drawn = sequence.next())
      if (!cut || drawn <= largest) ++passed_over;
    ASSERT_EQ(drawn, packing.spheres.r[i]) << i;
  }
  const bool periodic = plan.scene.is_periodic();
  EXPECT_LE(passed_over, periodic ? 0 : std::max<std::size_t>(16, packing.spheres.size() / 50));
}

/// Stops the run when it asks for the k-th time.
Packing cancelled_after(const Plan& plan, std::size_t k) {
  std::size_t polls = 0;
  RunOptions options;
  options.threads = 1;
  options.monitor.cancelled = [&] { return ++polls > k; };
  Packing packing = run(plan, options);
  EXPECT_EQ(polls, k + 1) << "it went on after it was told to stop";
  return packing;
}

/// `polls`: how often the run to the end asks.
void expect_whole_where_it_is_cancelled(const Plan& plan, std::size_t all, std::size_t polls) {
  // Before the first sphere, among the first ones, and in the last stage. In a periodic box all spheres are
  // there from the start, and the box becomes as large as it must; relaxation in a container leaves those
  // that touch nothing, and so does filling of a box of given size.
  const bool periodic = plan.scene.is_periodic() && plan.scene.stages.front().name() == "relax";
  const bool inserts = plan.scene.stages.front().name() == "insert";
  for (const std::size_t k : {std::size_t{0}, std::min<std::size_t>(30, polls / 2), polls - 1}) {
    const Packing packing = cancelled_after(plan, k);
    EXPECT_EQ(packing.outcome, Outcome::cancelled);
    EXPECT_NE(packing.reason.find("stopped"), std::string::npos) << packing.reason;
    if (periodic) {
      EXPECT_EQ(packing.spheres.size(), all);
    } else {
      EXPECT_LE(packing.spheres.size(), k <= 30 && inserts ? k : all);
    }
    expect_certified(packing);
  }
}

std::set<std::string> effects_of(const Packing& packing) {
  std::set<std::string> names;
  for (const Effect& effect : packing.effects) {
    names.insert(effect.name);
    EXPECT_GT(effect.calls, 0u) << effect.name;
    EXPECT_GT(effect.seconds, 0) << effect.name;
  }
  return names;
}

void expect_what_the_plan_says_and_nothing_that_it_leaves_out(const Plan& plan, const Packing& packing) {
  std::set<std::string> planned;
  for (const PlanItem& item : plan.items) planned.insert(item.name);
  for (const std::string& name : effects_of(packing)) {
    EXPECT_TRUE(planned.contains(name)) << name;
    EXPECT_EQ(std::ranges::count(plan.absent, name), 0) << name;
  }
}

// One test a scene, so that it is packed once for all that its laws have in common.
TEST_P(EveryPacking, KeepsTheLaws) {
  const Plan plan = GetParam().plan();
  std::size_t polls = 0;
  RunOptions options{.threads = 1};
  options.monitor.cancelled = [&] {
    ++polls;
    return false;
  };
  const Packing packing = run(plan, options);
  expect_certified_and_what_was_asked_for(plan, packing);
  expect_radii_that_were_drawn(plan, packing);
  expect_what_the_plan_says_and_nothing_that_it_leaves_out(plan, packing);
  expect_another_of_another_seed(plan, packing);
  expect_same_bits_at_powers_of_two_in_threads(GetParam(), packing);
  expect_certified_at_any_scale_and_far_away(GetParam());
  expect_whole_where_it_is_cancelled(plan, packing.spheres.size(), polls);
}

TEST(Packing, OfGrowthThatIsStoppedWhileItsSpheresLookForPlacesHasNone) {
  const Plan plan = plan_of(
      "[container]\nkind = \"periodic\"\nedge = 1.0\n[spheres]\npacking_fraction = 0.5\nradius = 0.02\n"
      "[[stage]]\ndo = \"grow\"\nphi_init = 0.32\n");
  const Packing packing = cancelled_after(plan, 0);
  EXPECT_EQ(packing.outcome, Outcome::cancelled);
  EXPECT_EQ(packing.spheres.size(), 0u);
  expect_certified(packing);
}

const std::string compressed =
    "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\n"
    "[[stage]]\ndo = \"shake\"\n[[stage]]\ndo = \"refill\"\n";
const std::string insert_only = "[[stage]]\ndo = \"insert\"\npacking_fraction = 0.2\n";

TEST(Packing, RunsOnlyTheEffectsThatTheSceneCallsFor) {
  const std::string spheres = "[spheres]\nfill = true\nradius = 0.07\n";
  EXPECT_EQ(effects_of(run_with(plan_of(box + spheres + insert_only))),
            (std::set<std::string>{"insertion", "walls"}));
  const auto pushed_down =
      effects_of(run_with(plan_of(box + spheres + insert_only + "[[stage]]\ndo = \"compress\"\n")));
  EXPECT_EQ(pushed_down, (std::set<std::string>{"insertion", "walls", "neighbour lists", "compression"}));
  const auto relaxed = effects_of(run_with(plan_of(unequal_edges)));
  EXPECT_TRUE(relaxed.contains("relaxation"));
  EXPECT_FALSE(relaxed.contains("walls") || relaxed.contains("insertion") || relaxed.contains("compression"));
}

TEST(Packing, ThatReachesItsCountHasConverged) {
  const Packing packing = run_with(plan_of(box + "[spheres]\ncount = 200\nradius = 0.05\n"));
  EXPECT_EQ(packing.outcome, Outcome::converged);
  EXPECT_EQ(packing.spheres.size(), 200u);
}

TEST(Packing, ThatCannotReachItsCountIsFullAndSaysSo) {
  // No packing of equal spheres is denser than 0.7405: 0.7405 / (4/3 pi 0.07³) = 515.
  const Packing packing = run_with(plan_of(box + "[spheres]\ncount = 516\nradius = 0.07\n"));
  EXPECT_EQ(packing.outcome, Outcome::full);
  EXPECT_LT(packing.spheres.size(), 516u);
  EXPECT_GT(packing.packing_fraction(), 0.40);
  EXPECT_NE(packing.reason.find("516"), std::string::npos) << packing.reason;
  expect_certified(packing);
}

TEST(Packing, ThatCannotReachItsPackingFractionIsFull) {
  const Packing packing = run_with(plan_of(box + "[spheres]\npacking_fraction = 0.74\nradius = 0.07\n"));
  EXPECT_EQ(packing.outcome, Outcome::full);
  expect_certified(packing);
}

TEST(Packing, TellsItsHistoryInOrder) {
  const Packing packing = run_with(plan_of(box + "[spheres]\nfill = true\nradius = 0.07\n" + compressed));
  ASSERT_FALSE(packing.history.empty());
  for (std::size_t i = 1; i < packing.history.size(); ++i) {
    EXPECT_GE(packing.history[i].seconds, packing.history[i - 1].seconds);
    EXPECT_GE(packing.history[i].spheres, packing.history[i - 1].spheres);
  }
  EXPECT_EQ(packing.history.back().spheres, packing.spheres.size());
  EXPECT_NEAR(packing.history.back().packing_fraction, packing.packing_fraction(), 1e-12);
}

TEST(Packing, ComesFromTheSceneThatItCarries) {
  // A box that followed from the packing carries its size, rounded.
  for (const std::string& toml : {box + "[spheres]\ncount = 100\nradius = 0.05\n", unequal_edges}) {
    const Plan plan = plan_of(toml);
    RunOptions options;
    options.seed = 42;
    options.threads = 1;
    const Packing packing = run(plan, options);
    const Packing again = run_with(build(packing.scene));
    EXPECT_EQ(hash_of(again.spheres), hash_of(packing.spheres));
    EXPECT_EQ(bounds_of<dynamic>(domain_of(packing.scene)).size(), bounds_of<dynamic>(packing.domain).size());
    EXPECT_EQ(bounds_of<dynamic>(again.domain).size(), bounds_of<dynamic>(packing.domain).size());
  }
}

TEST(Packing, TakesOnlyProportionsFromABoxThatFollowsFromIt) {
  const auto hash_with = [](const std::string& size) {
    std::string toml = unequal_edges;
    toml.replace(toml.find("[2.0, 1.0, 0.7]"), 15, size);
    const Packing packing = run_with(plan_of(toml));
    const Vector<dynamic> edges = bounds_of<dynamic>(packing.domain).size();
    EXPECT_NEAR(edges[1] / edges[0], 0.5, 1e-11);
    EXPECT_NEAR(edges[2] / edges[0], 0.35, 1e-11);
    return hash_of(packing.spheres);
  };
  const std::string hash = hash_with("[2.0, 1.0, 0.7]");
  for (const char* size : {"[1.0, 0.5, 0.35]", "[6e9, 3e9, 2.1e9]", "[0.02, 0.01, 0.007]"})
    EXPECT_EQ(hash_with(size), hash) << size;
}

TEST(Packing, ThatNeedsALargerBoxIsFullAndStillWhole) {
  // Denser than any packing of equal spheres in a box of that size.
  const Packing packing = run_with(plan_of(
      "[container]\nkind = \"periodic\"\nedge = 1.0\n[spheres]\npacking_fraction = 0.75\nradius = 0.1\n" +
      relax));
  EXPECT_EQ(packing.outcome, Outcome::full);
  EXPECT_GT(packing.volume, 1);
  expect_certified(packing);
}

}  // namespace packings_test
}  // namespace bernal
