#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

#include "bernal/core/error.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/version.hpp"
#include "run/checkpoint_owner.hpp"
#include "support/folder.hpp"
#include "support/fuzz.hpp"
#include "support/plans.hpp"
#include "work/checkpoint_folder.hpp"

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

/// What `run` says where it refuses to go on; empty where it does not.
std::string refusal_in(const std::filesystem::path& folder) {
  try {
    run_in(folder, 0, 0, true);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    return error.what();
  }
}

/// Leaves the latest checkpoint as if another program had written it, with another end where that is given:
/// only what it says of that, and its sum, are others.
void disguise(const std::filesystem::path& folder, const Program& as, const std::string& end = "") {
  CheckpointOwner owner = checkpoint_owner(plan().scene, plan().scene.seed);
  std::string head = "bernal checkpoint 3\n";
  head += '\0';
  ArchiveToBytes rest(head);
  rest(owner);
  std::string state = testing::text_of(folder / latest);
  ASSERT_TRUE(state.starts_with(head));
  state = state.substr(head.size(), state.size() - head.size() - 2 * sizeof(std::uint64_t));
  state.replace(state.size() - end.size(), end.size(), end);
  owner.program = as;
  CheckpointFolder(folder).write(owner, [&](Archive& archive) {
    for (char& byte : state) archive(byte);
  });
}

TEST(CheckpointOfAnotherBernal, GoesOnWhereItPacksTheSame) {
  const testing::Folder folder;
  const std::string undisturbed = run_in(folder.path(), 0, 0, false).hash;
  run_in(folder.path(), 10, 20, false);
  disguise(folder.path(), {"9.8.7", "0123456789ab", packings_number()});
  const Ended resumed = run_in(folder.path(), 0, 0, true);
  EXPECT_EQ(resumed.hash, undisturbed);
  EXPECT_EQ(resumed.resumed, 1) << resumed.told;
}

TEST(CheckpointOfAnotherBernal, IsRefusedWhereItPacksOtherwise) {
  const testing::Folder folder;
  run_in(folder.path(), 10, 20, false);
  disguise(folder.path(), {"0.1.9", "0123456789ab", packings_number() - 1});
  const std::string kept = testing::text_of(folder.path() / latest);
  const std::string refused = refusal_in(folder.path());
  for (const std::string& said :
       {"0.1.9 (packings " + std::to_string(packings_number() - 1) + ", commit 0123456789ab)",
        text_of(this_program()), std::string("leave ‹resume› out")})
    EXPECT_NE(refused.find(said), std::string::npos) << refused;
  EXPECT_EQ(testing::text_of(folder.path() / latest), kept);
}

/// With the same packings number, but a state with other members.
TEST(CheckpointOfAnotherBernal, IsRefusedWhereItsStateHasAnotherLayout) {
  const testing::Folder folder;
  run_in(folder.path(), 10, 20, false);
  disguise(folder.path(), {"9.8.7", "0123456789ab", packings_number()}, std::string(8, '\7'));
  const std::string refused = refusal_in(folder.path());
  EXPECT_NE(refused.find("of bernal 9.8.7 "), std::string::npos) << refused;
  EXPECT_NE(refused.find("keeps other things of a run"), std::string::npos) << refused;
}

/// Of version 0.1, which did not count packings.
TEST(CheckpointOfAnotherBernal, IsRefusedWhereItIsOfAnEarlierFormat) {
  const testing::Folder folder;
  std::string file = "bernal checkpoint 2\n";
  file.resize(64);
  std::uint64_t end[] = {file.size(), 0x243F6A8885A308D3u};
  for (std::size_t at = 0; at < file.size(); at += sizeof end[1]) {
    std::uint64_t word = 0;
    std::memcpy(&word, &file[at], sizeof word);
    end[1] = std::rotl((end[1] ^ word) * 0x9E3779B97F4A7C15u, 32);
  }
  file.append(reinterpret_cast<const char*>(end), sizeof end);
  std::filesystem::create_directories((folder.path() / latest).parent_path());
  folder.write(latest.string(), file);
  const std::string refused = refusal_in(folder.path());
  EXPECT_NE(refused.find("of bernal 0.1, which did not count its packings yet, and this is " +
                         text_of(this_program())),
            std::string::npos)
      << refused;
}

/// From its beginning, not only once it has written a checkpoint.
TEST(CheckpointFolder, IsThatOfTheRunWhichIsAtWorkInIt) {
  const testing::Folder folder;
  {
    CheckpointFolder first(folder.path());
    ASSERT_TRUE(first.claim());
    EXPECT_NE(refusal_in(folder.path()).find("another run is at work"), std::string::npos);
    const Ended second = run_in(folder.path(), 10, 20, false);
    EXPECT_NE(second.told.find("another run is at work"), std::string::npos) << second.told;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / latest));
  }
  EXPECT_FALSE(std::filesystem::exists((folder.path() / latest).parent_path())) << "nothing was left in it";
  EXPECT_EQ(refusal_in(folder.path()), "");
}

}  // namespace checkpoint_fuzz
}  // namespace bernal
