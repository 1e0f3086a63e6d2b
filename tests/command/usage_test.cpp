#include "check.hpp"

namespace bernal::testing {
namespace {

TEST(Usage, HelpNamesEverySubcommandWithExamples) {
  const Ended help = bernal({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.err, "");
  for (const std::string command :
       {"pack", "verify", "inspect", "explain", "measure", "predict", "design", "map", "reproduce"}) {
    EXPECT_NE(help.out.find("\n  " + command), std::string::npos) << command;
    const Ended own = bernal({command, "--help"});
    EXPECT_EQ(own.status, 0);
    EXPECT_GT(own.out.size(), 100u) << own.out;
    EXPECT_EQ(own.err, "");
  }
  EXPECT_NE(help.out.find("Examples:"), std::string::npos);
}

TEST(Usage, VersionIsOneLine) {
  const Ended version = bernal({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(version.out.starts_with("bernal ")) << version.out;
  EXPECT_EQ(std::ranges::count(version.out, '\n'), 1);
}

TEST(Usage, WrongOnesAreOneLineAndExitTwo) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", small_scene).string();
  const std::string out = (folder / "out").string();
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"pak"},
      {"--frobnicate"},
      {"pack"},
      {"pack", scene},
      {"pack", "-o", out},
      {"pack", scene, "-o", out, "--frobnicate"},
      {"pack", scene, "-o", out, "--threads", "0"},
      {"pack", scene, "-o", out, "--threads", "many"},
      {"pack", scene, "-o", out, "--threads", "-1"},
      {"pack", scene, "-o", out, "--seed", "-1"},
      {"pack", scene, "-o", out, "--seed", "1.5"},
      {"pack", scene, "-o", out, "--seed", "99999999999999999999"},
      {"pack", scene, "extra", "-o", out},
      {"verify"},
      {"explain"},
      {"explain", scene, "--jason"},
  };
  for (const auto& words : wrong) {
    std::string call;
    for (const std::string& word : words) call += word + " ";
    SCOPED_TRACE(call);
    expect_refused_in_one_line(bernal(words), {"see bernal", "--help"});
    EXPECT_EQ(std::filesystem::remove_all(out), 0u) << "something was written";
  }
}

}  // namespace
}  // namespace bernal::testing
