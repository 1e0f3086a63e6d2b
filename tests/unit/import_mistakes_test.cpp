// Files that say two things at once, or are not what they seem: none is taken for less or more than it holds.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/import/import.hpp"
#include "support/export_packings.hpp"
#include "support/exports.hpp"
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
  for (int i = 0; i < 8; ++i) table += fmt::format("{},{},{},0.6\n", i % 4, i / 4 % 4, i / 16);
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
  import_into_out(old, {});
  for (const int last : {0, 1, questions / 2, questions - 2, questions - 1}) {
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
    if (!thrown) import_into_out(old, {});
    stopped += thrown;
  }
  EXPECT_GE(stopped, 3);
}

// HOOMD's schema has a default, and the gsd library leaves out what equals it.
TEST(ImportMistakes, DiametersThatAGsdLeavesOutAreOne) {
  const Folder folder;
  Packing packing = testing::exports::periodic();
  packing.scene.unit = Unit::mm;
  const auto file = folder / "a.gsd";
  write_export(packing, output_of("gsd"), file);
  std::string bytes = testing::text_of(file);
  const std::size_t name = bytes.find("particles/diameter");
  ASSERT_NE(name, bytes.npos);
  bytes.replace(name, 18, "particles/nobodies");
  const ImportedPacking ones = imported({"b.gsd", bytes});
  EXPECT_EQ(ones.packing.spheres.r, std::vector<double>(packing.spheres.size(), 0.5));
  EXPECT_NE(ones.notes.front().text.find("takes for 1 each"), std::string::npos) << ones.notes.front().text;
  const ImportedPacking said = imported({"b.gsd", bytes, {.diameter = 0.25}});
  EXPECT_EQ(said.packing.spheres.r, std::vector<double>(packing.spheres.size(), 0.125));
  EXPECT_EQ(said.notes.front().text.find("takes for"), std::string::npos);
}

TEST(ImportMistakes, WhatIsNoTextIsNamedWithARemedy) {
  const auto bytes = [](std::string_view text) { return std::string(text); };
  const ImportOptions mm{.unit = Unit::mm};
  using namespace std::string_view_literals;
  expect_refusal({"a.gz", bytes("\x1F\x8B\x08\0\0\0"sv), mm}, {"a.gz", "gzip", "gunzip"});
  expect_refusal({"a", bytes("\x1F\x8B\x08\0\0\0"sv), {.format = "dump", .unit = Unit::mm}}, {"gunzip"});
  expect_refusal({"a.csv", bytes("\xFF\xFEx\0,\0y\0"sv), mm}, {"UTF-16", "iconv"});
  expect_refusal({"a.csv", bytes("\xFE\xFF\0x\0,\0y"sv), mm}, {"UTF-16", "iconv"});
  expect_refusal({"a.bin",
                  bytes("\xF6\xFF\xFF\xFF\xFF\xFF\xFF\xFF"
                        "DUMPCUSTOM\x01\0\0\0"sv),
                  mm},
                 {"binary dump", "as text"});
  expect_refusal({"a.dat", bytes("x,y\0\x01\x02"sv), mm}, {"no text", "CSV"});
  expect_refusal({"a.csv", "x,y,z,r\r1,2,3,0.5\r4,5,6,0.5\r", mm}, {"CR alone", "tr "});
  EXPECT_EQ(
      imported({"a.txt", "1 2 3 .5\r", {.columns = "x,y,z,r", .unit = Unit::mm}}).packing.spheres.size(), 1U);
}

