// Files that say two things at once, or are not what they seem: none is taken for less or more than it holds.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/formats/import.hpp"
#include "support/export_packings.hpp"
#include "support/exports.hpp"
#include "support/folder.hpp"
#include "support/foreign_files.hpp"

namespace bernal {
namespace import_mistakes_test {

using testing::expect_refusal;
using testing::Folder;
using testing::imported;
using File = testing::ForeignFile;

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
  expect_refusal({"a.html", "<html><body>1 2 3</body></html>\n", mm}, {"XML or HTML", "CSV"});
  expect_refusal({"a.json", "{\"x\": [1, 2]}\n", mm}, {"JSON", "CSV"});
  expect_refusal({"a.stl", "solid part\nfacet normal 0 0 1\n", mm}, {"STL", "inspect"});
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
                 {"a.csv:1", "\"mm\" of x and no unit of r", "‹unit›"});
  expect_refusal({"a.csv", "x [mm],y [mm],z [mm],r [um]\n" + row}, {"\"mm\" of x and \"um\" of r"});
}

TEST(ImportMistakes, AxesAreNamedOnce) {
  const std::string table = "x,y,z,r\n1,2,3,0.5\n";
  for (const char* word : {"xx", "xyx", "zz"})
    expect_refusal({"a.csv", table, {.unit = Unit::mm, .box = {9, 9, 9}, .periodic = word}},
                   {"‹periodic›", "twice"});
  const std::string discs = "x,y,r\n1,2,0.5\n3,4,0.5\n";
  expect_refusal({"a.csv", discs, {.unit = Unit::mm, .dimension = 3}},
                 {"a.csv", "2 coordinates", "‹dimension›"});
  EXPECT_EQ(imported({"a.csv", discs, {.unit = Unit::mm, .dimension = 2}}).packing.spheres.dimension(), 2);
  EXPECT_EQ(imported({"a.csv", table, {.unit = Unit::mm, .dimension = 3}}).packing.spheres.dimension(), 3);
}

