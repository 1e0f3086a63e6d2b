#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/folder.hpp"

// A run that is ended at safe points and goes on from its checkpoints comes to what it would have come to,
// bit for bit, on any number of threads before and after: every scene of this folder, which are those of
// every stage.
namespace bernal {
namespace checkpoints_test {

constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

struct Ended {
  Packing packing;
  std::uint64_t safe_points = 0;  ///< that it came to
  std::string told;
};

/// Runs until so many safe points have been passed: at the last of them a checkpoint is written.
Ended run_to(std::uint64_t end, const Plan& plan, const std::filesystem::path& folder, bool resume,
             int threads) {
  Ended ended;
  RunOptions options;
  options.threads = threads;
  options.monitor.cancelled = [&] { return ended.safe_points >= end; };
  options.checkpoints.folder = folder;
  options.checkpoints.resume = resume;
  options.checkpoints.due = [&] { return ++ended.safe_points == end; };
  options.checkpoints.tell = [&](const std::string& what) { ended.told += what + "\n"; };
  ended.packing = run(plan, options);
  return ended;
}

void expect_the_same_packing(const Packing& resumed, const Packing& undisturbed) {
  EXPECT_EQ(hash_of(resumed.spheres), hash_of(undisturbed.spheres));
  EXPECT_EQ(resumed.outcome, undisturbed.outcome);
  EXPECT_EQ(resumed.reason, undisturbed.reason);
  EXPECT_EQ(resumed.packing_fraction(), undisturbed.packing_fraction());
  EXPECT_EQ(resumed.size_scale, undisturbed.size_scale);
  ASSERT_EQ(resumed.history.size(), undisturbed.history.size());
  for (std::size_t k = 0; k < resumed.history.size(); ++k) {
    const Milestone &one = resumed.history[k], &other = undisturbed.history[k];
    EXPECT_EQ(one.stage, other.stage) << k;
    EXPECT_EQ(one.spheres, other.spheres) << k;
    EXPECT_EQ(one.packing_fraction, other.packing_fraction) << k;
    EXPECT_EQ(one.max_overlap, other.max_overlap) << k;
    EXPECT_EQ(one.potential, other.potential) << k;
  }
}

void expect_the_same(const Packing& resumed, const Packing& undisturbed) {
  expect_the_same_packing(resumed, undisturbed);
  // Nothing was done twice, and nothing left out.
  ASSERT_EQ(resumed.effects.size(), undisturbed.effects.size());
  for (std::size_t k = 0; k < resumed.effects.size(); ++k) {
    EXPECT_EQ(resumed.effects[k].name, undisturbed.effects[k].name);
    EXPECT_EQ(resumed.effects[k].calls, undisturbed.effects[k].calls) << resumed.effects[k].name;
  }
}

/// Walls in exact arithmetic, which have no state.
constexpr const char* takes_minutes = "settle_helix_exact";

std::vector<std::string> scenes() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(BERNAL_SOURCE "/tests/golden"))
    if (entry.path().extension() == ".toml" && entry.path().stem() != takes_minutes)
      names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

Plan plan_of_scene(const std::string& name) {
  return build(read_scene(std::filesystem::path(BERNAL_SOURCE "/tests/golden") / (name + ".toml")));
}

class Resumed : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, Resumed, ::testing::ValuesIn(scenes()),
                         [](const auto& scene) { return scene.param; });

TEST_P(Resumed, ComesToTheSameBits) {
  const Plan plan = plan_of_scene(GetParam());
  const testing::Folder folder;
  const Ended undisturbed = run_to(never, plan, folder.path(), false, 1);
  if (undisturbed.safe_points == 0) GTEST_SKIP() << "is over before the first safe point";
  // Ends seven times on the way, or at every safe point if these are fewer.
  const std::uint64_t step = (undisturbed.safe_points + 6) / 7;
  std::uint64_t passed = 0;
  int parts = 0;
  for (;; ++parts) {
    ASSERT_LE(parts, 9) << passed << " of " << undisturbed.safe_points;
    // One that goes on asks again at the safe point where it was ended, where that is at the head of a loop.
    const Ended part = run_to(step + (parts > 0 ? 1 : 0), plan, folder.path(), parts > 0, 1 + parts % 2);
    passed += part.safe_points;
    EXPECT_EQ(part.packing.resumed, parts);
    if (part.packing.outcome != Outcome::cancelled) {
      expect_the_same(part.packing, undisturbed.packing);
      break;
    }
  }
  EXPECT_GE(parts, 1);
}

