// What export says, refuses and leaves behind.
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <sstream>

#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "support/export_packings.hpp"
#include "support/exports.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace export_calls_test {

namespace fs = std::filesystem;
using namespace testing::exports;
using testing::error_of;
using testing::Folder;
using testing::text_of;

/// Largest (ri + rj - d) / (ri + rj) by all pairs, and their nearest images along axes with an edge.
double largest_overlap(const std::vector<std::array<double, 3>>& centers, const std::vector<double>& radii,
                       const std::array<double, 3>& edges) {
  long double largest = -1;
  for (std::size_t i = 0; i < radii.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      long double squared = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        long double d = static_cast<long double>(centers[i][k]) - centers[j][k];
        if (edges[k] > 0) d -= edges[k] * std::nearbyint(d / edges[k]);
        squared += d * d;
      }
      const long double sum = static_cast<long double>(radii[i]) + radii[j];
      largest = std::max(largest, (sum - std::sqrt(squared)) / sum);
    }
  return static_cast<double>(largest);
}

/// The number after these words of a note; 0 where it says that there is no overlap.
double said_overlap(const std::string& note) {
  if (note.find("no overlap after rounding") != note.npos) return 0;
  const std::size_t at = note.find("largest overlap after rounding to ");
  EXPECT_NE(at, note.npos) << note;
  return std::stod(note.substr(note.find(": ", at) + 2));
}

TEST(Export, SaysTheLargestOverlapThatRoundingMade) {
  const Packing packing = periodic(false);  // whose spheres touch
  const Folder folder;
  const WrittenExport single = write_export(packing, output_of("gsd"), folder / "a.gsd");
  const auto chunks = read_gsd(folder / "a.gsd");
  const auto positions = chunks.at("particles/position").as<float>(),
             diameters = chunks.at("particles/diameter").as<float>(),
             box = chunks.at("configuration/box").as<float>();
  std::vector<std::array<double, 3>> centers;
  std::vector<double> radii;
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    centers.push_back({positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]});
    radii.push_back(0.5 * diameters[i]);
  }
  const double in_file = largest_overlap(centers, radii, {box[0], box[1], box[2]});
  EXPECT_GT(in_file, 1e-8);  // single precision has 6e-8
  EXPECT_LT(in_file, 1e-4);
  EXPECT_NEAR(said_overlap(single.note), in_file, 0.06 * in_file) << single.note;
  EXPECT_NE(single.note.find("extxyz"), std::string::npos) << single.note;

  const WrittenExport metres = write_export(packing, output_of("yade"), folder / "a.txt");
  const ReadBack read = read_yade(folder / "a.txt");
  const double in_metres = std::max(
      0.0, largest_overlap(read.centers, read.radii, {in_unit(3, "m"), in_unit(4, "m"), in_unit(5.3, "m")}));
  EXPECT_LT(in_metres, 1e-13);
  // The certificate gives the ratio in double: a difference of a sum and a root, each within some roundoffs.
  EXPECT_NEAR(said_overlap(metres.note), in_metres, 0.06 * in_metres + 6 * tolerance::roundoff)
      << metres.note;

  const WrittenExport own = write_export(packing, output_of("yade", {{"unit", "mm"}}), folder / "b.txt");
  EXPECT_NE(own.note.find("not rounded"), std::string::npos) << own.note;
}

// A packing that overlaps is not put down to rounding, and not passed over where nothing is rounded.
TEST(Export, SaysThatThePackingItselfOverlaps) {
  Packing packing = periodic();
  const Vector<3> first(packing.spheres.x[0][0], packing.spheres.x[1][0], packing.spheres.x[2][0]);
  packing.spheres.push_back(first + Vector<3>(0.5 * packing.spheres.r[0], 0, 0), packing.spheres.r[0]);
  for (const ExportFormat& format : export_formats()) {
    const Folder folder;
    const std::string note = write_export(packing, output_of(format.name), folder / "a.x").note;
    EXPECT_NE(note.find("the packing itself overlaps: largest 0.75 of the sum of two radii"),
              std::string::npos)
        << format.name << ": " << note;
    EXPECT_EQ(note.find("after rounding"), std::string::npos) << note;
    const std::string clean = write_export(periodic(), output_of(format.name), folder / "b.x").note;
    EXPECT_EQ(clean.find("itself overlaps"), std::string::npos) << format.name << ": " << clean;
  }
  packing.scene.overlap = 0.8;
  const Folder folder;
  const std::string allowed = write_export(packing, output_of("npy"), folder / "a.npy").note;
  EXPECT_NE(allowed.find("of which its scene allows 0.8"), std::string::npos) << allowed;
}

