#include "files/staged_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "files/output_file.hpp"
#include "files/put_in_place.hpp"
#include "support/staged_files.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace staged_folder_test {

namespace fs = std::filesystem;
using testing::error_of;
using testing::Folder;
using testing::text_of;

using testing::entries_in;
using testing::Files;
using testing::files_in;
using testing::names_of;
using testing::publish;

const Files earlier = {{"a", "1"}, {"b", "1"}, {"c", "1"}, {"picture", "1"}};
const Files later = {{"a", "2"}, {"b", "2"}, {"c", "2"}, {"d", "2"}};

TEST(StagedFolder, WhatOnlyTheEarlierResultHasGoes) {
  const Folder folder;
  publish(folder.path(), earlier, {});
  folder.write("mine", "0");
  publish(folder.path(), later, earlier);
  Files expected = later;
  expected["mine"] = "0";
  EXPECT_EQ(files_in(folder.path()), expected);
  EXPECT_EQ(entries_in(folder.path()), expected.size());
}

TEST(StagedFolder, WhatCannotBeWrittenIsNamedAsItWouldBeCalled) {
  const Folder folder;
  StagedFolder staged(folder.path());
  const fs::path there = staged.add("a");
  fs::create_directory(there);
  const std::string said = error_of([&] { const OutputFile file(there); }).what();
  EXPECT_TRUE(said.starts_with((folder / "a").string() + ": cannot be created")) << said;
}

// Whoever is killed while publishing leaves the earlier result, a part of one of them and never of both, or
// the new one; and the next who looks finds one of them whole.
TEST(StagedFolder, KilledAtAnyMomentItHoldsOneResult) {
  std::size_t unfinished = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Folder folder;
    publish(folder.path(), earlier, {});
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
      StagedFolder staged(folder.path());
      for (const auto& [name, text] : later) staged.write(name, text);
      static_cast<void>(!write(ready[1], "x", 1));
      staged.publish(names_of(earlier));
      pause();
    }
    char byte = 0;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    const auto at = std::chrono::steady_clock::now() + std::chrono::microseconds(5 * trial);
    while (std::chrono::steady_clock::now() < at) continue;
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(ready[0]);
    close(ready[1]);

    const Files left = files_in(folder.path());
    bool any[2] = {false, false};
    for (const auto& [name, text] : left) any[text == "2"] = true;
    EXPECT_FALSE(any[0] && any[1]) << "trial " << trial;
    unfinished += left != earlier && left != later;

    finish_publishing(folder.path());
    const Files now = files_in(folder.path());
    EXPECT_TRUE(now == earlier || now == later) << "trial " << trial;
    EXPECT_TRUE(any[1] ? now == later : true);
    publish(folder.path(), earlier, now);
    EXPECT_EQ(files_in(folder.path()), earlier);
    EXPECT_EQ(entries_in(folder.path()), earlier.size()) << "what was staged is left";
  }
  RecordProperty("unfinished", static_cast<int>(unfinished));
}

// The same for certain: what stands there after so many of the steps.
TEST(StagedFolder, WhatIsCompleteIsFinishedFromAnyStep) {
  for (int moved_out = 0; moved_out <= 4; ++moved_out) {
    const Folder folder;
    const fs::path complete = folder / ".bernal-complete";
    fs::create_directories(complete / ".earlier");
    for (const auto& [name, text] : later) std::ofstream(complete / name) << text;
    for (const auto& [name, text] : earlier)
      std::ofstream(complete / ".replaced", std::ios::app) << name << '\n';
    int k = 0;
    for (const auto& [name, text] : earlier)
      std::ofstream((k++ < moved_out ? complete / ".earlier" : folder.path()) / name) << text;
    finish_publishing(folder.path());
    EXPECT_EQ(files_in(folder.path()), later) << moved_out;
    EXPECT_EQ(entries_in(folder.path()), later.size());
  }
  for (int moved_in = 0; moved_in <= 4; ++moved_in) {
    const Folder folder;
    const fs::path placing = folder / ".bernal-placing";
    fs::create_directories(placing / ".earlier");
    std::ofstream(placing / ".replaced") << "a\n";
    for (const auto& [name, text] : earlier) std::ofstream(placing / ".earlier" / name) << text;
    int k = 0;
    for (const auto& [name, text] : later)
      std::ofstream((k++ < moved_in ? folder.path() : placing) / name) << text;
    finish_publishing(folder.path());
    EXPECT_EQ(files_in(folder.path()), later) << moved_in;
    EXPECT_EQ(entries_in(folder.path()), later.size());
  }
}

