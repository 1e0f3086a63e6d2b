#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "check.hpp"

namespace bernal::testing {
namespace bench_test {

TEST(BenchCommand, PrintsATableOrWritesIt) {
  const Ended printed = bernal({"bench", "predict", "fly", "--spheres", "200", "--quiet"});
  EXPECT_EQ(printed.status, 0) << printed.err;
  EXPECT_TRUE(printed.out.starts_with("| bench |")) << printed.out;
  EXPECT_NE(printed.out.find("| fly |"), std::string::npos) << printed.out;
  EXPECT_NE(printed.out.find("| predict |"), std::string::npos) << printed.out;
  EXPECT_EQ(printed.out.find("| relax |"), std::string::npos) << "names select";

  const Folder folder;
  const std::string out = (folder.path() / "new").string();
  const Ended written = bernal({"bench", "fly", "--spheres", "200", "-o", out});
  EXPECT_EQ(written.status, 0) << written.err;
  EXPECT_EQ(written.out, out + "/bench.md\n" + out + "/bench.csv\n");
  EXPECT_TRUE(text_of(out + "/bench.csv").starts_with("bench,"));
  // Its own tables it replaces, and what somebody else wrote is kept.
  std::ofstream(out + "/bench.md") << "a bench in the garden\n";
  EXPECT_EQ(bernal({"bench", "fly", "--spheres", "200", "-o", out}).status, 0);
  EXPECT_EQ(text_of(out + "/bench.md.kept"), "a bench in the garden\n");
  EXPECT_FALSE(std::filesystem::exists(out + "/bench.csv.kept"));
}

TEST(BenchCommand, RefusesAbsurdInputInOneLine) {
  const Folder folder;
  expect_refused_in_one_line(bernal({"bench", "relx"}), {"relx", "did you mean \"relax\""});
  expect_refused_in_one_line(bernal({"bench", "fly", "--spheres", "0"}), {"--spheres"});
  expect_refused_in_one_line(bernal({"bench", "fly", "-o", "/proc/none"}), {"/proc/none"});
}

TEST(BenchCommand, StopsWithNothingHalfWritten) {
  const Folder folder;
  const Process bench = start_bernal({"bench", "methods", "--spheres", "2000", "-o", folder.path().string()});
  while (bench.said().find("run ") == std::string::npos) usleep(50'000);
  bench.signal(SIGINT);
  const Ended ended = bench.wait();
  EXPECT_EQ(ended.status, 3);
  EXPECT_EQ(ended.out, "");
  EXPECT_NE(ended.err.find("nothing is written"), std::string::npos) << ended.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace bench_test
}  // namespace bernal::testing