TEST(ImportMistakes, StructuresOfNumpyGoByTheNamesOfTheirMembers) {
  const std::string header =
      "{'descr': [('diameter', '<f8'), ('z', '<f8'), ('y', '<f8'), ('x', '<f8')], 'fortran_order': False, "
      "'shape': (2,), }\n";
  std::string bytes("\x93NUMPY\x01\0", 8);
  bytes += {static_cast<char>(header.size()), '\0'};
  const std::array<double, 8> rows = {1, 3, 2, 1, 0.5, 6, 5, 4};
  bytes += header + std::string(reinterpret_cast<const char*>(rows.data()), sizeof rows);
  const Packing packing = imported({"a.npy", bytes, {.unit = Unit::mm}}).packing;
  EXPECT_EQ(packing.spheres.r, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(packing.spheres.x, (std::vector<std::vector<double>>{{1, 4}, {2, 5}, {3, 6}}));
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
  // Of its own edge; and no cell is so slender.
  expect_refusal(with("1e6 0 0 1e-9 10 0 0 0 10"), {"tilt", "longest edge"});
  const ImportedPacking tilted = imported(with("10 0 0 -2 9 0 1 0.5 8"));
  EXPECT_EQ(std::get<Box>(tilted.packing.domain).tilt, (Tilt{-2, 1, 0.5}));
  for (const char* ends : {"T T F", "F T T", "F F F"})
    expect_refusal(with(std::string("10 0 0 1 10 0 0 0 10\" pbc=\"") + ends), {"a.xyz: ", "skewed walls"});
  File walled = with("10 0 0 1 10 0 0 0 10");
  walled.options.periodic = "none";
  expect_refusal(walled, {"a.xyz: ", "skewed walls", "‹periodic=xyz›"});
}

/// A LAMMPS data file of one atom with that first line.
File data_file(const std::string& title, const std::string& more = "", const ImportOptions& options = {}) {
  return {"a.data",
          title +
              "\n\n1 atoms\n1 atom types\n\n0 6 xlo xhi\n0 6 ylo yhi\n0 6 zlo zhi\n\nAtoms # sphere\n\n"
              "1 1 2 2500 1 1 1\n" +
              more,
          options};
}

// What a remark says counts where it is a clause of its own.
TEST(ImportMistakes, ProseSaysNeitherUnitNorWalls) {
  const ImportOptions mm{.unit = Unit::mm};
  for (const char* prose :
       {"Fe grain boundary model", "bond lengths in nm", "boundary layer of glass",
        "all lengths in mm of the lab", "the boundary p p f was tried", "old units = si, now mm",
        "LAMMPS, periodic boundary f", "LAMMPS data file, units lj", "real units of cost",
        "units = si prefixes", "unit: cell of cubes", "radii in cm", "LAMMPS data file, units = lj"}) {
    const Packing packing = imported(data_file(prose, "", mm)).packing;
    EXPECT_FALSE(has_walls(packing.domain)) << prose;
    EXPECT_EQ(packing.scene.unit, Unit::mm) << prose;
    expect_refusal(data_file(prose), {"a.data", "‹unit=mm›"});
  }
  // What sounds like a unit and is not taken for one is named beside the format.
  for (const auto& [title, said] :
       {std::pair("LAMMPS data file, units lj", "\"units lj\" is not taken for a unit"),
        {"real units of cost", "\"real units of cost\" is not"},
        {"bed, lengths in mm, radii in cm", "\"radii in cm\" is not"},
        {"lengths in mm of the lab; units = si prefixes",
         "\"lengths in mm of the lab\", \"units = si prefixes\" is not"}})
    EXPECT_NE(imported(data_file(title, "", mm)).notes.front().text.find(said), std::string::npos) << title;
  for (const char* title : {"lengths in mm", "units = lj", "Fe grain boundary model"})
    EXPECT_EQ(imported(data_file(title, "", mm)).notes.front().text.find("taken for"), std::string::npos)
        << title;
  for (const auto& [title, unit] : {std::pair("# lengths in nm", Unit::nm),
                                    {"LAMMPS data file, units = si", Unit::m},
                                    {"by hand; lengths in um; dense", Unit::um},
                                    {"units = cgs", Unit::cm}})
    EXPECT_EQ(imported(data_file(title)).packing.scene.unit, unit) << title;
  const Packing walls = imported(data_file("bed; boundary p f f; lengths in mm")).packing;
  EXPECT_EQ(std::get<Box>(walls.domain).periodic, (std::vector<bool>{true, false, false}));
  EXPECT_TRUE(imported(data_file("boundary ff ff ff; lengths in mm")).packing.domain.index() ==
              walls.domain.index());
  expect_refusal(data_file("bed; boundary p p q"), {"a.data:1", "\"q\""});
  expect_refusal(data_file("bed; boundary p p"), {"a.data:1", "three axes"});
  expect_refusal(data_file("bed; lengths in angstrom", "", mm), {"a.data:1", "\"angstrom\"", "‹unit›"});
  expect_refusal(data_file("lengths in 1000 mm", "", mm), {"a.data:1", "\"1000 mm\""});
  expect_refusal(data_file("bed, units = ls", "", mm), {"a.data:1", "\"ls\""});
  expect_refusal(data_file("lengths in mm, units = si"), {"a.data:1", "mm"});
  const std::string rows = "1 2 3 0.5\n4 5 6 0.25\n";
  expect_refusal({"a", "#format x_y_z_r\n# bond lengths in nm\n" + rows}, {"‹unit=mm›"});
  expect_refusal({"a", "#format x_y_z_r\n# lengths in mm\n# lengths in cm\n" + rows}, {"a:3", "mm"});
  EXPECT_EQ(imported({"a", "#format x_y_z_r\n# bed; lengths in mm\n" + rows}).packing.scene.unit, Unit::mm);
}

// What a file has twice, and what it has that is none of what is known.
TEST(ImportMistakes, NoSecondSectionIsPassedOver) {
  const ImportOptions mm{.unit = Unit::mm};
  const std::string atoms = "\nAtoms # sphere\n\n1 1 2 2500 4 4 4\n";
  expect_refusal(data_file("x", "\nVelocities\n\n1 0 0 0\n" + atoms, mm),
                 {"a.data:18", "second section Atoms"});
  expect_refusal(data_file("x", atoms, mm), {"a.data:14", "second"});
  EXPECT_EQ(imported(data_file("x", "\nVelocities\n\n1 0 0 0 0 0 0\n\nPair Coeffs\n\n1 2\n", mm))
                .packing.spheres.size(),
            1U);
  expect_refusal(data_file("x", "N/A 1 2 2500 4 4 4\n", mm), {"a.data:13", "\"N/A\""});
  expect_refusal(data_file("x", "#N/A 1 2 2500 4 4 4\n", mm), {"a.data:13", "\"#N/A\""});
  expect_refusal(data_file("x\n\n2 atoms", "", mm), {"a.data:5", "another number"});
  expect_refusal(data_file("x\n\n0 7 xlo xhi", "", mm), {"a.data:8", "other bounds"});
  expect_refusal(data_file("x\n\n3 ellipsoids", "", mm), {"a.data:3", "ellipsoids"});

  const std::string mfix =
      "Version 2.0\n====\nDimension:    3\nParticles:    1\n====\nCoordinates  T  Must be T\nPhase_ID  F  1\n"
      "Diameter  T\nDensity  F  2500\n====\n1 1 1 0.5\n";
  EXPECT_EQ(imported({"particle_input.dat", mfix}).packing.spheres.size(), 1U);
  expect_refusal({"particle_input.dat", mfix + "2 2 2 0.5\n"},
                 {"particle_input.dat:12", "1 particles", "Particles:"});
  expect_refusal({"particle_input.dat", mfix + "\n\n#N/A 2 2 0.5\n"}, {"particle_input.dat:14"});
  std::string other = mfix;
  other.replace(other.find("Phase_ID  F  1"), 14, "Wetness   T   ");
  expect_refusal({"particle_input.dat", other}, {"particle_input.dat:7", "\"Wetness\""});

  const std::string geometry =
      "LSMGeometry 1.2\nBoundingBox 0 0 0 9 9 9\nPeriodicBoundaries 0 0 0\nDimension "
      "3D\nBeginParticles\nSimple\n1\n"
      "1 1 1 .5 4 0\nEndParticles\nBeginConnect\n0\nEndConnect\n";
  EXPECT_EQ(imported({"a.geo", geometry, mm}).packing.spheres.size(), 1U);
  expect_refusal({"a.geo", geometry + "BeginParticles\nSimple\n1\n2 2 2 .5 5 0\nEndParticles\n", mm},
                 {"a.geo:13"});
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  expect_refusal({"a.geo", with(geometry, "Boundaries 0 0 0", "Boundaries 0 2 0"), mm},
                 {"a.geo:3", "0 and 1"});
  expect_refusal({"a.geo", with(geometry, "3D", "4D"), mm}, {"a.geo:4", "\"4D\""});

  const std::string frame = testing::frame_of_dump(1, "1 1 1 1 .5\n");
  expect_refusal({"a.dump", with(frame, "pp pp pp", "pp qq pp"), mm}, {"a.dump:5", "\"qq\""});
  expect_refusal({"a.dump", with(frame, "pp pp pp", "pp pp"), mm}, {"a.dump:5", "three axes"});
  expect_refusal({"a.dump", with(frame, "pp pp pp", "pp pf pp"), mm}, {"a.dump:5", "\"pf\""});
  expect_refusal({"a.dump", "ITEM: UNITS\nSI\n" + frame, mm}, {"a.dump:2", "\"SI\""});

  const std::string ball = "ball create radius 1 position 2 2 2\n";
  expect_refusal({"a.dat", "model domain extent 0 9 0 9 0 9 condition periodical\n" + ball, mm},
                 {"a.dat:1", "\"periodical\""});
  expect_refusal({"a.dat", "model domain condition periodic extent 0 9 0 9 0 9\n" + ball, mm}, {"a.dat:1"});
  expect_refusal({"a.dat", ball + "ball create\n", mm}, {"a.dat:2"});
  expect_refusal({"a.dat", ball + "ball generate number 100\n", mm}, {"a.dat:2", "ball generate"});
  const std::string repeats = "model domain extent 0 9 0 9 0 9 condition periodic\n";
  EXPECT_EQ(std::get<Box>(imported({"a.dat", repeats + ball, mm}).packing.domain).periodic,
            (std::vector<bool>{true, true, true}));
}

TEST(ImportMistakes, NoRowOfATableIsTakenForARemark) {
  const ImportOptions mm{.unit = Unit::mm};
  const std::string head = "x,y,z,r\n1,2,3,0.5\n";
  for (const char* row :
       {"#N/A,5,6,0.25", "#VALUE!,5,6,0.25", "#DIV/0!,#N/A,6,0.25", "#WERT!,5,6,1", "#NV,5,6,1,"})
    expect_refusal({"a.csv", head + row + "\n", mm}, {"a.csv:3", "no number"});
  expect_refusal({"a.txt", "x y z r\n1 2 3 0.5\n#N/A 5 6 0.25\n", mm}, {"a.txt:3", "\"#N/A\""});
  for (const std::string row : {"#N/A,#N/A,#N/A,#N/A", "#DIV/0!,#DIV/0!,#DIV/0!,#DIV/0!,", "#N/A", "#REF!,,,",
                                "########,7,7,.5", "####,####,####,####"})
    expect_refusal({"a.csv", head + row + "\n4,5,6,0.25\n", mm}, {"a.csv:3", "a spreadsheet"});
  expect_refusal({"a.csv", head + "4,5,#N/A,0.25\n", mm}, {"a.csv:3", "z = \"#N/A\""});
  // Text for people is passed over, a row that somebody left out is counted.
  const ImportedPacking some = imported(
      {"a.csv", head + "# step 2, at 17:30\n# the rest: 4 to 5\n#7,8,9,0.5\n4,5,6,0.25\n# 7,8,9,1\n", mm});
  EXPECT_EQ(some.packing.spheres.size(), 2U);
  EXPECT_NE(some.notes.front().text.find("2 rows behind a mark are left out, the first in line 5"),
            std::string::npos)
      << some.notes.front().text;
  expect_refusal({"a.csv", "# unit: mm\n" + head + "# unit: cm\n4,5,6,0.25\n"}, {"a.csv:4", "cm", "mm"});
  expect_refusal({"a.csv", head + "# unit: cm\n4,5,6,0.25\n", mm}, {"in cm", "‹unit›"});
  EXPECT_EQ(imported({"a.csv", head + "# unit: cm\n4,5,6,0.25\n"}).packing.scene.unit, Unit::cm);
}

TEST(ImportMistakes, AnOpenQuotationMarkIsRefused) {
  const ImportOptions mm{.unit = Unit::mm};
  for (const char* row :
       {"\"1,2,3,0.5", "1,2\",3,0.5", "1,2,3,\"0.5", "'1,2,3,0.5", "1,2,3,0.5'", "\",2,3,0.5"})
    expect_refusal({"a.csv", "x,y,z,r\n" + std::string(row) + "\n", mm}, {"a.csv:2"});
  expect_refusal({"a.csv", "x,y,\"z,r\n1,2,3,0.5\n", mm}, {"a.csv:1", "close"});
  expect_refusal({"a.csv", "x,y,z,r,name\n1,2,3,0.5,\"glass\n", mm}, {"a.csv:2", "close"});
  EXPECT_EQ(imported({"a.csv", "x,y,z,r,name\n'1',\"2\",3,0.5,5\" ball\n", mm}).packing.spheres.size(), 1U);

  const auto xyz = [&](const std::string& line) {
    return File{"a.xyz", "1\n" + line + "\nX 1 2 3\n", {.radius = 1, .unit = Unit::mm}};
  };
  const std::string lattice = "Lattice=\"9 0 0 0 9 0 0 0 9\" ";
  expect_refusal(xyz("Lattice=\"9 0 0 0 9 0 0 0 9"), {"a.xyz:2", "not closed"});
  expect_refusal(xyz(lattice + "pbc='T T T"), {"a.xyz:2", "not closed"});
  for (const char* pbc : {"maybe", "\"maybe maybe maybe\"", "\"T T yes\"", "\"T T\"", "\"2 0 0\""})
    expect_refusal(xyz(lattice + "pbc=" + pbc), {"a.xyz:2", "pbc"});
  expect_refusal(xyz("pbc=\"T T T\""), {"a.xyz:2", "‹box›"});
  EXPECT_TRUE(has_walls(imported(xyz("pbc=\"F F F\"")).packing.domain));
  EXPECT_EQ(std::get<Box>(imported(xyz(lattice + "pbc=\"true False 1\"")).packing.domain).periodic,
            (std::vector<bool>{true, false, true}));
  expect_refusal(xyz(lattice + "Lattice=\"8 0 0 0 9 0 0 0 9\""), {"a.xyz:2", "twice"});
  expect_refusal(xyz(lattice + "unit=parsec"), {"a.xyz:2", "\"parsec\"", "‹unit›"});
  expect_refusal({"a.xyz", "1\nProperties=species:S:1:pos:R:3\nX 1 2 3 4\n", {.radius = 1, .unit = Unit::mm}},
                 {"a.xyz:3", "5 columns"});
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