// What is no result's stays: files of the same name, folders that look like those of bernal.
TEST(StagedFolder, NothingOfAUsersIsLost) {
  const Folder folder;
  publish(folder.path(), earlier, {});
  for (const char* own : {".bernal-backup", ".bernal-complete", ".bernal-placing"}) {
    fs::create_directories(folder / own);
    folder.write(std::string(own) + "/mine", "0");
  }
  finish_publishing(folder.path());
  EXPECT_TRUE(fs::exists(folder / ".bernal-placing/mine"));
  for (const char* own : {".bernal-complete", ".bernal-placing"}) fs::remove_all(folder / own);
  folder.write("d", "mine");
  publish(folder.path(), later, earlier);
  EXPECT_EQ(text_of(folder / "d"), "2");
  EXPECT_EQ(text_of(folder / "d.kept"), "mine");
  EXPECT_TRUE(fs::exists(folder / ".bernal-backup/mine"));
  // And after a kill: what has been written there since.
  fs::create_directories(folder / ".bernal-placing/.earlier");
  folder.write(".bernal-placing/.replaced", "a\n");
  folder.write(".bernal-placing/a", "3");
  folder.write("a", "mine");
  finish_publishing(folder.path());
  EXPECT_EQ(text_of(folder / "a"), "3");
  EXPECT_EQ(text_of(folder / "a.kept"), "mine");
}

TEST(StagedFolder, ThoseOfKilledProcessesGoAndThoseOfOthersStay) {
  const Folder folder;
  fs::create_directories(folder / ".bernal-staging-killed");
  folder.write(".bernal-staging-killed/a", "0");
  {
    const StagedFolder other(folder.path());
    EXPECT_EQ(entries_in(folder.path()), 1u);
    const StagedFolder mine(folder.path());
    EXPECT_EQ(entries_in(folder.path()), 2u);
  }
  EXPECT_EQ(entries_in(folder.path()), 0u);
}

/// As of a run that was killed once all its files were in their places, over removing its own folder.
TEST(StagedFolder, WhoeverFinishesRemovesThoseOfKilledProcessesToo) {
  const Folder folder;
  const StagedFolder other(folder.path());
  fs::create_directories(folder / ".bernal-staging-killed/.earlier");
  folder.write(".bernal-staging-killed/.earlier/a", "0");
  folder.write("result", "1");
  finish_publishing(folder.path());
  EXPECT_FALSE(fs::exists(folder / ".bernal-staging-killed"));
  EXPECT_EQ(entries_in(folder.path()), 2u) << "the result, and the staging folder of who is at work";
}

TEST(StagedFolder, ALinkThatLeadsNowhereIsNamed) {
  const Folder folder;
  fs::create_symlink("nowhere", folder / "link");
  fs::create_symlink("loop", folder / "loop");
  for (const char* name : {"link", "link/below", "loop", "loop/below"}) {
    const Error error = error_of([&] { StagedFolder staged(folder / name); });
    EXPECT_EQ(error.code(), ErrorCode::cannot_write);
    EXPECT_TRUE(std::string(error.what()).starts_with(folder.path().string())) << error.what();
  }
}

/// Runs `act` in so many processes at once; how many of them failed, by their own words in a file a process.
template <class Act>
std::string failures_side_by_side(const fs::path& said, int processes, const Act& act) {
  std::vector<pid_t> children;
  for (int p = 0; p < processes; ++p) {
    const pid_t child = fork();
    if (child != 0) {
      children.push_back(child);
      continue;
    }
    try {
      act(p);
    } catch (const std::exception& error) {
      std::ofstream(said / std::to_string(p)) << error.what();
      _exit(1);
    }
    _exit(0);
  }
  for (const pid_t child : children) waitpid(child, nullptr, 0);
  std::string all;
  for (const auto& [name, text] : files_in(said)) all += text + "\n";
  return all;
}

// As make -j does it: each run has its own file, and all have one in common.
TEST(StagedFolder, RunsSideBySideAllPublish) {
  constexpr int processes = 4, rounds = 20;
  const Folder folder, said;
  const fs::path into = folder / "made/by/the first";
  EXPECT_EQ(failures_side_by_side(said.path(), processes,
                                  [&](int p) {
                                    for (int k = 0; k < rounds; ++k) {
                                      StagedFolder staged(into);
                                      staged.write(std::to_string(p), std::to_string(k));
                                      staged.write("all", std::to_string(p));
                                      staged.publish();
                                    }
                                  }),
            "");
  EXPECT_EQ(entries_in(into), processes + 1u);
  for (int p = 0; p < processes; ++p)
    EXPECT_EQ(text_of(into / std::to_string(p)), std::to_string(rounds - 1));
}