// spheres.csv of another hand: the certificate takes centres for their images, and so do programs.
TEST(Export, CentresOutsideThePeriodAreWrapped) {
  const Packing inside = periodic();
  Packing outside = inside;
  const double edges[] = {3, 4, 5.3};
  for (std::size_t i = 0; i < outside.spheres.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      outside.spheres.x[k][i] += edges[k] * (static_cast<double>((i + k) % 5) - 2);
  const Folder folder;
  double density = 0;
  const ReadBack wanted = read_lammps(exported_to(folder, inside, "lammps"), density);
  const auto near = [&](const ReadBack& read, double per_mm) {
    ASSERT_EQ(read.centers.size(), wanted.centers.size());
    for (std::size_t i = 0; i < read.centers.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_GE(read.centers[i][k], 0);
        EXPECT_LT(read.centers[i][k], edges[k] * per_mm);
        // Two periods away a coordinate has lost two bits, and once more is rounded on the way back.
        EXPECT_NEAR(read.centers[i][k], wanted.centers[i][k] * per_mm / 1e-3,
                    16 * tolerance::roundoff * edges[k] * per_mm);
      }
  };
  near(read_lammps(exported_to(folder, outside, "lammps"), density), 1e-3);
  near(read_pfc(exported_to(folder, outside, "pfc"), 3), 1e-3);
  near(read_extxyz(exported_to(folder, outside, "extxyz")), 1);
  const auto chunks = read_gsd(exported_to(folder, outside, "gsd"));
  const auto positions = chunks.at("particles/position").as<float>(),
             box = chunks.at("configuration/box").as<float>();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    EXPECT_GE(positions[i], -0.5F * box[i % 3]);
    EXPECT_LT(positions[i], 0.5F * box[i % 3]);
  }
  const std::string note = write_export(outside, output_of("extxyz"), folder / "a.xyz").note;
  EXPECT_EQ(note.find("not rounded"), std::string::npos) << note;
  EXPECT_EQ(read_npy(exported_to(folder, outside, "npy")).values[5], outside.spheres.x[1][1])
      << "as they are";
  // Nothing of what is inside moves.
  EXPECT_EQ(read_extxyz(exported_to(folder, inside, "extxyz")).centers[7][1], inside.spheres.x[1][7]);
}

TEST(Export, TheNoteSaysWhatTheFileHolds) {
  const Folder folder;
  const std::string note =
      write_export(periodic(), output_of("lammps", {{"density", "1000"}}), folder / "a.data").note;
  for (const char* words : {"spheres", "lengths in m, diameters", "density 1000 kg/m3", "3 types"})
    EXPECT_NE(note.find(words), std::string::npos) << note;
}

