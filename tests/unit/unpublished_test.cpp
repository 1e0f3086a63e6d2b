// Results that a run was killed over putting in place, in folders of one's own and of somebody else.
#include "scene/unpublished.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "files/input_file.hpp"
#include "files/put_in_place.hpp"
#include "support/staged_files.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace unpublished_test {

namespace fs = std::filesystem;
using testing::entries_in;
using testing::error_of;
using testing::Files;
using testing::files_in;
using testing::Folder;
using testing::publish;
using testing::text_of;

// A folder of somebody else, with what a run seems to have left there and a link that leads out of it.
TEST(Unpublished, NothingIsPutInPlaceThroughALink) {
  for (const std::string left : {".bernal-complete", ".bernal-placing"})
    for (const std::string name : {"sub/bashrc", "sub/deep/bashrc"}) {
      const Folder folder;
      fs::create_directories(folder / "home/deep");
      folder.write("home/bashrc", "precious");
      fs::create_directories((folder.path() / "theirs" / left / name).parent_path());
      folder.write("theirs/" + left + "/.replaced", "sub/bashrc\nsub/deep/bashrc\n../home/bashrc\n");
      folder.write("theirs/" + left + "/" + name, "evil");
      fs::create_directory_symlink("../home", folder / "theirs/sub");
      const std::string said = error_of([&] { finish_publishing(folder / "theirs"); }).what();
      EXPECT_NE(said.find("sub: is in the way"), std::string::npos) << said;
      error_of([&] { StagedFolder staged(folder / "theirs"); });
      EXPECT_EQ(text_of(folder / "home/bashrc"), "precious");
      EXPECT_EQ(entries_in(folder / "home"), 2u);
      EXPECT_EQ(entries_in(folder / "home/deep"), 0u);
      EXPECT_EQ(text_of(folder.path() / "theirs" / left / name), "evil") << "and nothing was moved";
    }
}

// Neither is what a run leaves looked for behind one.
TEST(Unpublished, ALinkIsNothingThatARunHasLeft) {
  const Folder folder;
  fs::create_directories(folder / "other/.bernal-placing");
  folder.write("other/.bernal-placing/.replaced", "");
  folder.write("other/.bernal-placing/a", "1");
  fs::create_directory(folder / "mine");
  fs::create_directory_symlink("../other/.bernal-placing", folder / "mine/.bernal-placing");
  finish_publishing(folder / "mine");
  EXPECT_EQ(where_it_stands(folder / "mine/a"), folder / "mine/a");
  EXPECT_EQ(entries_in(folder / "mine"), 1u);
  EXPECT_EQ(text_of(folder / "other/.bernal-placing/a"), "1");
}

// Links, pipes and what else a run does not make stay where somebody put them.
TEST(Unpublished, WhatARunDoesNotMakeIsNotMoved) {
  const Folder folder;
  folder.write("far", "mine");
  fs::create_directories(folder / "in/.bernal-placing");
  folder.write("in/.bernal-placing/.replaced", "");
  folder.write("in/.bernal-placing/a", "2");
  fs::create_symlink("../../far", folder / "in/.bernal-placing/link");
  ASSERT_EQ(mkfifo((folder / "in/.bernal-placing/pipe").c_str(), 0600), 0);
  finish_publishing(folder / "in");
  EXPECT_EQ(text_of(folder / "in/a"), "2");
  EXPECT_FALSE(stands(folder / "in/link"));
  EXPECT_FALSE(stands(folder / "in/pipe"));
  EXPECT_EQ(text_of(folder / "far"), "mine");
  std::size_t kept = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "in"))
    kept += entry.is_symlink() || entry.is_fifo();
  EXPECT_EQ(kept, 2u);
  publish(folder / "in", {{"b", "3"}}, {});  // and nobody is kept from working there
  EXPECT_EQ(text_of(folder / "in/b"), "3");
}

// A pipe in the place of a list would be waited for.
TEST(Unpublished, APipeIsNoListOfWhatIsReplaced) {
  for (const char* left : {".bernal-complete", ".bernal-placing"}) {
    const Folder folder;
    const Files there = {{"a", "1"}, {"b", "1"}};
    publish(folder.path(), there, {});
    fs::create_directory(folder / left);
    ASSERT_EQ(mkfifo((folder.path() / left / ".replaced").c_str(), 0600), 0);
    EXPECT_EQ(where_it_stands(folder / "a"), folder / "a");
    finish_publishing(folder.path());
    EXPECT_EQ(files_in(folder.path()), there);
  }
}

TEST(InputFile, IsNoPipeNoFolderAndNoDevice) {
  const Folder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", folder / "link");
  fs::create_symlink(folder.write("a", "1 2"), folder / "good");
  for (const fs::path& none :
       {folder / "pipe", folder / "link", folder / "missing", folder.path(), fs::path("/dev/zero")})
    EXPECT_FALSE(InputFile(none)) << none;
  InputFile in(folder / "good");
  int one = 0, two = 0;
  EXPECT_TRUE(in >> one >> two);
  EXPECT_EQ(one + two, 3);
  in.open(folder / "pipe");
  EXPECT_FALSE(in);
  in.open(folder / "a");
  EXPECT_TRUE(in);
}

/// All that stands in a folder, with what is in the files.
Files everything_in(const fs::path& folder) {
  Files all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    all[entry.path().lexically_relative(folder)] = entry.is_regular_file() ? text_of(entry.path()) : "";
  return all;
}

// Of every step that a run may be killed at, whoever reads takes the new result for the one, and moves
// nothing.
TEST(Unpublished, WhatIsOnItsWayIsReadFromThere) {
  const Packing old = testing::example(1, 20), fresh = testing::example(2, 30);
  const Folder one, other;
  write_packing(old, one.path(), {.view = false});
  write_packing(fresh, other.path(), {.view = false, .as_array = true});
  const Files was = files_in(one.path()), is = files_in(other.path());
  for (const bool placing : {false, true})
    for (std::size_t moved = 0; moved <= (placing ? is : was).size(); ++moved) {
      const Folder folder;
      const std::string left = placing ? ".bernal-placing" : ".bernal-complete";
      fs::create_directories(folder.path() / left / ".earlier");
      std::string replaced;
      for (const auto& [name, text] : was) replaced += name + "\n";
      folder.write(left + "/.replaced", replaced);
      std::size_t k = 0;
      for (const auto& [name, text] : was)
        folder.write((placing || k++ < moved ? left + "/.earlier/" : "") + name, text);
      k = 0;
      for (const auto& [name, text] : is)
        folder.write((placing && k++ < moved ? "" : left + "/") + name, text);
      const Files before = everything_in(folder.path());
      EXPECT_TRUE(is_unpublished(folder.path()));
      const Packing read = read_packing(folder.path());
      EXPECT_EQ(read.spheres.r, fresh.spheres.r) << left << moved;
      EXPECT_EQ(read.spheres.x, fresh.spheres.x);
      EXPECT_EQ(everything_in(folder.path()), before) << left << moved;
      finish_publishing(folder.path());
      EXPECT_FALSE(is_unpublished(folder.path()));
      EXPECT_EQ(read_packing(folder.path()).spheres.r, fresh.spheres.r);
      EXPECT_EQ(files_in(folder.path()), is);
    }
}

}  // namespace unpublished_test
}  // namespace bernal