// Of one folder that each of them makes and leaves: whoever fails takes away only what nobody else is in.
TEST(StagedFolder, RunsThatFailSideBySideTakeNobodysFolderAway) {
  const Folder folder, said;
  EXPECT_EQ(failures_side_by_side(said.path(), 4,
                                  [&](int) {
                                    for (int k = 0; k < 30; ++k)
                                      StagedFolder(folder / "new").write("a", "1");  // never published
                                  }),
            "");
  // The one that made it may have gone before the last.
  if (fs::exists(folder / "new")) {
    EXPECT_TRUE(fs::is_empty(folder / "new"));
  }
}

TEST(StagedFolder, AListOfWhatIsReplacedHoldsAnyName) {
  const std::vector<std::string> names = {"new\nline", "back\\nslash", "back\\\nboth", "end\\"};
  for (const std::string& name : names) {
    const Folder folder;
    const std::vector<std::string> others = {"new", "line", "back", "back\nslash", "slash", "both", "end"};
    for (const std::string& other : others) folder.write(other, "mine");
    publish(folder.path(), {{name, "1"}}, {});
    publish(folder.path(), {{"a", "2"}}, {{name, "1"}});
    EXPECT_FALSE(fs::exists(folder / name));
    for (const std::string& other : others) EXPECT_EQ(text_of(folder / other), "mine") << name;
  }
}

// A list may come from a file of somebody else.
TEST(StagedFolder, NothingOutsideIsReplaced) {
  const Folder folder;
  fs::create_directories(folder / "in/deep");
  fs::create_directory_symlink("..", folder / "in/up");
  folder.write("mine", "0");
  folder.write("in/deep/own", "0");
  publish(folder / "in", later,
          {{"../mine", ""}, {"up/mine", ""}, {(folder / "mine").string(), ""}, {"deep", ""}});
  EXPECT_EQ(text_of(folder / "mine"), "0");
  EXPECT_EQ(text_of(folder / "in/deep/own"), "0");
  for (const char* no : {"", ".", "..", "../a", "a/../b", "/a", "a/", "./a", "up/mine"})
    EXPECT_FALSE(is_name_in(folder / "in", no)) << no;
  for (const char* yes : {"a", "..a", "deep/own", "not/there/yet"})
    EXPECT_TRUE(is_name_in(folder / "in", yes)) << yes;
}

// Whoever takes a link or a pipe for a file of an earlier result loses neither.
TEST(StagedFolder, WhatIsNoRegularFileIsKept) {
  const Folder folder;
  folder.write("far", "mine");
  fs::create_symlink("far", folder / "link");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const std::string name : {"link", "pipe"}) {
    publish(folder.path(), {{name, "1"}}, {{name, ""}});
    EXPECT_EQ(text_of(folder / name), "1");
  }
  EXPECT_TRUE(fs::is_symlink(folder / "link.kept"));
  EXPECT_TRUE(fs::is_fifo(folder / "pipe.kept"));
  EXPECT_EQ(text_of(folder / "far"), "mine");
  // Those that have no successor stay where they are.
  fs::rename(folder / "pipe.kept", folder / "b");
  publish(folder.path(), {{"a", "1"}}, {{"b", ""}});
  EXPECT_TRUE(fs::is_fifo(folder / "b"));
}

TEST(StagedFolder, NamesMayLeadIntoFoldersBelow) {
  const Folder folder;
  folder.write("case", "in the way");
  error_of([&] { publish(folder.path(), {{"a", "1"}, {"case/system/dict", "1"}}, {}); });
  EXPECT_EQ(entries_in(folder.path()), 1u) << "and nothing half written is left";
  fs::remove(folder / "case");

  const Files first = {{"case/system/dict", "1"}, {"case/walls/a.stl", "1"}, {"run", "1"}};
  publish(folder.path(), first, {});
  EXPECT_EQ(text_of(folder / "case/system/dict"), "1");
  folder.write("case/mine", "0");
  publish(folder.path(), {{"case/system/dict", "2"}}, first);
  EXPECT_EQ(text_of(folder / "case/system/dict"), "2");
  EXPECT_FALSE(stands(folder / "case/walls")) << "nothing is left in it";
  EXPECT_FALSE(stands(folder / "run"));
  EXPECT_EQ(text_of(folder / "case/mine"), "0");
  EXPECT_EQ(entries_in(folder.path()), 1u);
}

}  // namespace staged_folder_test
}  // namespace bernal