/// Few spheres, and all safe points one by one.
class AtEverySafePoint : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(, AtEverySafePoint,
                         ::testing::Values("refill_hit_limit", "dense_predicted_cylinder", "relax_1d",
                                           "grow_few", "fly_3d_relaxation_hit_limit"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST_P(AtEverySafePoint, ComesToTheSameBits) {
  const Plan plan = plan_of_scene(GetParam());
  const testing::Folder folder;
  const Ended undisturbed = run_to(never, plan, folder.path(), false, 1);
  const std::uint64_t most = 20, step = std::max<std::uint64_t>(1, undisturbed.safe_points / most);
  for (std::uint64_t k = 1; k <= undisturbed.safe_points; k += step) {
    run_to(k, plan, folder.path(), false, 1);
    const Ended resumed = run_to(never, plan, folder.path(), true, 2);
    EXPECT_EQ(hash_of(resumed.packing.spheres), hash_of(undisturbed.packing.spheres)) << k;
    EXPECT_EQ(resumed.packing.resumed, 1);
  }
}

/// Whoever ends a run does so at any question, not at safe points alone: within a step of a solver, or of
/// work that has no state of its own. What it then leaves must not be taken for the end of that work.
class EndedAtAnyQuestion : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(, EndedAtAnyQuestion,
                         ::testing::Values("relax_3d_polished", "relax_cylinder_polished",
                                           "grow_2d_polished"),
                         [](const auto& scene) { return std::string(scene.param); });

Ended run_to_question(std::uint64_t end, const Plan& plan, const std::filesystem::path& folder, bool resume) {
  Ended ended;
  RunOptions options;
  options.threads = 1;
  options.monitor.cancelled = [&] { return ++ended.safe_points >= end; };
  options.checkpoints.folder = folder;
  options.checkpoints.resume = resume;
  options.checkpoints.due = [] { return false; };
  ended.packing = run(plan, options);
  return ended;
}

TEST_P(EndedAtAnyQuestion, GoesOnToTheSameBits) {
  const Plan plan = plan_of_scene(GetParam());
  const testing::Folder folder;
  const Ended undisturbed = run_to_question(never, plan, folder.path(), false);
  const std::uint64_t questions = undisturbed.safe_points, moments = 12;
  ASSERT_GT(questions, moments);
  for (std::uint64_t k = 1; k <= moments; ++k) {
    const std::uint64_t end = questions - (questions * (k - 1)) / (4 * moments);  // in the last quarter
    const Ended cut = run_to_question(end, plan, folder.path(), false);
    EXPECT_EQ(cut.packing.outcome, Outcome::cancelled) << end;
    const Ended resumed = run_to_question(never, plan, folder.path(), true);
    EXPECT_EQ(resumed.packing.resumed, 1) << end;
    expect_the_same_packing(resumed.packing, undisturbed.packing);  // a step that was ended is done anew
  }
}

/// The relaxation after it has few of the safe points, at the end: spheres that have their places only in its
/// engine, and sizes that are dealt already.
TEST(ResumedAfterExchange, ComesToTheSameBits) {
  const Plan plan = plan_of_scene("relax_3d_exchange");
  const testing::Folder folder;
  const Ended undisturbed = run_to(never, plan, folder.path(), false, 1);
  for (const std::uint64_t before_the_end : {1, 5, 25}) {
    run_to(undisturbed.safe_points - before_the_end, plan, folder.path(), false, 1);
    const Ended resumed = run_to(never, plan, folder.path(), true, 2);
    EXPECT_EQ(resumed.packing.resumed, 1);
    expect_the_same(resumed.packing, undisturbed.packing);
  }
}

}  // namespace checkpoints_test
}  // namespace bernal
