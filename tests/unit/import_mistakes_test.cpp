// Files that say two things at once, or are not what they seem: none is taken for less or more than it holds.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>

#include "bernal/core/error.hpp"
#include "bernal/import/import.hpp"
#include "support/folder.hpp"

namespace bernal {
namespace import_mistakes_test {

using testing::Folder;

struct File {
  std::string name, text;
  ImportOptions options = {};
};

ImportedPacking imported(const File& of) {
  const Folder folder;
  return import_packing(folder.write(of.name, of.text), of.options);
}

/// One line that has the words.
void expect_refusal(const File& of, const std::vector<std::string>& words) {
  try {
    imported(of);
    ADD_FAILURE() << of.text << "\nis taken";
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find('\n'), what.npos) << what;
    for (const std::string& word : words)
      EXPECT_NE(what.find(word), what.npos) << word << "\nis not in: " << what;
  }
}

/// A frame of a dump that claims so many atoms.
std::string frame_of(int claimed, const std::string& rows) {
  return fmt::format(
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
      "ITEM: ATOMS id x y z radius\n{}",
      claimed, rows);
}

// As many spheres as a file claims, and no row left over that might have been one.
TEST(ImportMistakes, NoRowIsLeftOver) {
  const ImportOptions m{.unit = Unit::m};
  const std::string one = "1 1 1 1 .5\n", two = one + "2 5 5 5 .5\n";
  for (const std::string& rows : {two, two + "3 8 8 8 .5\n", one + "garbage\n", one + "\n2 5 5 5 .5\n"})
    expect_refusal({"a.dump", frame_of(1, rows), m}, {"frame 1", "1 spheres", "NUMBER OF ATOMS"});
  expect_refusal({"a.dump", frame_of(1, two), m}, {"a.dump:11"});
  expect_refusal({"a.dump", frame_of(0, one), m}, {"a.dump:10"});
  // In a frame that nobody asked for, since the row may be the next one's.
  expect_refusal({"a.dump", frame_of(1, two) + frame_of(1, one), m}, {"a.dump:11", "frame 1"});
  expect_refusal({"a.dump", frame_of(1, one) + frame_of(2, two + one), m}, {"a.dump:22", "frame 2"});
  EXPECT_EQ(
      imported({"a.dump", frame_of(2, two) + "\n" + frame_of(1, one + "\n \n"), m}).packing.spheres.size(),
      1U);

  const auto geometry = [](int claimed, const std::string& rows) {
    return fmt::format(
        "LSMGeometry 1.2\nBoundingBox 0 0 0 9 9 9\nPeriodicBoundaries 0 0 0\nDimension 3D\n"
        "BeginParticles\nSimple\n{}\n{}",
        claimed, rows);
  };
  const std::string first = "1 1 1 .5 4 0\n", both = first + "5 5 5 .5 2 0\n", end = "EndParticles\n";
  expect_refusal({"a.geo", geometry(1, both + end), m}, {"a.geo:9", "1 spheres", "Simple"});
  expect_refusal({"a.geo", geometry(1, both), m}, {"a.geo:9"});
  EXPECT_EQ(imported({"a.geo", geometry(2, both + end), m}).packing.spheres.size(), 2U);
  EXPECT_EQ(imported({"a.geo", geometry(2, both), m}).packing.spheres.size(), 2U);
}

// Whenever it is stopped, an earlier result stays as it was: what was to be imported is there still.
TEST(ImportMistakes, AStoppedImportWritesNothing) {
  const Folder folder;
  std::string table = "# unit: mm\nx,y,z,r\n";
  for (int i = 0; i < 64; ++i) table += fmt::format("{},{},{},0.6\n", i % 4, i / 4 % 4, i / 16);
  const auto file = folder.write("a.csv", table),
             old = folder.write("old.csv", "# unit: mm\nx,y,z,r\n1,1,1,1\n");
  const auto import_into_out = [&](const std::filesystem::path& from, const Monitor& monitor) {
    write_imported(import_packing(from, {}, monitor).packing, from, folder / "out", {.monitor = monitor});
  };
  import_into_out(old, {});
  const auto state = [&] {
    std::vector<std::pair<std::string, std::string>> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out"))
      all.emplace_back(entry.path().filename().string(), testing::text_of(entry.path()));
    std::ranges::sort(all);
    return all;
  };
  std::atomic<int> asked = 0;
  import_into_out(file, {{}, [&] { return ++asked < 0; }});
  const int questions = asked;  // about; threads part their work as they come
  EXPECT_GT(questions, 5);
  int stopped = 0;
  for (int last = 0; last < questions; last += last < 8 || last > questions - 8 ? 1 : 7) {
    import_into_out(old, {});
    const auto before = state();
    asked = 0;
    bool thrown = false;
    try {
      import_into_out(file, {{}, [&] { return ++asked > last; }});
    } catch (const Cancelled&) {
      thrown = true;
    }
    EXPECT_EQ(thrown, asked > last) << last;
    EXPECT_EQ(thrown, state() == before) << last;
    stopped += thrown;
  }
  EXPECT_GT(stopped, 5);
}

}  // namespace import_mistakes_test
}  // namespace bernal