TEST(Export, LiggghtsGetsTheWallsOfAMesh) {
  const Mesh tetrahedron{{{0, 0, 0}, {90, 0, 0}, {0, 90, 0}, {0, 0, 90}},
                         {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  Packing packing = packing_in(tetrahedron, "kind = \"box\"\nsize = [9, 9, 9]");
  const Folder folder;
  const WrittenExport written = write_export(packing, output_of("liggghts"), folder / "bed.data");
  ASSERT_EQ(written.files.size(), 3u);
  const std::string script = text_of(folder / "bed.in"), walls = text_of(folder / "bed.stl");
  EXPECT_NE(script.find("read_data bed.data"), std::string::npos);
  EXPECT_NE(script.find("mesh/surface file bed.stl"), std::string::npos);
  EXPECT_NE(walls.find("vertex 0.09 0 0\n"), std::string::npos);
  std::size_t facets = 0;
  for (std::size_t at = 0; (at = walls.find("endfacet", at)) != walls.npos; ++at) ++facets;
  EXPECT_EQ(facets, 4u);
  write_export(in_cylinder(), output_of("liggghts"), folder / "c.data");
  EXPECT_NE(text_of(folder / "c.in").find("zcylinder 0.002 0.001 0.002"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "c.stl"));
}

// Its wall is `xcylinder R y z`, `ycylinder R z x`, `zcylinder R x y`.
TEST(Export, LiggghtsGetsTheMiddleOfACylinderInItsOwnOrder) {
  for (const auto& [axis, line] :
       std::vector<std::pair<Vector<3>, std::string>>{{Vector<3>::UnitX(), "xcylinder 0.002 0.002 -0.001"},
                                                      {Vector<3>::UnitY(), "ycylinder 0.002 -0.001 0.001"},
                                                      {Vector<3>::UnitZ(), "zcylinder 0.002 0.001 0.002"}}) {
    const Folder folder;
    const Cylinder cylinder{.base = {1, 2, -1}, .axis = axis, .radius = 2, .height = 5};
    write_export(packing_in(cylinder, "kind = \"cylinder\"\nradius = 2\nheight = 5"), output_of("liggghts"),
                 folder / "c.data");
    EXPECT_NE(text_of(folder / "c.in").find(line + "\n"), std::string::npos) << line;
  }
}

// Triangles around a sphere or an oblique cylinder, where it has no primitive: all corners outside, none far.
TEST(Export, LiggghtsGetsRoundWallsAsTriangles) {
  const auto clearance_of = [](const Domain& domain, const Vector<3>& p) {
    return make_analytic_container(domain, WallArithmetic::plain, 0)->clearance(p);
  };
  for (const Domain& domain :
       std::vector<Domain>{Sphere{.center = {1, 2, 3}, .radius = 4},
                           Cylinder{.base = {1, 2, -1}, .axis = {0, 1, 1}, .radius = 2, .height = 5}}) {
    const Folder folder;
    const Packing packing = packing_in(domain, "kind = \"box\"\nsize = [9, 9, 9]");
    const WrittenExport written = write_export(packing, output_of("liggghts"), folder / "c.data");
    EXPECT_EQ(written.note.find("has no walls"), std::string::npos) << written.note;
    EXPECT_NE(text_of(folder / "c.in").find("mesh/surface file c.stl"), std::string::npos);
    std::istringstream walls(text_of(folder / "c.stl"));
    int corners = 0;
    for (std::string word; walls >> word;) {
      if (word != "vertex") continue;
      Vector<3> p;
      walls >> p[0] >> p[1] >> p[2];
      p *= 1000;  // the scene is in mm
      const double outside = -clearance_of(domain, p);
      EXPECT_GE(outside, -1e-6);
      EXPECT_LE(outside, 0.1);
      ++corners;
    }
    EXPECT_GT(corners, 50);
  }
}

TEST(Export, LiggghtsSaysWhatWallsItLacks) {
  const Polygon polygon{.loops = {{{0, 0}, {9, 0}, {0, 9}}}};
  const Folder folder;
  Packing packing = packing_in(polygon, "kind = \"polygon\"\nvertices = [[0, 0], [9, 0], [0, 9]]");
  packing.spheres = Spheres<dynamic>(2);
  packing.spheres.x = {{2}, {2}};
  packing.spheres.r = {0.5};
  const std::string note = write_export(packing, output_of("liggghts"), folder / "c.data").note;
  EXPECT_NE(note.find("has no walls"), std::string::npos) << note;
}

// Its words are quoted by either mark, and nothing else means anything between those.
TEST(Export, LiggghtsReadsAnyName) {
  const Mesh walls{{{0, 0, 0}, {90, 0, 0}, {0, 90, 0}, {0, 0, 90}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const Packing packing = packing_in(walls, "kind = \"box\"\nsize = [9, 9, 9]");
  for (const auto& [name, mark] : std::vector<std::pair<std::string, std::string>>{{"bed", ""},
                                                                                   {"a b", "\""},
                                                                                   {"h#h", "\""},
                                                                                   {"d$x", "\""},
                                                                                   {"it's", "\""},
                                                                                   {"q\"q", "'"},
                                                                                   {"b\\n", "\""}}) {
    const Folder folder;
    write_export(packing, output_of("liggghts"), folder / (name + ".data"));
    const std::string script = text_of(folder / (name + ".in"));
    EXPECT_NE(script.find("read_data " + mark + name + ".data" + mark + "\n"), std::string::npos) << script;
    EXPECT_NE(script.find("mesh/surface file " + mark + name + ".stl" + mark + " type 1\n"),
              std::string::npos)
        << script;
  }
}

TEST(Export, AllFilesAppearOrNone) {
  const Folder folder;
  fs::create_directory(folder / "b.py");  // where one that goes with it belongs
  const Packing packing = periodic();
  EXPECT_EQ(error_of([&] { write_export(packing, output_of("openmc"), folder / "b.npy"); }).code(),
            ErrorCode::cannot_write);
  EXPECT_FALSE(fs::exists(folder / "b.npy"));
  EXPECT_FALSE(fs::exists(folder / "b_radii.npy"));
  EXPECT_TRUE(fs::is_directory(folder / "b.py"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
  // Into a folder that has to be made, and in the place of an earlier one.
  const fs::path file = folder / "new/deep/c.txt";
  write_export(packing, output_of("yade"), file);
  const std::string first = text_of(file);
  write_export(packing, output_of("yade", {{"unit", "mm"}}), file);
  EXPECT_NE(text_of(file), first);
}

TEST(Export, AnInterruptLeavesNothing) {
  const Packing packing = periodic(false);
  for (const ExportFormat& format : export_formats()) {
    for (int last = 0; last < 3; ++last) {
      const Folder folder;
      std::atomic<int> asked = 0;
      const Monitor monitor{{}, [&] { return asked++ >= last; }};
      bool stopped = false;
      try {
        write_export(packing, output_of(format.name), folder / "a.x", monitor);
      } catch (const Cancelled&) {
        stopped = true;
      }
      EXPECT_EQ(stopped, asked > last) << format.name;
      EXPECT_EQ(fs::is_empty(folder.path()), stopped) << format.name;
    }
  }
}

TEST(Export, NoSpheresAreAFileToo) {
  Packing packing = periodic();
  packing.spheres = Spheres<3>();
  for (const ExportFormat& format : export_formats()) {
    const Folder folder;
    EXPECT_NO_THROW(exported_to(folder, packing, format.name)) << format.name;
  }
  const Folder folder;
  double density = 0;
  EXPECT_EQ(read_lammps(exported_to(folder, packing, "lammps"), density).radii.size(), 0u);
  EXPECT_EQ(read_gsd(exported_to(folder, packing, "gsd")).at("particles/N").as<std::uint32_t>()[0], 0u);
  EXPECT_EQ(read_npy(exported_to(folder, packing, "npy")).shape, (std::vector<std::size_t>{0, 4}));
}

TEST(Export, RefusesWhatAFormatCannotHoldOrBeTold) {
  const Folder folder;
  const auto refused = [&](const auto& call, const std::vector<std::string>& words) {
    const std::string what = error_of(call).what();
    for (const std::string& word : words)
      EXPECT_NE(what.find(word), std::string::npos) << word << ": " << what;
  };
  refused([&] { exported_to(folder, in_plane(), "yade"); }, {"\"yade\"", "2 dimensions", "lammps", "extxyz"});
  refused([&] { output_of("vtk"); }, {"spheres.vtp already", "grid of voxels"});
  refused([&] { output_of("lamps"); }, {"unknown format \"lamps\"", "did you mean \"lammps\"?"});
  refused([&] { output_of("yade", {{"density", "7"}}); }, {"yade takes no density", "lammps"});
  refused([&] { output_of("openmc", {{"unit", "mm"}}); }, {"openmc takes no unit"});
  refused([&] { output_of("lammps", {{"density", "-7"}}); }, {"density must be", "-7"});
  refused([&] { output_of("lammps", {{"density", "heavy"}}); }, {"density must be", "heavy"});
  refused([&] { output_of("lammps", {{"types", "2.5"}}); }, {"types must be", "whole number", "2.5"});
  refused([&] { output_of("lammps", {{"types", "0"}}); }, {"types must be", "0"});
  refused([&] { output_of("lammps", {{"unit", "parsec"}}); }, {"unit must be", "parsec"});
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Export, RefusesARadiusThatSinglePrecisionCannotHold) {
  const Folder folder;
  for (const double radius : {1e300, 1e-60}) {
    Packing packing = between_walls();
    packing.spheres.r[7] = radius;
    const Error error = error_of([&] { exported_to(folder, packing, "gsd"); });
    EXPECT_NE(std::string(error.what()).find("sphere 7 has the radius"), std::string::npos) << error.what();
    EXPECT_NO_THROW(exported_to(folder, packing, "npy"));
  }
}

TEST(Export, EveryFormatSaysWhatItIs) {
  std::set<std::string> names, files;
  for (const ExportFormat& format : export_formats()) {
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    EXPECT_TRUE(files.insert(format.file).second) << format.file;
    EXPECT_FALSE(format.what.empty());
    EXPECT_LE(format.least_dimension, 3);
    EXPECT_GE(format.most_dimensions, 3);
  }
  EXPECT_GE(names.size(), 11u);
}

}  // namespace export_calls_test
}  // namespace bernal