TEST(ImportMistakes, AUnitHasManySpellingsAndOneMeaning) {
  const std::string sign = "\xC2\xB5m", letter = "\xCE\xBCm", row = "1,2,3,0.5\n";
  for (const std::string& head : {"x [" + sign + "],y [" + sign + "],z [" + sign + "],r [" + sign + "]\n",
                                  "x (" + sign + "),y (" + letter + "),z (um),r (" + letter + ")\n",
                                  "# unit: " + sign + "\nx,y,z,r\n", "# unit: " + letter + "\nx,y,z,r\n"})
    EXPECT_EQ(imported({"a.csv", head + row}).packing.scene.unit, Unit::um) << head;
  EXPECT_EQ(imported({"a.xyz", "1\nunit=" + letter + "\nX 1 2 3\n", {.radius = 1}}).packing.scene.unit,
            Unit::um);
  expect_refusal({"a.csv", "x [mm],y [mm],z [mm],r\n" + row},
                 {"a.csv:1", "\"mm\" of x and no unit of r", "--unit"});
  expect_refusal({"a.csv", "x [mm],y [mm],z [mm],r [um]\n" + row}, {"\"mm\" of x and \"um\" of r"});
}

TEST(ImportMistakes, AxesAreNamedOnce) {
  const std::string table = "x,y,z,r\n1,2,3,0.5\n";
  for (const char* word : {"xx", "xyx", "zz"})
    expect_refusal({"a.csv", table, {.unit = Unit::mm, .box = {9, 9, 9}, .periodic = word}},
                   {"--periodic", "twice"});
  const std::string discs = "x,y,r\n1,2,0.5\n3,4,0.5\n";
  expect_refusal({"a.csv", discs, {.unit = Unit::mm, .dimension = 3}},
                 {"a.csv", "2 coordinates", "--dimension"});
  EXPECT_EQ(imported({"a.csv", discs, {.unit = Unit::mm, .dimension = 2}}).packing.spheres.dimension(), 2);
  EXPECT_EQ(imported({"a.csv", table, {.unit = Unit::mm, .dimension = 3}}).packing.spheres.dimension(), 3);
}

TEST(ImportMistakes, ANumpyFileHoldsOneArray) {
  const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 4), }\n";
  std::string bytes("\x93NUMPY\x01\0", 8);
  bytes += {static_cast<char>(header.size()), '\0'};
  bytes += header;
  const auto with = [&](std::array<double, 8> rows) {
    return bytes + std::string(reinterpret_cast<const char*>(rows.data()), sizeof rows);
  };
  const ImportOptions mm{.unit = Unit::mm};
  const std::string whole = with({1, 2, 3, 0.5, 4, 5, 6, 0.25});
  EXPECT_EQ(imported({"a.npy", whole, mm}).packing.spheres.size(), 2U);
  expect_refusal({"a.npy", whole + "x", mm}, {"a.npy", "1 bytes behind its 2 rows", "np.save"});
  expect_refusal({"a.npy", whole + whole, mm}, {"behind"});
  expect_refusal({"a.npy", with({1, 2, 3, 0.5, 4, 5, 6, -1}), mm}, {"row 2: "});
  expect_refusal({"a.npy", with({std::numeric_limits<double>::infinity(), 2, 3, 0.5, 4, 5, 6, 1}), mm},
                 {"row 1: "});
}

TEST(ImportMistakes, ALatticeIsUprightToRounding) {
  const auto with = [](const std::string& lattice) {
    return File{"a.xyz", "1\nLattice=\"" + lattice + "\"\nX 1 2 3\n", {.radius = 1, .unit = Unit::mm}};
  };
  const ImportedPacking upright = imported(with("10 6e-16 0 -9e-12 10 0 0 0 10"));
  EXPECT_EQ(std::get<Box>(upright.packing.domain).size, Coordinates(Vector<3>(10, 10, 10)));
  expect_refusal(with("10 1.1e-11 0 0 10 0 0 0 10"), {"a.xyz:2", "triclinic"});
  expect_refusal(with("1e6 0 0 1e-9 10 0 0 0 10"), {"triclinic"});  // of its own edge
}

TEST(ImportMistakes, ALinkThatLeadsNowhereIsSaid) {
  const Folder folder;
  std::filesystem::create_symlink("loop", folder / "loop");
  std::filesystem::create_symlink("gone", folder / "lost");
  for (const char* name : {"loop", "lost"}) {
    try {
      check_importable(folder / name, folder / "out");
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("leads nowhere"), std::string::npos) << error.what();
    }
  }
}

}  // namespace import_mistakes_test
}  // namespace bernal
