#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "bernal/core/error.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "support/folder.hpp"
#include "support/fuzz.hpp"
#include "support/plans.hpp"

// Whatever stands in the place of a checkpoint, a run that is to go on from it goes on from one that is
// whole, or starts anew: it comes to the same spheres, and says what it passed over.
namespace bernal {
namespace checkpoint_fuzz {

const Plan& plan() {
  static const Plan plan = testing::plan_of(
      "[container]\nkind = \"periodic\"\n[spheres]\ncount = 60\nradius = 1.0\n[[stage]]\ndo = \"relax\"\n"
      "alpha = 2.0\n");
  return plan;
}

struct Ended {
  std::string hash;
  int resumed = 0;
  std::string told;
};

Ended run_in(const std::filesystem::path& folder, std::uint64_t first, std::uint64_t end, bool resume) {
  Ended ended;
  std::uint64_t passed = 0;
  RunOptions options;
  options.threads = 1;
  options.monitor.cancelled = [&] { return end > 0 && passed >= end; };
  options.checkpoints.folder = folder;
  options.checkpoints.resume = resume;
  options.checkpoints.due = [&] { return ++passed == first || passed == end; };
  options.checkpoints.tell = [&](const std::string& what) { ended.told += what + "\n"; };
  const Packing packing = run(plan(), options);
  ended.hash = hash_of(packing.spheres);
  ended.resumed = packing.resumed;
  return ended;
}

const std::filesystem::path latest = ".bernal-checkpoint/latest", before = ".bernal-checkpoint/before";

TEST(CheckpointFuzz, NothingThatStandsThereMakesADifference) {
  const testing::Folder folder;
  const std::string undisturbed = run_in(folder.path(), 0, 0, false).hash;
  run_in(folder.path(), 10, 20, false);
  const std::string last = testing::text_of(folder.path() / latest),
                    earlier = testing::text_of(folder.path() / before);
  const std::string others[] = {earlier};
  Random random(1, stream(Stream::test));
  const std::string_view tokens[] = {"bernal checkpoint 1\n", "\xff\xff\xff\xff\xff\xff\xff\xff", "relax",
                                     "=", "0"};
  for (std::size_t k = 0; k < testing::fuzz_inputs(150); ++k) {
    const bool both = testing::below(random, 2) == 1;
    const std::string changed = testing::mutated(last, tokens, random, others);
    folder.write(latest.string(), changed);
    folder.write(before.string(), both ? testing::mutated(earlier, tokens, random) : earlier);
    const Ended resumed = run_in(folder.path(), 0, 0, true);
    ASSERT_EQ(resumed.hash, undisturbed) << k;
    if (changed == last) continue;
    EXPECT_NE(resumed.told.find("passed over"), std::string::npos) << resumed.told;
    if (!both) {
      EXPECT_EQ(resumed.resumed, 1);
    }
  }
}

/// A checkpoint with the sum that belongs to it, which nobody but bernal writes, is still not taken for one
/// of another run.
TEST(CheckpointFuzz, AnEmptyOrStrangePlaceIsNone) {
  const testing::Folder folder;
  const std::string undisturbed = run_in(folder.path(), 0, 0, false).hash;
  std::filesystem::create_directories(folder.path() / latest);  // a folder in the place of the file
  const Ended resumed = run_in(folder.path(), 0, 0, true);
  EXPECT_EQ(resumed.hash, undisturbed);
  EXPECT_EQ(resumed.resumed, 0);
  EXPECT_NE(resumed.told.find("starts anew"), std::string::npos);
  // Nor can one be written there: the run goes on without, and says so once.
  const Ended hindered = run_in(folder.path(), 10, 0, false);
  EXPECT_EQ(hindered.hash, undisturbed);
}

TEST(CheckpointFuzz, WhatBelongsToAnotherRunIsRefused) {
  const testing::Folder folder;
  run_in(folder.path(), 10, 20, false);
  RunOptions options;
  options.checkpoints.folder = folder.path();
  options.checkpoints.resume = true;
  options.seed = 7;
  try {
    run(plan(), options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find("give ‹seed=1›"), std::string::npos) << error.what();
  }
  options.seed.reset();
  const Plan other = testing::plan_of(
      "[container]\nkind = \"periodic\"\n[spheres]\ncount = 61\nradius = 1.0\n[[stage]]\ndo = \"relax\"\n"
      "alpha = 2.0\n");
  EXPECT_THROW(run(other, options), Error);
  remove_checkpoints(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / ".bernal-checkpoint"));
  EXPECT_EQ(run(other, options).resumed, 0);
}

}  // namespace checkpoint_fuzz
}  // namespace bernal
