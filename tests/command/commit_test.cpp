#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/folder.hpp"

// Where bernal::commit comes from: git, or what `git archive` has written into cmake/commit.
namespace bernal::testing {
namespace commit_test {

namespace fs = std::filesystem;

bool runs(const std::string& command) {
  return std::system(("(" + command + ") >/dev/null 2>&1").c_str()) == 0;
}

class Commit : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!runs("git --version") || !runs("cmake --version")) GTEST_SKIP() << "needs git and cmake";
    fs::create_directories(source_ / "cmake");
    for (const char* file : {"cmake/write_commit.cmake", ".gitattributes"})
      fs::copy_file(fs::path(BERNAL_SOURCE) / file, source_ / file);
    folder_.write("source/cmake/commit", "$Format:%H$\n");  // which in an archive is the commit
  }

  bool git(const std::string& words) const {
    return runs("cd '" + source_.string() + "' && git -c user.name=a -c user.email=a@b " + words);
  }
  /// What a build of that source would say.
  std::string said(const fs::path& source) const {
    const fs::path to = folder_ / "commit.cpp";
    EXPECT_TRUE(runs("cmake -D SOURCE='" + source.string() + "' -D TO='" + to.string() + "' -P '" +
                     (source / "cmake/write_commit.cmake").string() + "'"));
    const std::string text = text_of(to);
    const std::size_t first = text.find("return \"") + 8;
    return text.substr(first, text.find('"', first) - first);
  }

  /// Makes a repository of the source, and says what a build would of its first commit.
  std::string committed() const {
    EXPECT_TRUE(git("init") && git("add .") && git("commit -m first"));
    return said(source_);
  }

  Folder folder_;
  fs::path source_ = folder_ / "source";
};

TEST_F(Commit, IsUnknownWhereNothingSaysIt) {
  EXPECT_EQ(said(source_), "unknown");
  fs::remove(source_ / "cmake/commit");
  EXPECT_EQ(said(source_), "unknown");
  // The git of a folder around it is that of somebody else.
  source_ = folder_.path();
  ASSERT_TRUE(git("init") && git("add .") && git("commit -m around"));
  EXPECT_EQ(said(folder_ / "source"), "unknown");
}

TEST_F(Commit, IsThatOfGitAndSaysChanges) {
  ASSERT_TRUE(git("init"));
  EXPECT_EQ(said(source_), "unknown") << "there is no commit yet";
  ASSERT_TRUE(git("add .") && git("commit -m first"));
  const std::string commit = said(source_);
  ASSERT_TRUE(runs("cd '" + source_.string() + "' && git rev-parse HEAD | grep '^" + commit + "'"));
  EXPECT_EQ(commit.size(), 12u);
  folder_.write("source/note", "which git does not know");
  EXPECT_EQ(said(source_), commit);
  folder_.write("source/cmake/commit", "changed");
  EXPECT_EQ(said(source_), commit + "+changes");
}

TEST_F(Commit, SourcesThatGitDoesNotKnowAreChangesToo) {
  const std::string commit = committed();
  fs::create_directories(source_ / "src");
  folder_.write("source/src/new.cpp", "");
  EXPECT_EQ(said(source_), commit + "+changes");
}

TEST_F(Commit, IsInAnArchiveOfTheSource) {
  const std::string commit = committed();
  fs::create_directories(source_ / "archive");
  ASSERT_TRUE(runs("cd '" + source_.string() + "' && git archive HEAD | tar -x -C archive"));
  ASSERT_TRUE(git("commit --allow-empty -m second"));
  EXPECT_EQ(said(source_ / "archive"), commit);
  fs::create_directories(source_ / "archive/.git");  // of no repository
  EXPECT_EQ(said(source_ / "archive"), commit);
}

TEST_F(Commit, IsOfNoRepositoryThatTheEnvironmentNames) {
  const std::string commit = committed();
  const fs::path other = folder_ / "other/.git";
  ASSERT_TRUE(runs("git init '" + (folder_ / "other").string() + "'"));
  setenv("GIT_DIR", other.c_str(), 1);
  setenv("GIT_INDEX_FILE", (other / "index").c_str(), 1);
  const std::string then = said(source_);
  unsetenv("GIT_DIR");
  unsetenv("GIT_INDEX_FILE");
  EXPECT_EQ(then, commit);
}

/// So that nothing is compiled that need not be.
TEST_F(Commit, IsWrittenOnlyWhereItChanges) {
  said(source_);
  const fs::path file = folder_ / "commit.cpp";
  const auto then = fs::last_write_time(file) - std::chrono::hours(1);
  fs::last_write_time(file, then);
  said(source_);
  EXPECT_EQ(fs::last_write_time(file), then);
}

}  // namespace commit_test
}  // namespace bernal::testing
