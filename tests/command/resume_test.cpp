#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "check.hpp"

namespace bernal::testing {
namespace resume_test {

constexpr const char* long_scene = R"([container]
kind = "periodic"
[spheres]
count = 20000
radius = 1
[[stage]]
do = "relax"
alpha = 30
)";

/// Runs it until there is a checkpoint, and ends it by that signal.
Ended ended_by(int signal, const std::string& scene, const std::filesystem::path& out) {
  const Process run = start_bernal({"pack", scene, "-o", out, "--checkpoint-every", "0.01"});
  while (!std::filesystem::exists(out / ".bernal-checkpoint" / "before") && run.listens_to(SIGTERM))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  run.signal(signal);
  return run.wait();
}

TEST(Resume, GoesOnAfterASignalToTheSameSpheres) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", long_scene);
  ASSERT_EQ(bernal({"pack", scene, "-o", folder / "whole"}).status, 0);
  for (const int signal : {SIGTERM, SIGINT, SIGKILL}) {
    const std::filesystem::path out = folder / ("out" + std::to_string(signal));
    const Ended ended = ended_by(signal, scene, out);
    ASSERT_EQ(ended.status, signal == SIGKILL ? 128 + SIGKILL : 3) << ended.err;
    EXPECT_EQ(std::filesystem::exists(out / "report.json"), signal != SIGKILL);
    if (signal != SIGKILL) {
      EXPECT_EQ(report_of(out)["outcome"], "cancelled");
      EXPECT_EQ(bernal({"verify", out}).status, 0);
    }
    const Ended resumed = bernal({"pack", scene, "-o", out, "--resume", "--threads", "1"});
    EXPECT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_NE(resumed.err.find("going on from the checkpoint"), std::string::npos) << resumed.err;
    EXPECT_EQ(report_of(out)["hash"], report_of(folder / "whole")["hash"]);
    EXPECT_EQ(report_of(out)["resumed"], 1);
    EXPECT_FALSE(std::filesystem::exists(out / ".bernal-checkpoint"));
  }
  EXPECT_EQ(report_of(folder / "whole")["resumed"], 0);
}

/// `timeout` sends its signal to the command and to the group that this is in.
TEST(Resume, ASignalThatComesTwiceAtOnceIsOne) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", long_scene);
  const std::filesystem::path out = folder / "out";
  const Process run = start_bernal({"pack", scene, "-o", out, "--threads", "1"});
  ASSERT_TRUE(run.listens_to(SIGTERM));
  for (int k = 0; k < 20; ++k) {
    run.signal(SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(run.wait().status, 3);
  EXPECT_EQ(report_of(out)["outcome"], "cancelled");
}

TEST(Resume, GoesOnWithoutFurtherCheckpoints) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", long_scene);
  ASSERT_EQ(ended_by(SIGKILL, scene, folder / "out").status, 128 + SIGKILL);
  const Ended resumed = bernal({"pack", scene, "-o", folder / "out", "--resume", "--checkpoint-every", "0"});
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_EQ(report_of(folder / "out")["resumed"], 1);
}

TEST(Resume, StartsAnewWhereThereIsNothingAndSaysSo) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", small_scene);
  const Ended packed = bernal({"pack", scene, "-o", folder / "out", "--resume"});
  EXPECT_EQ(packed.status, 0) << packed.err;
  EXPECT_NE(packed.err.find("it starts anew"), std::string::npos) << packed.err;
}

TEST(Resume, RefusesWhatBelongsToAnotherRunAndTouchesNothing) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", long_scene);
  const std::filesystem::path out = folder / "out";
  ended_by(SIGKILL, scene, out);
  const std::string kept = text_of(out / ".bernal-checkpoint" / "latest");
  expect_refused(bernal({"pack", scene, "-o", out, "--resume", "--seed", "2"}), {"--seed 1"});
  const std::string other = folder.write("other.toml", std::string(long_scene) + "beta = 40\n");
  expect_refused(bernal({"pack", other, "-o", out, "--resume"}), {"another scene", "--resume"});
  EXPECT_EQ(text_of(out / ".bernal-checkpoint" / "latest"), kept);
  // Without --resume the checkpoint is in nobody's way, and told of.
  const std::string small = folder.write("small.toml", small_scene);
  const Ended anew = bernal({"pack", small, "-o", out});
  EXPECT_EQ(anew.status, 0);
  EXPECT_NE(anew.err.find("left a checkpoint"), std::string::npos) << anew.err;
  EXPECT_FALSE(std::filesystem::exists(out / ".bernal-checkpoint"));
}

/// The first has written no checkpoint yet, and will not for long.
TEST(Resume, RefusesASecondRunFromTheBeginningOfTheFirst) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", long_scene);
  const std::filesystem::path out = folder / "out";
  const Process first = start_bernal({"pack", scene, "-o", out, "--checkpoint-every", "1000"});
  while (!std::filesystem::exists(out / ".bernal-checkpoint") && first.listens_to(SIGTERM))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  // The folder is locked a moment after it is made.
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  expect_refused(bernal({"pack", scene, "-o", out, "--resume"}), {"another run is at work", "out"});
  EXPECT_FALSE(std::filesystem::exists(out / ".bernal-checkpoint" / "latest"));
  first.signal(SIGTERM);
  EXPECT_EQ(first.wait().status, 3);
}

}  // namespace resume_test
}  // namespace bernal::testing
