#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "bernal/measure/measure.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "support/starts.hpp"

// What result folders know of the spheres that they started from.
namespace bernal {
namespace start_in_files_test {

using namespace testing::starts;
using testing::error_of;

using StartInFiles = StartFixture;

TEST_F(StartInFiles, OfAResultFolderKnowsItsBox) {
  const Packing theirs = relaxed(3, 60);
  write_packing(theirs, folder / "theirs");
  const std::string from = "[container]\nkind = \"periodic\"\n[spheres]\nstart = \"theirs\"\n";
  const Packing again = packed(from + stage("relax"));
  expect_certified(again);
  EXPECT_EQ(again.spheres.r, theirs.spheres.r);
  EXPECT_NEAR(again.packing_fraction(), theirs.packing_fraction(), 1e-9);
  EXPECT_EQ(again.scene.start.file->filename(), "spheres.csv");
}

/// Whose files a run that was killed had not put into their places yet.
TEST_F(StartInFiles, OfAResultFolderIsTheLastResult) {
  namespace fs = std::filesystem;
  write_packing(relaxed(3, 60), folder / "before");
  write_packing(relaxed(3, 70), folder / "theirs");
  const fs::path placing = folder / "before" / ".bernal-placing";
  fs::rename(folder / "theirs", placing);
  std::ofstream(placing / ".replaced") << "scene.toml\nspheres.csv\n";
  fs::create_directory(placing / ".earlier");
  for (const char* name : {"scene.toml", "spheres.csv"})
    fs::rename(folder / "before" / name, placing / ".earlier" / name);
  const Packing again =
      packed("[container]\nkind = \"periodic\"\n[spheres]\nstart = \"before\"\n" + stage("relax"));
  EXPECT_EQ(again.spheres.size(), 70u);
}

/// The scene that a result carries makes it again, though it now says how large the box has become.
TEST_F(StartInFiles, IsStatedByTheSceneOfTheResult) {
  const Packing theirs = relaxed(3, 60);
  write("theirs.csv", theirs.spheres, 1.001);
  const Packing packing = packed(periodic_of(theirs, "scalable = true\n") +
                                 "[spheres]\nstart = \"theirs.csv\"\n" + stage("relax", "polish = 1e-6\n"));
  EXPECT_EQ(packing.scene.start.sha256.front().size(), 64u);
  EXPECT_EQ(packing.scene.start.box.size(), 3u);
  EXPECT_EQ(packing.scene.target.count, 60);
  write_packing(packing, folder / "out");
  const Scene written = read_scene(folder / "out" / "scene.toml");
  EXPECT_EQ(scene_as_toml(written), scene_as_toml(packing.scene));
  const Packing again = run(build(written), {.threads = 2});
  EXPECT_EQ(hash_of(again.spheres), hash_of(packing.spheres));

  std::ofstream(folder / "theirs.csv", std::ios::app) << "1,1,1,1\n";
  EXPECT_NE(std::string(error_of([&] { build(written); }).what()).find("is not the file that is meant"),
            std::string::npos);
  std::filesystem::remove(folder / "theirs.csv");
  const Packing read = read_packing(folder / "out");  // which is a packing without it, too
  expect_certified(read);
  EXPECT_FALSE(asked_radii_of(read.scene, read.spheres.size()).asked.sizes);
}

TEST_F(StartInFiles, IsCopiedWithTheFilesOfTheResult) {
  folder.write("two.csv", two);
  const Packing packing = packed(box + from_two + stage("insert"));
  write_packing(packing, folder / "out", {.with_mesh = true});
  std::filesystem::remove(folder / "two.csv");
  EXPECT_EQ(hash_of(run(build(read_scene(folder / "out" / "scene.toml")), {.threads = 1}).spheres),
            hash_of(packing.spheres));
}

TEST_F(StartInFiles, IsNotReplacedByTheResult) {
  const Packing theirs = relaxed(3, 60);
  write_packing(theirs, folder / "theirs");
  const Scene from = scene("[container]\nkind = \"periodic\"\n[spheres]\nstart = \"theirs\"\n");
  EXPECT_NE(
      std::string(error_of([&] { check_writable(folder / "theirs", from); }).what()).find("starts from"),
      std::string::npos);
  check_writable(folder / "other", from);
}

/// Nor by a detour: what a link leads to would be gone too.
TEST_F(StartInFiles, IsNotReplacedBehindALink) {
  const Packing theirs = relaxed(3, 60);
  write_packing(theirs, folder / "theirs");
  std::filesystem::create_symlink("theirs/spheres.csv", folder / "link.csv");
  std::filesystem::create_directory_symlink("theirs", folder / "link");
  for (const std::string start : {"link.csv", "link", "link/spheres.csv"}) {
    const Scene from = scene(periodic_of(theirs) + "[spheres]\nstart = \"" + start + "\"\n");
    for (const char* out : {"theirs", "link"})
      EXPECT_NE(std::string(error_of([&] { check_writable(folder / out, from); }).what()).find("starts from"),
                std::string::npos)
          << start << " " << out;
    check_writable(folder / "other", from);
  }
}

TEST_F(StartInFiles, IsWhatSizesAreComparedWith) {
  folder.write("two.csv", two);
  const Packing alone = packed(box + from_two + stage("insert"));
  SceneRadii radii = asked_radii_of(alone.scene, 2);
  SizeComparison sizes = *measure(alone.spheres, alone.domain, radii.asked).sizes;
  EXPECT_EQ(sizes.ks_statistic, 0);
  EXPECT_EQ(sizes.drawn->missing, 0u);
  const Packing more = packed(
      box + from_two +
      "count = 202\nradius = { distribution = \"uniform\", min = 0.1, max = 0.3 }\ndraw = \"quantiles\"\n" +
      stage("insert"));
  ASSERT_EQ(more.spheres.size(), 202u);
  radii = asked_radii_of(more.scene, 202);
  sizes = *measure(more.spheres, more.domain, radii.asked).sizes;
  EXPECT_EQ(sizes.drawn->missing, 0u);
  EXPECT_LT(sizes.ks_statistic, 0.02);  // quantiles
  EXPECT_NEAR(sizes.volume_ratio, 1, 0.01);
}

TEST_F(StartInFiles, ThatIsStoppedIsStillCertified) {
  const Packing theirs = relaxed(3, 100);
  write("over.csv", theirs.spheres, 1.05);
  const Plan plan = build(scene(periodic_of(theirs, "scalable = true\n") +
                                "[spheres]\nstart = \"over.csv\"\n" + stage("relax", "polish = 1e-6\n")));
  for (const int after : {0, 3, 30}) {
    int polls = 0;
    RunOptions options;
    options.threads = 1;
    options.monitor.cancelled = [&] { return ++polls > after; };
    const Packing packing = run(plan, options);
    EXPECT_EQ(packing.outcome, Outcome::cancelled);
    EXPECT_EQ(packing.spheres.size(), 100u);
    expect_certified(packing);
  }
}

TEST_F(StartInFiles, OfAResultFolderHasItsTilt) {
  const std::string five = "[spheres]\ncount = 5\nradius = 0.5\n" + stage("relax"), upright = periodic(8),
                    tilted = periodic(8, "tilt = [2.0, 0.0, 1.0]\n");
  write_packing(packed(upright + five), folder / "upright");
  write_packing(packed("unit = \"mm\"\n" + tilted + five), folder / "tilted");
  EXPECT_NE(refusal(tilted + "[spheres]\nstart = \"upright\"\n" + stage("relax"))
                .find("the box of the start is upright, and the container is tilted"),
            std::string::npos);
  // In the unit of the scene.
  EXPECT_NE(refusal("unit = \"cm\"\n" + periodic(0.8) + "[spheres]\nstart = \"tilted\"\n" + stage("relax"))
                .find("tilted otherwise than the container: 0.2, 0, 0.1; give"),
            std::string::npos);
}

}  // namespace start_in_files_test
}  // namespace bernal
