// Folders of somebody else, and what a killed run has left in one's own.
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "check.hpp"

namespace bernal::testing {
namespace unpublished_command_test {

namespace fs = std::filesystem;

/// All that stands below a folder: the texts of files, where links lead, what is a pipe.
std::map<std::string, std::string> everything_in(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    all[entry.path().lexically_relative(folder)] = entry.is_symlink()
                                                       ? fs::read_symlink(entry.path()).string()
                                                   : entry.is_regular_file() ? text_of(entry.path())
                                                                             : "no file";
  return all;
}

class FolderOfSomebody : public ::testing::Test {
 protected:
  Folder folder;
  const std::string scene = folder.write("small.toml", small_scene).string(),
                    there = (folder / "theirs").string();

  void SetUp() override {
    ASSERT_EQ(bernal({"pack", scene, "-o", there, "--quiet", "--no-view"}).status, 0);
    fs::create_directory(folder / "home");
    folder.write("home/bashrc", "precious");
  }
  /// What a run seems to have left there, and a link that leads out.
  void lay_snare(const std::string& left) const {
    fs::create_directories(fs::path(there) / left / "sub");
    std::ofstream(fs::path(there) / left / ".replaced") << "sub/bashrc\n";
    std::ofstream(fs::path(there) / left / "sub/bashrc") << "evil";
    fs::create_directory_symlink("../home", fs::path(there) / "sub");
  }
  /// Every command that only reads a result.
  void read_all() const {
    const std::string start = folder
                                  .write("start.toml",
                                         "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [10, 10, "
                                         "10]\n[spheres]\nstart = \"theirs\"\n[[stage]]\ndo = "
                                         "\"relax\"\n")
                                  .string();
    EXPECT_EQ(bernal({"verify", there}).status, 0);
    EXPECT_EQ(bernal({"measure", there}).status, 0);
    EXPECT_EQ(bernal({"measure", there, "--section", "z = 5", "-o", (folder / "cut.svg").string()}).status,
              0);
    EXPECT_EQ(
        bernal({"export", there, "--to", "lammps", "-o", (folder / "bed.data").string(), "--quiet"}).status,
        0);
    EXPECT_EQ(bernal({"explain", start}).status, 0);
  }
};

TEST_F(FolderOfSomebody, IsReadAndNothingElse) {
  for (const char* left : {".bernal-complete", ".bernal-placing"}) {
    lay_snare(left);
    const auto before = everything_in(folder / "theirs"), home = everything_in(folder / "home");
    read_all();
    EXPECT_EQ(everything_in(folder / "theirs"), before) << left;
    EXPECT_EQ(everything_in(folder / "home"), home) << left;
    EXPECT_NE(bernal({"verify", there}).err.find("nothing was moved"), std::string::npos);
    fs::remove_all(fs::path(there) / left);
    fs::remove(fs::path(there) / "sub");
  }
}

TEST_F(FolderOfSomebody, IsNotPackedIntoThroughItsLinks) {
  for (const char* left : {".bernal-complete", ".bernal-placing"}) {
    lay_snare(left);
    const auto before = everything_in(folder / "theirs"), home = everything_in(folder / "home");
    expect_refused(bernal({"pack", scene, "-o", there, "--quiet", "--no-view"}),
                   {"cannot be put into its place", "sub: is in the way"});
    EXPECT_EQ(everything_in(folder / "theirs"), before) << left;
    EXPECT_EQ(everything_in(folder / "home"), home) << left;
    fs::remove_all(fs::path(there) / left);
    fs::remove(fs::path(there) / "sub");
  }
}

TEST_F(FolderOfSomebody, HoldsPipesThatNobodyWaitsFor) {
  fs::create_directory(fs::path(there) / ".bernal-placing");
  ASSERT_EQ(mkfifo((there + "/.bernal-placing/.replaced").c_str(), 0600), 0);
  const auto before = everything_in(folder / "theirs");
  read_all();
  EXPECT_EQ(everything_in(folder / "theirs"), before);
  for (const char* name : {"report.json", "spheres.vtp", "spheres.csv", "scene.toml"}) {
    fs::remove(there + "/" + name);
    ASSERT_EQ(mkfifo((there + "/" + name).c_str(), 0600), 0);
    const Ended ended = bernal({"verify", there});
    EXPECT_EQ(ended.status, std::string(name).starts_with("s") && !std::string(name).ends_with("vtp") ? 2 : 0)
        << name << ended.err;
  }
}

// The new result, although the earlier one is still in its place.
TEST_F(FolderOfSomebody, IsReadAsWhatItWillBe) {
  const std::string fresh = (folder / "fresh").string();
  ASSERT_EQ(bernal({"pack", scene, "--seed", "7", "-o", fresh, "--quiet", "--no-view"}).status, 0);
  const auto hash = report_of(fresh)["hash"];
  ASSERT_NE(report_of(there)["hash"], hash);
  std::string replaced;
  for (const auto& entry : fs::directory_iterator(there)) replaced += entry.path().filename().string() + "\n";
  fs::rename(fresh, there + "/.bernal-complete");
  std::ofstream(there + "/.bernal-complete/.replaced") << replaced;
  const auto before = everything_in(there);
  const Ended verified = bernal({"verify", there});
  EXPECT_EQ(verified.status, 0);
  EXPECT_NE(verified.err.find("a run was killed"), std::string::npos) << verified.err;
  EXPECT_EQ(everything_in(there), before);
  const std::string spheres = text_of(there + "/.bernal-complete/spheres.csv");
  EXPECT_EQ(bernal({"pack", scene, "--seed", "9", "-o", there, "--quiet", "--no-view"}).status, 0);
  EXPECT_FALSE(fs::exists(there + "/.bernal-complete"));
  EXPECT_NE(text_of(there + "/spheres.csv"), spheres) << "and then the next run's";
}

}  // namespace unpublished_command_test
}  // namespace bernal::testing
