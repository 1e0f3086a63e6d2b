// Files as other programs write them, and what is said where they cannot be read.
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <array>
#include <cstring>

#include "bernal/core/error.hpp"
#include "bernal/formats/import.hpp"
#include "support/folder.hpp"
#include "support/foreign_files.hpp"

namespace bernal {
namespace import_formats_test {

using testing::Folder;

using Case = testing::ForeignFile;
using testing::expect_refusal;
using testing::imported;

Packing packing_of(const Case& of) { return imported(of).packing; }

/// (1, 2, 3) of radius 0.5 and (4, 5, 6) of radius 0.25, in mm.
void expect_two(const Packing& packing) {
  ASSERT_EQ(packing.spheres.size(), 2U);
  EXPECT_EQ(packing.spheres.x, (std::vector<std::vector<double>>{{1, 4}, {2, 5}, {3, 6}}));
  EXPECT_EQ(packing.spheres.r, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(packing.scene.unit, Unit::mm);
}

TEST(ImportTable, AnyTableIsReadThatSaysItsColumns) {
  const ImportOptions mm{.unit = Unit::mm};
  const auto with = [&](const std::string& columns) {
    return ImportOptions{.columns = columns, .unit = Unit::mm};
  };
  for (const Case& of : std::vector<Case>{
           {"a.csv", "x,y,z,r\n1,2,3,0.5\n4,5,6,0.25\n", mm},
           {"a.csv", "# unit: mm\nx,y,z,r\n1,2,3,0.5\n4,5,6,0.25"},
           {"a.csv", "\xEF\xBB\xBFid;x [mm];y [mm];z [mm];Diameter [mm]\r\n7;1;2;3;1\r\n8;4;5;6;0.5\r\n"},
           {"a.txt", "1 2 3 1\n4\t5  6 0.5\n", with("x,y,z,d")},
           {"a.txt", "% by hand\n\n  1\t2\t3\t0.5\n// more\n4\t5\t6\t.25\n", with("x,y,z,r")},
           {"a.txt", "9 9 3 2 1 0.5\n9 9 6 5 4 0.25\n", with("-,-,z,y,x,r")},
           {"a.txt", "9 9 3 2 1 0.5\n9 9 6 5 4 0.25\n", with("x=5,y=4,z=3,r=6")},
           {"a.csv", "id,rad_p,X,Y,Z\n1,.5,1,2,3\n2,+.25,4,5,6\n", with("x,y,z,r=rad_p")},
           {"a.csv", "id,z,y,x,Diameter\n1,3,2,1,1\n2,6,5,4,0.5\n", with("x,y,z,d")},
           {"a.csv", "a,b,c,e\n1,2,3,1\n4,5,6,0.5\n", with("x,y,z,d")},
           {"a.csv", "\"Points:0\",\"Points:1\",\"Points:2\",\"radius\"\n1,2,3,0.5\n4,5,6,0.25\n", mm},
           {"a.txt", "# x y z r\n1 2 3 0.5\n4 5 6 0.25\n", mm},
           {"a.csv", "1,2,3,0.5,\n4,5,6,0.25,\n", with("x,y,z,r")},
           // Lines that end in a delimiter, or in several, the header or the rows alone, too.
           {"a.csv", "x;y;z;r;\n1;2;3;0.5;\n4;5;6;0.25;\n", mm},
           {"a.csv", "x;y;z;r;\r\n1;2;3;0.5;\r\n4;5;6;0.25;\r\n", mm},
           {"a.csv", "x,y,z,r\n1,2,3,0.5,\n4,5,6,0.25,\n", mm},
           {"a.csv", "x,y,z,r,\n1,2,3,0.5\n4,5,6,0.25\n", mm},
           {"a.csv", "x,y,z,r,,,\n1,2,3,0.5,,,\n4,5,6,0.25\n", mm},
           {"a.txt", "x\ty\tz\tr\t\n1\t2\t3\t0.5\t\n4\t5\t6\t0.25\t\n", mm},
           {"a.txt", "x y z r \n1 2 3 0.5 \n4 5 6 0.25 \n", mm},
           {"a.csv", "\"x\",\"y\",\"z\",\"r\",\n\"1\",\"2\",\"3\",\"0.5\",\n4, 5, 6, 0.25 ,\n", mm},
           {"a.csv", "x,y,z,r,note\n1,2,3,0.5,\n4,5,6,0.25,small\n", mm},
           {"a.csv", "# x, y, z, r,\n1, 2, 3, 0.5,\n4, 5, 6, 0.25,\n", mm},
           {"a.csv", "x [mm]; y [mm]; z [mm]; d [mm];\n1; 2; 3; 1;\n4; 5; 6; 0.5;\n"},
           {"a.csv", "9;1;2;3;0.5;\n9;4;5;6;0.25;\n", with("-,x,y,z,r")}}) {
    SCOPED_TRACE(of.text);
    expect_two(packing_of(of));
  }
  const Packing equal =
      packing_of({"a.txt", "1 2 3\n4 5 6\n", {.columns = "x,y,z", .diameter = 3, .unit = Unit::cm}});
  EXPECT_EQ(equal.spheres.r, (std::vector<double>{1.5, 1.5}));
  const Packing discs = packing_of({"a.csv", "x,y,r\n1,2,0.5\n3,4,0.5\n", mm});
  EXPECT_EQ(discs.spheres.dimension(), 2);
}

TEST(ImportTable, IsRefusedInOneLine) {
  const ImportOptions mm{.unit = Unit::mm};
  const auto with = [&](const std::string& columns) {
    return ImportOptions{.columns = columns, .unit = Unit::mm};
  };
  expect_refusal({"a.csv", "", mm}, {"a.csv", "no spheres"});
  expect_refusal({"a.csv", "x,y,z,r\n", mm}, {"a.csv:1", "no spheres"});
  expect_refusal({"a.csv", "1,2,3,0.5\n", mm}, {"a.csv:1", "‹columns=x,y,z,r›"});
  expect_refusal({"a.csv", "x,y,z,r\n1,2,3,0.5\n"}, {"a.csv", "‹unit=mm›"});
  expect_refusal({"a.csv", "x,y,z\n1,2,3\n", mm}, {"a.csv", "‹diameter› or ‹radius›"});
  expect_refusal({"a.csv", "x,y,z,r\n1,nan,3,0.5\n", mm}, {"a.csv:2", "y = \"nan\" is not finite"});
  expect_refusal({"a.csv", "x,y,z,r\n1,2,3,-0.5\n", mm}, {"a.csv:2", "radius -0.5"});
  expect_refusal({"a.csv", "x,y,z,d\n1,2,3,0\n", mm}, {"a.csv:2", "diameter 0"});
  expect_refusal({"a.csv", "x,y,z,r\n1,2,3,0.5\n4,5,6\n", mm}, {"a.csv:3", "3 fields", "4"});
  expect_refusal({"a.csv", "x;y;z;r;\n1;2;3;0.5;7;\n", mm}, {"a.csv:2", "fields", "4"});
  expect_refusal({"a.csv", "x;y;z;r;\n1;2;3;\n", mm}, {"a.csv:2"});
  expect_refusal({"a.csv", "x,y,z,r,d\n1,2,3,4,5\n", mm}, {"a.csv:1", "‹columns=x=3"});
  expect_refusal({"a.csv", "x,y,q,r\n1,2,3,4\n", with("x,y,z,r")}, {"a.csv", "no column \"z\""});
  expect_refusal({"a.txt", "1 2 3 4\n", with("x,y,zz,r")}, {"\"zz\"", "x, y, z and r or d"});
  expect_refusal({"a.txt", "1 2 3 4\n", with("x,z,r")}, {"not all coordinates"});
  expect_refusal({"a.txt", "1 2 3 4\n", with("x,y,z,r,d")}, {"twice"});
  expect_refusal({"a.txt", "1 2 3 4\n", with("x,y,z,-,r")}, {"a.txt:1", "4 fields", "needs 5"});
  expect_refusal({"a.csv", "0,5;1,5;2,5;0,5\n", with("x,y,z,r")}, {"a.csv:1", "\"0,5\" is not a number"});
  expect_refusal({"a.csv", "x,y,z,r\n1,2,3,0.5\n", {.radius = 2, .unit = Unit::mm}}, {"sizes of its own"});
  expect_refusal({"a.csv", "# unit: mm\nx,y,z,r\n1,2,3,0.5\n", {.unit = Unit::cm}},
                 {"a.csv", "in mm", "‹unit›"});
  expect_refusal({"a.csv", "x,y,z,r\n1,2,3,0.5\n", {.format = "lamps", .unit = Unit::mm}},
                 {"did you mean \"lammps\"?"});
  expect_refusal({"a.csv", "x,y,z,r\n1,2,3,0.5\n", {.unit = Unit::mm, .frame = 1}},
                 {"takes no ‹frame›", "dump"});
}

constexpr const char* dump_head =
    "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
    "ITEM: ATOMS id x y z radius\n1 8 8 8 0.125\n";

TEST(ImportDump, TheLastFrameIsSortedByNumber) {
  const std::string frame =
      "ITEM: UNITS\nsi\nITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff pp\n-1 7\n0 "
      "8\n0 9\n";
  const std::string all =
      dump_head + frame + "ITEM: ATOMS id type y x z diameter\n9 1 5 4 6 0.5\n3 2 2 1 3 1\n";
  const Folder folder;
  const ImportedPacking last = import_packing(folder.write("a.dump", all));
  EXPECT_EQ(last.packing.spheres.x, (std::vector<std::vector<double>>{{2, 5}, {2, 5}, {3, 6}}));
  EXPECT_EQ(last.packing.spheres.r, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(last.packing.scene.unit, Unit::m);
  const Box& box = std::get<Box>(last.packing.domain);
  EXPECT_EQ(box.periodic, (std::vector<bool>{true, false, true}));
  EXPECT_EQ(box.size, Coordinates(Vector<3>(8, 8, 9)));
  EXPECT_EQ(packing_of({"a.dump", all, {.unit = Unit::mm, .frame = 1}}).spheres.size(), 1U);
  expect_refusal({"a.dump", all, {.frame = 3}}, {"a.dump", "no frame 3", "2"});

  // Scaled and unwrapped coordinates, and the user's own names.
  const std::string scaled =
      frame + "ITEM: ATOMS id xs ys zs radius\n1 0.25 0.25 0.5 0.5\n2 -0.125 0.5 0.5 0.5\n";
  EXPECT_EQ(packing_of({"a.dump", scaled}).spheres.x,
            (std::vector<std::vector<double>>{{2, 7}, {2, 4}, {4.5, 4.5}}));
  const std::string own = frame + "ITEM: ATOMS id xu yu zu c_rad\n1 1 2 3 0.5\n2 20 2 3 0.5\n";
  EXPECT_EQ(packing_of({"a.dump", own, {.columns = "x=xu,y=yu,z=zu,r=c_rad"}}).spheres.x[0],
            (std::vector<double>{2, 5}));
  EXPECT_EQ(packing_of({"a.dump", own, {.radius = 1}}).spheres.r[0], 1);
}

TEST(ImportDump, IsRefusedInOneLine) {
  const std::string box =
      "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n";
  const std::string atoms = "ITEM: ATOMS id x y z radius\n";
  const ImportOptions m{.unit = Unit::m};
  expect_refusal({"a", box + atoms + "1 1 1 1 1\n1 2 2 2 1\n", m}, {"a:11", "number 1", "line 10"});
  expect_refusal({"a", box + atoms + "1 1 1 1 1\n", m}, {"a:10", "2 spheres", "1 of them"});
  expect_refusal({"a", box + atoms + "1 1 1 1 1\n2 1 1\n", m}, {"a:11", "3 columns"});
  expect_refusal({"a", box, m}, {"a:8", "ends where the atoms of frame 1"});
  expect_refusal(
      {"a", "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n99999999999999\n" + box.substr(43) + atoms, m},
      {"a:"});
  expect_refusal({"a", box + atoms, m}, {"a:9", "0 of them"});
  expect_refusal(
      {"a",
       "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS abc origin pp pp pp\n9 0 0 0\n"
       "0 9 0 0\n0 0 9 0\n" +
           atoms + "1 1 1 1 1\n",
       m},
      {"a:5", "triclinic"});
  expect_refusal({"a", box + "ITEM: ATOMS id x y z\n1 1 1 1\n2 2 2 2\n", m}, {"‹diameter›"});
  expect_refusal({"a", dump_head}, {"‹unit=mm›"});
  expect_refusal({"a", std::string(dump_head) + (box + atoms) + "1 1 1 1 1\n", m},
                 {"frame 2", "1 of them", "‹frame=1›"});
}

TEST(ImportLammps, ADumpOfATiltedBoxSaysTheBoundsOfItsCell) {
  // xlo = 1, xhi = 11, xy = 2, xz = -3; ylo = 0, yhi = 8, yz = -1 (LAMMPS's Howto_triclinic).
  const std::string box =
      "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS xy xz yz pp pp pp\n-2 13 2\n-1 8 -3\n"
      "0 6 -1\n";
  const ImportOptions m{.unit = Unit::m};
  const Packing plain = packing_of({"a", box + "ITEM: ATOMS id x y z radius\n1 4 3 2 1\n2 6 5 4 1\n", m});
  const Box& cell = std::get<Box>(plain.domain);
  EXPECT_EQ(cell.size, Coordinates(Vector<3>(10, 8, 6)));
  EXPECT_EQ(cell.tilt, (Tilt{2, -3, -1}));
  EXPECT_EQ(plain.spheres.x, (std::vector<std::vector<double>>{{3, 5}, {3, 5}, {2, 4}}));
  // The same places by shares of the cell vectors: x = xlo + 10 a + 2 b - 3 c, y = 8 b - c, z = 6 c.
  const Packing shares =
      packing_of({"a", box + "ITEM: ATOMS id xs ys zs radius\n1 0.5 0.5 0.5 1\n2 0 0 0 1\n", m});
  EXPECT_EQ(shares.spheres.x, (std::vector<std::vector<double>>{{4.5, 0}, {3.5, 0}, {3, 0}}));
  EXPECT_EQ(std::get<Box>(shares.domain).tilt, cell.tilt);
}

TEST(ImportLammps, ADumpHasThreeTiltsOrNone) {
  const auto with = [](const std::string& heading, const std::string& box, const ImportOptions& options) {
    return Case{"a",
                "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS " + heading + "\n" + box +
                    "ITEM: ATOMS id x y z radius\n1 4 3 2 1\n",
                options};
  };
  const ImportOptions m{.unit = Unit::m};
  const std::string tilted = "xy xz yz pp pp pp", rows = "-2 13 2\n-1 8 -3\n0 6 -1\n";
  EXPECT_TRUE(is_tilted(packing_of(with(tilted, rows, m)).domain));
  EXPECT_TRUE(is_tilted(packing_of(with("xy xz yz", rows, m)).domain));
  expect_refusal(with(tilted, "-2 13\n-1 8\n0 6\n", m), {"a:6", "tilt xy", "2 words"});
  expect_refusal(with(tilted, "-2 13 2\n-1 8\n0 6\n", m), {"a:7", "tilt xz", "2 words"});
  expect_refusal(with(tilted, "-2 13 2 1\n-1 8 -3\n0 6 -1\n", m), {"a:6", "4 words"});
  expect_refusal(with("pp pp pp", rows, m), {"a:6", "3 words", "xy xz yz"});
  expect_refusal(with("", rows, m), {"a:6", "3 words", "xy xz yz"});
  expect_refusal(with("pp pp pp", "0 10\n0 8 1\n0 6\n", m), {"a:7", "3 words"});
  for (const char* heading : {"xy xz pp pp pp", "xz xy yz pp pp pp", "xy xz yz xy pp pp pp", "yz pp pp pp"})
    expect_refusal(with(heading, rows, m), {"a:5", "xy xz yz", "in this order"});
  // Walls of a tilted box would be skewed, and only one that repeats itself along every axis is known.
  for (const char* ends : {"ff ff ff", "fs ss mm", "pp pp ff", "ff pp pp"})
    expect_refusal(with(std::string("xy xz yz ") + ends, rows, m), {"a: ", "skewed walls", "‹periodic=xyz›"});
  for (const char* periodic : {"none", "x", "yz"})
    expect_refusal(with(tilted, rows, {.unit = Unit::m, .periodic = periodic}), {"skewed walls"});
  EXPECT_TRUE(
      is_tilted(packing_of(with("xy xz yz ff ff ff", rows, {.unit = Unit::m, .periodic = "xyz"})).domain));
  const Case boxed = with(tilted, rows, {.unit = Unit::m, .box = {9, 9, 9}});
  EXPECT_FALSE(is_tilted(packing_of(boxed).domain));
}

TEST(ImportLammps, DataOfSpheresAndOfAtoms) {
  const std::string head =
      "LAMMPS data file via write_data, version 1, timestep = 0, units = si\n\n2 atoms\n1 atom types\n\n"
      "0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\nMasses\n\n1 1.0\n\n";
  const std::string velocities = "\nVelocities\n\n1 0 0 0 0 0 0\n2 0 0 0 0 0 0\n";
  const Packing sorted =
      packing_of({"a.data", head + "Atoms # sphere\n\n2 1 0.5 2500 4 5 6 0 0 0\n1 1 1 2500 1 2 3 0 -1 0\n" +
                                velocities});
  EXPECT_EQ(sorted.spheres.x, (std::vector<std::vector<double>>{{1, 4}, {2, 5}, {3, 6}}));
  EXPECT_EQ(sorted.spheres.r, (std::vector<double>{0.5, 0.25}));
  EXPECT_FALSE(has_walls(sorted.domain));
  const Packing points =
      packing_of({"a.data", head + "Atoms\n\n1 1 1 2 3\n2 1 4 5 6\n", {.diameter = 1, .periodic = "none"}});
  EXPECT_EQ(points.spheres.r, (std::vector<double>{0.5, 0.5}));
  EXPECT_FALSE(is_periodic(points.domain));

  expect_refusal({"a.data", head + "Atoms # sphere\n\n1 1 1 2500 1 2 3\n"}, {"2 spheres", "1 of them"});
  expect_refusal({"a.data", head + "Atoms # sphere\n\n1 1 1 2500 1 2 3\n1 1 1 2500 4 5 6\n"}, {"number 1"});
  expect_refusal({"a.data", head + "Atoms # sphere\n\n1 1 0 2500 1 2 3\n2 1 1 2500 4 5 6\n"},
                 {"a.data:16", "diameter 0"});
  expect_refusal({"a.data", head + "Atoms # ellipsoid\n\n1 1 1 2500 1 2 3\n2 1 1 2500 4 5 6\n"},
                 {"\"ellipsoid\"", "dump"});
  expect_refusal({"a.data", head + "Atoms # atomic\n\n1 1 1 2 3\n2 1 4 5 6\n"}, {"‹diameter›"});
  std::string tilted = head;
  tilted.insert(tilted.find("\n\nMasses"), "\n0.5 0 0 xy xz yz");
  const Packing in_tilted =
      packing_of({"a.data", tilted + "Atoms # sphere\n\n1 1 1 2500 1 2 3\n2 1 1 2500 4 5 6\n"});
  EXPECT_EQ(std::get<Box>(in_tilted.domain).tilt, (Tilt{0.5, 0, 0}));
  expect_refusal(
      {"a.data", tilted + "Atoms # sphere\n\n1 1 1 2500 1 2 3\n2 1 1 2500 4 5 6\n", {.periodic = "xy"}},
      {"tilted"});
  std::string again = tilted;
  again.insert(again.find("\n\nMasses"), "\n0.25 0 0 xy xz yz");
  expect_refusal({"a.data", again + "Atoms # sphere\n\n"}, {"a.data:10", "tilt"});
  for (const char* row : {"0.5 -0.25 xy xz", "0.5 xy", "0.5 0 0 xz xy yz", "xy xz yz", "0.5 0 0 0 xy xz yz",
                          "0.5 0 0 xy xz yz 0"}) {
    std::string other = head;
    other.insert(other.find("\n\nMasses"), std::string("\n") + row);
    expect_refusal({"a.data", other + "Atoms # sphere\n\n"}, {"a.data:9", "0.5 0 0 xy xz yz"});
  }
  // Rows of a section have words of any kind.
  std::string labels = head;
  labels.insert(labels.find("Masses"), "Atom Type Labels\n\n1 xy\n\n");
  EXPECT_FALSE(is_tilted(
      packing_of({"a.data", labels + "Atoms # sphere\n\n1 1 1 2500 1 2 3\n2 1 1 2500 4 5 6\n"}).domain));
  std::string between_walls = tilted;
  between_walls.insert(0, "boundary f f f, ");
  expect_refusal({"a.data", between_walls + "Atoms # sphere\n\n1 1 1 2500 1 2 3\n2 1 1 2500 4 5 6\n"},
                 {"a.data: ", "skewed walls", "‹periodic=xyz›"});
  std::string general = head;
  general.insert(general.find("\n\nMasses"), "\n9 0 1 avec");
  expect_refusal({"a.data", general + "Atoms # sphere\n\n"}, {"a.data:9", "triclinic"});
  expect_refusal({"a.data",
                  "x\n\n99999999999 atoms\n\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms # sphere\n\n",
                  {.unit = Unit::m}},
                 {"99999999999"});
}

TEST(ImportExtxyz, LatticeAndProperties) {
  const std::string first =
      "1\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3:radius:R:1\nX 8 8 8 1\n";
  const std::string second =
      "2\nProperties=species:S:1:forces:R:3:pos:R:3:Diameter:R:1 Lattice=\"9 0 0 0 9 0 0 0 9\" "
      "Origin=\"0 0 0\" pbc=\"T F T\" unit=mm comment='a b'\nSi 0 0 0 1 2 3 1\nSi 0 0 0 4 5 6 0.5\n\n";
  const Packing last = packing_of({"a.xyz", first + second});
  expect_two(last);
  EXPECT_EQ(std::get<Box>(last.domain).periodic, (std::vector<bool>{true, false, true}));
  const Packing whole = packing_of({"a.xyz", first + second, {.unit = Unit::mm, .frame = 1}});
  EXPECT_FALSE(has_walls(whole.domain));
  EXPECT_EQ(packing_of({"a.xyz", "1\nplain\nX 1 2 3\n", {.radius = 1, .unit = Unit::mm}}).spheres.size(), 1U);
  expect_refusal({"a.xyz", "1\nLattice=\"9 1 0 0 9 0 0 0 9\"\nX 1 2 3\n", {.radius = 1, .unit = Unit::mm}},
                 {"a.xyz:2", "triclinic"});
  expect_refusal({"a.xyz", first + second.substr(0, second.size() - 22), {.unit = Unit::mm}},
                 {"frame 2", "‹frame=1›"});
  expect_refusal({"a.xyz", "99999999999999\n\nX 1 2 3\n", {.radius = 1, .unit = Unit::mm}},
                 {"1 of 99999999999999"});
}

TEST(ImportYade, EveryFormatLine) {
  const ImportOptions mm{.unit = Unit::mm};
  expect_two(packing_of({"a.txt", "#format x_y_z_r\n1\t2\t3\t0.5\n4\t5\t6\t0.25\n", mm}));
  expect_two(packing_of({"a.txt", "#format id_x_y_z_r_matId\n0 1 2 3 0.5 0\n1 4 5 6 0.25 0\n", mm}));
  EXPECT_EQ(packing_of({"a.txt", "#format x_y_r\n1 2 0.5\n", mm}).spheres.dimension(), 2);
  expect_refusal({"a.txt", "#format x_y_z\n1 2 3\n", mm}, {"‹diameter›"});
  expect_refusal({"a.txt", "#format jointedPM\n1 2 3\n", mm}, {"a.txt:2", "jointedPM"});
}

/// A .npy of numbers as they lie.
template <class T>
std::string npy(const std::string& descr, const std::string& order, const std::string& shape,
                std::vector<T> values, bool swap = false) {
  std::string header =
      "{'descr': '" + descr + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
  std::string bytes("\x93NUMPY\x01\0", 8);
  bytes += static_cast<char>(header.size());
  bytes += '\0';
  bytes += header;
  for (const T& value : values) {
    std::string one(sizeof(T), '\0');
    std::memcpy(one.data(), &value, sizeof(T));
    bytes += swap ? std::string(one.rbegin(), one.rend()) : one;
  }
  return bytes;
}

TEST(ImportNpy, EveryKindOfNumbersAndOrders) {
  const std::vector<double> rows = {1, 2, 3, 0.5, 4, 5, 6, 0.25}, columns = {1, 4, 2, 5, 3, 6, 0.5, 0.25};
  const std::vector<float> singles(rows.begin(), rows.end()), fortran(columns.begin(), columns.end());
  const ImportOptions mm{.unit = Unit::mm};
  expect_two(packing_of({"a.npy", npy("<f8", "False", "(2, 4)", rows), mm}));
  expect_two(packing_of({"a.npy", npy("<f8", "True", "(2, 4)", columns), mm}));
  expect_two(packing_of({"a.npy", npy("<f4", "False", "(2, 4)", singles), mm}));
  expect_two(packing_of({"a.npy", npy(">f8", "False", "(2, 4)", rows, true), mm}));
  expect_two(packing_of({"a.npy", npy(">f4", "True", "(2, 4)", fortran, true), mm}));
  const std::vector<std::int64_t> whole = {1, 2, 3, 1, 4, 5, 6, 1};
  EXPECT_EQ(packing_of({"a.npy", npy("<i8", "False", "(2, 4)", whole), mm}).spheres.r,
            (std::vector<double>{1, 1}));
  // Diameters, by their place.
  EXPECT_EQ(
      packing_of({"a.npy", npy("<f8", "False", "(2, 4)", rows), {.columns = "x,y,z,d", .unit = Unit::mm}})
          .spheres.r,
      (std::vector<double>{0.25, 0.125}));

  // OpenMC: centres, and radii beside them or by a name.
  const Folder folder;
  const std::vector<double> centers = {1, 2, 3, 4, 5, 6}, radii = {0.5, 0.25};
  const auto file = folder.write("a.npy", npy("<f8", "False", "(2, 3)", centers));
  EXPECT_THROW(import_packing(file, mm), Error);
  const auto beside = folder.write("r.npy", npy("<f8", "False", "(2,)", radii));
  expect_two(import_packing(file, {.radii = beside, .unit = Unit::mm}).packing);
  folder.write("a_radii.npy", npy("<f8", "False", "(2,)", radii));
  EXPECT_EQ(import_packing(file).packing.scene.unit, Unit::cm);

  expect_refusal({"a.npy", npy("<f8", "False", "(2, 4)", rows).substr(0, 130), mm},
                 {"a.npy", "of 2 rows", "cut off"});
  expect_refusal({"a.npy", npy("<f8", "False", "(99999999999999, 4)", rows), mm},
                 {"2 of 99999999999999 rows"});
  expect_refusal({"a.npy", npy("<f8", "False", "(4611686018427387904, 4)", rows), mm}, {"a.npy"});
  expect_refusal({"a.npy", npy("|O", "False", "(2, 4)", rows), mm}, {"astype(float)"});
  expect_refusal({"a.npy", npy("<f8", "False", "(8,)", rows), mm}, {"one dimension"});
  expect_refusal({"a.npy", npy("<f8", "False", "(0, 4)", std::vector<double>{}), mm}, {"no spheres"});
  expect_refusal({"a.npy", npy("<f8", "False", "(2, 3)", centers), mm}, {"‹diameter› or ‹radius›"});
  expect_refusal({"a.npy", npy("<f8", "False", "(2, 4)", std::vector<double>{1, 2, 3, -1, 4, 5, 6, 1}), mm},
                 {"row 1", "radius -1"});
  expect_refusal({"a.npy", std::string("\x93NUMPY\x01\0", 8), mm}, {"a.npy", "cut off"});
}

TEST(ImportFiles, AreNeitherFoldersNorPipes) {
  const Folder folder;
  const auto refused = [&](const std::filesystem::path& file, const std::string& word) {
    try {
      import_packing(file, {.unit = Unit::mm});
      ADD_FAILURE() << file << " is taken";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  refused(folder.path(), "is a folder");
  refused(folder / "none", "no such file");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  refused(folder / "pipe", "is a pipe");
}

}  // namespace import_formats_test
}  // namespace bernal
