// Trials of scenes: what is measured is what the run wrote, is kept, and is not measured again.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/soft/relax.hpp"
#include "bernal/verify/certificate.hpp"
#include "cost/rounds.hpp"
#include "support/folder.hpp"
#include "support/outdated_trials.hpp"

namespace bernal::cost_rounds_test {
namespace {

using namespace cost;

Scene box_of(int count, double alpha, double overlap = 0) {
  Scene scene;
  scene.container = PeriodicBox{};
  scene.sizes = Constant{1};
  scene.target.count = count;
  scene.overlap = overlap;
  scene.stages = {Relax{.alpha = alpha, .stop = 1e-3}};
  complete(scene);
  return scene;
}

TEST(Trial, SaysOfARunWhatTheRunSaysOfItself) {
  const Scene scene = box_of(200, 3);
  const Trial trial = run_trial(scene, {.seed = 7, .threads = 1});
  const Packing packing = run(build(scene), {7, 1, {}});
  EXPECT_EQ(trial.hash, hash_of(packing.spheres));
  EXPECT_EQ(trial.spheres, 200u);
  EXPECT_EQ(trial.packing_fraction, packing.packing_fraction());
  EXPECT_TRUE(trial.certified);
  EXPECT_EQ(trial.outcome, Outcome::converged);
  EXPECT_LE(trial.early_overlap, 1e-3) << "relaxation ends at its stop";
  EXPECT_GT(trial.early_overlap, 0);
  EXPECT_GT(trial.cpu_seconds, 0);
  ASSERT_TRUE(trial.held_from);
  ASSERT_TRUE(trial.peak_bytes) << "Linux tells";
  EXPECT_LT(*trial.peak_bytes, 1e9);
  EXPECT_FALSE(trial.effects.empty());
}

// Shrunk by the overlap that it finds, the same packing overlaps nowhere: so the fraction that counts is that
// of spheres that do not overlap.
TEST(Trial, CountsOnlyWhatDoesNotOverlap) {
  const Scene scene = box_of(200, 3, 0.01);
  const Trial trial = run_trial(scene, {.seed = 7, .threads = 1});
  Packing packing = run(build(scene), {7, 1, {}});
  ASSERT_GT(trial.max_overlap, 0) << "nothing was left to shrink";
  for (double& r : packing.spheres.r) r *= 1 - trial.max_overlap * (1 + 1e-9);
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
  EXPECT_NEAR(trial.packing_fraction, packing_fraction(packing.spheres, packing.domain), 1e-8);
}

TEST(Trial, IsCutOffAtItsLimit) {
  const Trial trial = run_trial(box_of(20000, 1000), {.seed = 1, .threads = 1, .limit = 0.2});
  EXPECT_TRUE(trial.cut_off);
  EXPECT_EQ(trial.outcome, Outcome::cancelled);
  EXPECT_LT(trial.seconds, 5);
}

// A pair that overlaps by some ratio says nothing of contacts that are closed further.
TEST(Trial, HoldsFromNoGapThatIsSmallerThanTheOverlapsThatAreLeft) {
  const Trial trial = run_trial(box_of(200, 3, 0.01), {.seed = 7, .threads = 1});
  ASSERT_GT(trial.max_overlap, 1e-6);
  if (trial.held_from) {
    EXPECT_GE(*trial.held_from, trial.max_overlap);
  }
}

std::vector<Setting> three_settings() {
  return {{"a", box_of(60, 1)}, {"b, \"quoted\"", box_of(60, 2)}, {"c", box_of(60, 3)}};
}

TEST(Rounds, MakeEveryTrialOnceAndKeepIt) {
  const testing::Folder folder;
  const auto file = folder.path() / "trials.csv";
  const auto settings = three_settings();
  const RoundOptions options{.seeds = {3, 4}, .threads = 1};
  TrialRecord record(file);
  const Rounds first = interleaved(settings, record, options);
  EXPECT_EQ(first.made, 6u);
  EXPECT_FALSE(first.out_of_time);

  TrialRecord again(file);
  EXPECT_EQ(again.size(), 6u);
  const Rounds second = interleaved(settings, again, options);
  EXPECT_EQ(second.made, 0u);
  for (std::size_t k = 0; k < settings.size(); ++k) {
    ASSERT_EQ(second.series[k].trials.size(), 2u);
    for (std::size_t s = 0; s < 2; ++s) {
      const Trial &made = first.series[k].trials[s], &read = second.series[k].trials[s];
      EXPECT_EQ(made.seed, options.seeds[s]);
      EXPECT_EQ(made.packing_fraction, read.packing_fraction);
      EXPECT_EQ(made.cpu_seconds, read.cpu_seconds);
      EXPECT_EQ(made.hash, read.hash);
      EXPECT_EQ(made.reason, read.reason);
      EXPECT_EQ(made.held_from, read.held_from);
      EXPECT_EQ(made.peak_bytes, read.peak_bytes);
      ASSERT_EQ(made.effects.size(), read.effects.size());
      EXPECT_EQ(made.effects.back().name, read.effects.back().name);
      EXPECT_EQ(made.effects.back().calls, read.effects.back().calls);
    }
  }
  // Another seed, another number of threads and another scene are other trials.
  EXPECT_EQ(again.find(settings[0], 5, 1), nullptr);
  EXPECT_EQ(again.find(settings[0], 3, 2), nullptr);
  EXPECT_EQ(again.find({"a", box_of(61, 1)}, 3, 1), nullptr);
  EXPECT_NE(again.find({"another name", settings[0].scene}, 3, 1), nullptr);
}

TEST(Rounds, GoOnWhereTheyWereStoppedAndWhereALineWasCut) {
  const testing::Folder folder;
  const auto file = folder.path() / "trials.csv";
  const auto settings = three_settings();
  {
    TrialRecord record(file);
    int asked = 0;
    const Monitor monitor{{}, [&] { return ++asked > 40; }};
    const Rounds rounds = interleaved(settings, record, {.seeds = {3}, .threads = 1, .monitor = monitor});
    EXPECT_TRUE(rounds.cancelled);
    EXPECT_LT(rounds.made, 3u);
  }
  std::ofstream(file, std::ios::app) << "0123456789abcdef,\"a\",3,1,conv";
  TrialRecord record(file);
  const std::size_t kept = record.size();
  const Rounds rest = interleaved(settings, record, {.seeds = {3}, .threads = 1});
  EXPECT_EQ(rest.made, 3 - kept);
  EXPECT_EQ(TrialRecord(file).size(), 3u);
}

TEST(Rounds, KeepToTheirBudget) {
  const testing::Folder folder;
  TrialRecord record(folder.path() / "trials.csv");
  const std::vector<Setting> settings = {{"a", box_of(20000, 500)}, {"b", box_of(20000, 600)}};
  const Stopwatch watch;
  const Rounds rounds = interleaved(settings, record, {.seeds = {1, 2}, .threads = 1, .budget = 0.3});
  EXPECT_TRUE(rounds.out_of_time);
  EXPECT_LE(rounds.made, 2u);
  EXPECT_LT(watch.seconds(), 10);
}

// That something is slower than an unfairly short time is not known of it, and it is tried again.
TEST(Rounds, ForgetWhatHadNoFairTry) {
  const testing::Folder folder;
  TrialRecord record(folder.path() / "trials.csv");
  const std::vector<Setting> settings = {{"slow", box_of(20000, 500)}, {"quick", box_of(60, 1)}};
  RoundOptions options{.seeds = {1, 2}, .threads = 1, .limit = 0.1, .fair = 100};
  const Rounds rounds = interleaved(settings, record, options);
  EXPECT_TRUE(rounds.series[0].unfair);
  EXPECT_TRUE(rounds.series[0].trials.empty());
  EXPECT_EQ(rounds.series[1].trials.size(), 2u) << "the others go on";
  EXPECT_EQ(record.size(), 2u);
  options.fair = 0.05;
  EXPECT_TRUE(interleaved(settings, record, options).series[0].trials.front().cut_off);
}

TEST(Rounds, RefuseARecordThatIsNone) {
  const testing::Folder folder;
  const auto file = folder.path() / "trials.csv";
  for (const std::string text : {"x,y,z,r\n0,0,0,1\n", "a note of somebody", "x,y\n"}) {
    std::ofstream(file) << text;
    EXPECT_THROW(TrialRecord{file}, Error);
    EXPECT_THROW(TrialRecord(file, true), Error) << "neither afresh";
    EXPECT_EQ(testing::text_of(file), text);
  }
}

TEST(Rounds, RefuseNumbersThatNoRunGives) {
  const testing::Folder folder;
  const auto file = folder.path() / "trials.csv";
  {
    TrialRecord record(file);
    interleaved({{"a", box_of(60, 1)}}, record, {.seeds = {3}, .threads = 1});
    record.add_file("cost.md", "0123");
  }
  const std::string good = testing::text_of(file);
  EXPECT_TRUE(TrialRecord(file).names_file("cost.md", "0123"));
  EXPECT_FALSE(TrialRecord(file).names_file("cost.md", "3210"));
  const std::size_t line = good.find('\n') + 1;
  std::vector<std::size_t> commas;
  bool inside = false;
  for (std::size_t k = line; k < good.size() && good[k] != '\n'; ++k) {
    if (good[k] == '"') inside = !inside;
    if (good[k] == ',' && !inside) commas.push_back(k);
  }
  const auto with = [&](std::size_t column, const std::string& cell) {
    const std::string changed = good.substr(line, commas[column - 1] + 1 - line) + cell +
                                good.substr(commas[column], commas.back() + 1 - commas[column]);
    const std::string rest = good.substr(good.find('\n', commas.back()));
    return good.substr(0, line) + changed + hash_of_text(changed) + rest;  // sealed as if a run had given it
  };
  const std::size_t phi = 9, cpu_seconds = 23;
  for (const auto& [column, cell] : {std::pair(phi, "7"), std::pair(phi, "nan"), std::pair(phi, "-0.1"),
                                     std::pair(cpu_seconds, "inf"), std::pair(cpu_seconds, "-1")}) {
    std::ofstream(file) << with(column, cell);
    try {
      TrialRecord record(file);
      ADD_FAILURE() << cell;
    } catch (const Error& error) {
      EXPECT_EQ(error.location().line, 2) << cell;
    }
  }
  std::string changed = good;  // by one digit, a figure that may be
  char& digit = changed[commas[phi - 1] + 3];
  digit = digit == '5' ? '6' : '5';
  std::ofstream(file) << changed;
  try {
    TrialRecord record(file);
    ADD_FAILURE() << "a figure that somebody changed is believed";
  } catch (const Error& error) {
    EXPECT_EQ(error.location().line, 2);
    EXPECT_NE(std::string(error.what()).find("remove it"), std::string::npos) << error.what();
  }
  std::ofstream(file) << good;
  EXPECT_EQ(TrialRecord(file).size(), 1u);
  EXPECT_EQ(TrialRecord(file, true).size(), 0u);
  EXPECT_TRUE(TrialRecord(file).names_file("cost.md", "0123")) << "what was written stays known";
}

// Seconds of another version of the same packings are kept, those of other packings are made anew.
TEST(Rounds, MakeTrialsOfOtherPackingsAnew) {
  const testing::Folder folder;
  const auto file = folder.path() / "trials.csv";
  const auto settings = three_settings();
  const RoundOptions options{.seeds = {3}, .threads = 1};
  {
    TrialRecord record(file);
    interleaved(settings, record, options);
  }
  ASSERT_EQ(testing::let_trials_be_of(packings_number() - 1, file, 3, "\"a\""), 1)
      << "the first of them alone";
  TrialRecord record(file);
  EXPECT_EQ(record.size(), 2u);
  ASSERT_EQ(record.outdated(), 1u);
  EXPECT_EQ(record.packings_of_outdated(), packings_number() - 1);
  EXPECT_EQ(record.find(settings[0], 3, 1), nullptr);
  EXPECT_EQ(interleaved(settings, record, options).made, 1u);
  EXPECT_EQ(TrialRecord(file).outdated(), 0u) << "it was made anew";
  EXPECT_EQ(TrialRecord(file).size(), 3u);
}

// In a folder of somebody else.
TEST(Rounds, WriteThroughNoLinkAndWaitForNoPipe) {
  const testing::Folder folder;
  const auto file = folder.path() / "trials.csv";
  std::filesystem::create_symlink("elsewhere", file);
  EXPECT_THROW(TrialRecord{file}, Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "elsewhere"));
  std::filesystem::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_THROW(TrialRecord{file}, Error);
}

TEST(Spread, IsTheMedianAndHalfTheRange) {
  EXPECT_EQ(spread_of({3, 1, 2}).median, 2);
  EXPECT_EQ(spread_of({3, 1, 2}).half_width, 1);
  EXPECT_EQ(spread_of({4, 1}).median, 2.5);
  EXPECT_EQ(spread_of({5}).half_width, 0);
}

}  // namespace
}  // namespace bernal::cost_rounds_test
