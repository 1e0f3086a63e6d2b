// What OpenCASCADE makes of STEP, IGES and BREP: closed triangles in millimetres, no farther from the true
// surface than said.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "bernal/cad/read_mesh.hpp"
#include "cad/diagnose/diagnose_mesh.hpp"
#include "cad/diagnose/mesh_distance.hpp"
#include "cad/read/files_of_part.hpp"
#include "cad/read/make_triangles.hpp"
#include "cad/read/polygon_soup.hpp"
#include "support/folder.hpp"

namespace bernal {
namespace read_step_test {

using cad::PolygonSoup;
using cad::ReadAttempt;

constexpr double pi = std::numbers::pi;

class ReadStep : public ::testing::Test {
 protected:
  void SetUp() override {
    if (attempt("frustum.brep", 1).failure.find("without OpenCASCADE") != std::string::npos)
      GTEST_SKIP() << "built without OpenCASCADE";
  }

  static ReadAttempt attempt(const std::string& name, double deflection) {
    return cad::read_with_opencascade(std::filesystem::path(BERNAL_DATA) / "meshes" / name, deflection);
  }

  static MeshReport diagnosed(const PolygonSoup& soup) {
    cad::Triangles triangles = cad::make_triangles(soup);
    return cad::diagnose_mesh(triangles);
  }

  static MeshReport solid(const PolygonSoup& soup, std::size_t k) {
    PolygonSoup part{soup.points, {}};
    const auto at = [&](std::size_t i) {
      return i < soup.solids.size() ? soup.polygons.begin() + std::ptrdiff_t(soup.solids[i].first)
                                    : soup.polygons.end();
    };
    part.polygons.assign(at(k), at(k + 1));
    return diagnosed(part);
  }

  static bool notes(const ReadAttempt& attempt, std::string_view text) {
    for (const std::string& note : attempt.facts.notes)
      if (note.find(text) != std::string::npos) return true;
    return false;
  }
};

// Corners of neighbouring faces are shared by index, so that nothing is left to welding.
TEST_F(ReadStep, ARoundedBlockIsClosedWithoutWelding) {
  const ReadAttempt block = attempt("block_fillets_bore.step", 0.05);
  ASSERT_TRUE(block.ok()) << block.failure;
  EXPECT_EQ(cad::make_triangles(block.soup).welded, 0U);
  const MeshReport report = diagnosed(block.soup);
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.genus, 1);
  EXPECT_EQ(report.orientation, "outward");
  EXPECT_NEAR(report.bounds.upper[0] - report.bounds.lower[0], 60, 1e-9);
  ASSERT_EQ(block.soup.solids.size(), 1U);
  EXPECT_EQ(block.soup.solids[0].first, 0U);
  ASSERT_TRUE(block.facts.unit.has_value());
  EXPECT_EQ(block.facts.unit->metres, 1e-3);
  EXPECT_FALSE(block.facts.written_in.has_value());
}

// A frustum's volume is known, its surface curves one way and outwards: chords lie inside of it, by no more
// than the deflection, and by nearly that.
TEST_F(ReadStep, VolumesConvergeWithTheDeflection) {
  const double volume = pi * 20 / 3 * (25 + 50 + 100);
  double last_missing = volume;
  for (const double deflection : {1.0, 0.1, 0.01}) {
    const ReadAttempt frustum = attempt("frustum.brep", deflection);
    ASSERT_TRUE(frustum.ok()) << frustum.failure;
    EXPECT_FALSE(frustum.facts.unit.has_value());
    const MeshReport report = diagnosed(frustum.soup);
    EXPECT_TRUE(report.usable());
    const double missing = volume - report.volume;
    EXPECT_GT(missing, 0);
    EXPECT_LT(missing, last_missing);
    EXPECT_LT(missing, deflection * report.area);
    last_missing = missing;

    ASSERT_TRUE(frustum.facts.deviation.has_value());
    EXPECT_LE(frustum.facts.deviation->outside, deflection);
    EXPECT_GT(frustum.facts.deviation->outside, 0.01 * deflection);
    EXPECT_LE(frustum.facts.deviation->inside, 1e-12);
  }
}

// Against the closed form of the cone, at a thousand points of each triangle.
TEST_F(ReadStep, TheDeviationIsMeasuredRightly) {
  const ReadAttempt frustum = attempt("frustum.brep", 0.1);
  const double slant = 1 / std::hypot(1, 0.25);
  const auto below_cone = [&](const Vector<3>& p) { return slant * (5 + p[2] / 4 - std::hypot(p[0], p[1])); };
  double deepest = 0;
  for (const auto& t : frustum.soup.polygons) {
    const Vector<3>&a = frustum.soup.points[t[0]], &b = frustum.soup.points[t[1]],
          &c = frustum.soup.points[t[2]];
    for (const Vector<3>* corner : {&a, &b, &c}) EXPECT_LT(std::abs(below_cone(*corner)), 1e-12);
    if (a[2] == b[2] && b[2] == c[2]) continue;  // the flat ends
    constexpr int fineness = 44;
    for (int i = 0; i <= fineness; ++i) {
      for (int j = 0; i + j <= fineness; ++j) {
        const Vector<3> p = (a * i + b * j + c * (fineness - i - j)) / fineness;
        deepest = std::max(deepest, below_cone(p));
      }
    }
  }
  EXPECT_GT(deepest, 0.01);
  EXPECT_NEAR(frustum.facts.deviation->outside, deepest, 0.03 * deepest);
}

// Against the closed forms of a cylinder, a ball and a torus, written in inch: at 45 points of each triangle,
// and from the points of a tessellation that is eight times as fine back to the triangles.
TEST_F(ReadStep, RoundBodiesLieWithinTheDeflectionAsItIsMeasured) {
  constexpr double inch = 25.4;
  const auto off_cylinder = [](const Vector<3>& p) { return std::abs(std::hypot(p[0], p[1]) - 10 * inch); };
  const auto off_ball = [](const Vector<3>& p) {
    return std::abs((p - Vector<3>(40 * inch, 0, 0)).norm() - 7 * inch);
  };
  const auto off_torus = [](const Vector<3>& p) {
    return std::abs(std::hypot(std::hypot(p[0], p[1] - 50 * inch) - 12 * inch, p[2]) - 4 * inch);
  };
  const Mesh fine = cad::make_triangles(attempt("round_bodies_inch.step", 10.0 / 8).soup).mesh;
  for (const double deflection : {40.0, 20.0, 10.0}) {
    const ReadAttempt read = attempt("round_bodies_inch.step", deflection);
    ASSERT_TRUE(read.ok()) << read.failure;
    const PolygonSoup& soup = read.soup;
    ASSERT_EQ(soup.solids.size(), 3U);
    double deepest = 0;
    for (std::size_t t = 0; t < soup.polygons.size(); ++t) {
      const auto& corners = soup.polygons[t];
      const Vector<3>&a = soup.points[corners[0]], &b = soup.points[corners[1]], &c = soup.points[corners[2]];
      const bool is_cylinder = t < soup.solids[1].first, is_ball = !is_cylinder && t < soup.solids[2].first;
      if (is_cylinder && a[2] == b[2] && b[2] == c[2]) continue;  // a flat end
      constexpr int fineness = 8;
      for (int i = 0; i <= fineness; ++i)
        for (int j = 0; i + j <= fineness; ++j) {
          const Vector<3> p = (a * i + b * j + c * (fineness - i - j)) / fineness;
          deepest = std::max(deepest, is_cylinder ? off_cylinder(p) : is_ball ? off_ball(p) : off_torus(p));
        }
    }
    ASSERT_TRUE(read.facts.deviation.has_value());
    const double measured = std::max(read.facts.deviation->outside, read.facts.deviation->inside);
    EXPECT_LE(measured, deflection);
    EXPECT_NEAR(measured, deepest, 0.05 * deepest);
    EXPECT_GT(deepest, 0.1 * deflection);
    const Mesh coarse = cad::make_triangles(read.soup).mesh;
    EXPECT_LE(cad::farthest(fine, coarse, {0.01 * deflection, 0.02}).at_most, 1.2 * deflection);
    EXPECT_LE(cad::farthest(coarse, fine, {0.01 * deflection, 0.02}).at_most, 1.2 * deflection);
  }
}

// A ruled surface that twists: OpenCASCADE's mesher leaves slivers across it that stand off, whatever it is
// asked for, and a finer mesh of all of it has twice the triangles. Those that stand off are split.
TEST_F(ReadStep, ASurfaceThatTwistsIsSplitWhereItStandsOff) {
  constexpr double deflection = 0.02;
  const ReadAttempt read = attempt("twisted.brep", deflection);
  ASSERT_TRUE(read.ok()) << read.failure;
  EXPECT_LE(read.facts.deviation->outside, deflection);
  EXPECT_LE(read.facts.deviation->inside, deflection);
  EXPECT_LT(read.soup.polygons.size(), 18'000U);
  EXPECT_EQ(cad::make_triangles(read.soup).welded, 0U);
  EXPECT_TRUE(diagnosed(read.soup).usable());
}

TEST_F(ReadStep, TheLeastDeflectionThatIsOfferedIsTaken) {
  const char* name = "drum_inch.igs";
  const std::string said = attempt(name, 1e-9).failure;
  const std::string_view offer = "choose at least ";
  const std::size_t at = said.find(offer);
  ASSERT_NE(at, said.npos) << said;
  const double least = std::strtod(said.c_str() + at + offer.size(), nullptr);
  EXPECT_TRUE(attempt(name, least).ok()) << said;
  EXPECT_NE(attempt(name, 0.99 * least).failure.find(offer), std::string::npos) << said;
}

TEST_F(ReadStep, AnAssemblyOfOtherFilesReadsThoseBesideAndNamesTheRest) {
  const bernal::testing::Folder folder;
  const auto text = [](const std::string& name) {
    return bernal::testing::text_of(std::filesystem::path(BERNAL_DATA) / "meshes/external" / name);
  };
  const auto assembly = folder.write("assembly.step", text("assembly.step"));
  EXPECT_EQ(
      cad::read_with_opencascade(assembly, 0).failure,
      "its parts stand in other files, which cannot be read beside it: part_box.stp, part_cyl.stp; put them "
      "there, or export all into one file");
  folder.write("part_box.stp", text("part_box.stp"));
  const ReadAttempt some = cad::read_with_opencascade(assembly, 0);
  ASSERT_TRUE(some.ok()) << some.failure;
  EXPECT_EQ(some.soup.solids.size(), 2U);
  EXPECT_TRUE(notes(some, "goes without: part_cyl.stp"));
  folder.write("part_cyl.stp", text("part_cyl.stp"));
  const ReadAttempt all = cad::read_with_opencascade(assembly, 0);
  ASSERT_TRUE(all.ok()) << all.failure;
  EXPECT_EQ(all.soup.solids.size(), 3U);
  EXPECT_FALSE(notes(all, "other files"));
  EXPECT_NEAR(diagnosed(all.soup).volume, 2 * 10 * 20 * 30 + pi * 25 * 10, 10);
  EXPECT_EQ(files_of_part(assembly).size(), 3U);
  const std::vector<std::string> said = read_mesh({.file = assembly}).report.notes;
  EXPECT_TRUE(std::ranges::any_of(said, [](const std::string& note) {
    return note == "the file refers to others, which were read with it: part_box.stp, part_cyl.stp";
  }));
}

// Two boxes of which one stands against the other, as loose surfaces: sewn together they would be one wall
// that branches.
TEST_F(ReadStep, PartsThatTouchAreSewnApart) {
  const ReadAttempt boxes = attempt("touching_boxes.igs", 0);
  ASSERT_TRUE(boxes.ok()) << boxes.failure;
  EXPECT_TRUE(notes(boxes, "12 surfaces that belong to no solid were sewn into 2 parts"));
  EXPECT_TRUE(notes(boxes, "no edge is left open"));
  ASSERT_EQ(boxes.soup.solids.size(), 2U);
  EXPECT_NEAR(std::abs(solid(boxes.soup, 0).volume), 6000, 1e-6);
  EXPECT_NEAR(std::abs(solid(boxes.soup, 1).volume), 9000, 1e-6);
  const MeshFile file{.file = std::filesystem::path(BERNAL_DATA) / "meshes/touching_boxes.igs"};
  const ImportedMesh as_it_is = read_mesh(file);
  EXPECT_FALSE(as_it_is.report.usable());
  const std::vector<std::string> lines = lines_that_help(file, {}, as_it_is, Effort::quick);
  EXPECT_EQ(lines, (std::vector<std::string>{"solids = [\"1\"]", "solids = [\"2\"]"}));
}

TEST_F(ReadStep, EachSolidOfAnAssemblyIsOfferedAsItWasTried) {
  const MeshFile file{.file = std::filesystem::path(BERNAL_DATA) / "meshes/assembly_inch.step"};
  const ImportedMesh all = read_mesh(file);
  ASSERT_TRUE(all.report.usable());
  // Two of the three bear one name, so that only their numbers tell them apart.
  const std::vector<std::string> lines = lines_that_help(file, {}, all, Effort::thorough);
  EXPECT_EQ(lines, (std::vector<std::string>{"solids = [\"1\"]", "solids = [\"2\"]", "solids = [\"ball\"]"}));
  double volume = 0;
  for (const char* solid : {"1", "2", "ball"}) {
    MeshFile one = file;
    one.solids = {solid};
    volume += read_mesh(one).report.volume;
  }
  EXPECT_NEAR(volume, all.report.volume, 1e-9 * volume);
}

TEST_F(ReadStep, AnAssemblyInInchIsPlacedNamedAndConverted) {
  const ReadAttempt assembly = attempt("assembly_inch.step", 0.02);
  ASSERT_TRUE(assembly.ok()) << assembly.failure;
  ASSERT_TRUE(assembly.facts.unit.has_value());
  EXPECT_EQ(assembly.facts.unit->metres, 1e-3);
  ASSERT_TRUE(assembly.facts.written_in.has_value());
  EXPECT_EQ(assembly.facts.written_in->metres, 0.0254);
  EXPECT_TRUE(notes(assembly, "the file is in inch"));
  EXPECT_TRUE(notes(assembly, "tessellated with a deflection of 0.02 mm"));

  const PolygonSoup& soup = assembly.soup;
  ASSERT_EQ(soup.solids.size(), 3U);
  EXPECT_EQ(soup.solids[0].name, "drum");
  EXPECT_EQ(soup.solids[1].name, "drum");
  EXPECT_EQ(soup.solids[2].name, "ball");
  const double inch = 25.4, drum = 2 * pi * std::pow(inch, 3), ball = pi / 6 * std::pow(inch, 3);
  EXPECT_NEAR(solid(soup, 0).volume, drum, 0.02 * solid(soup, 0).area);
  EXPECT_NEAR(solid(soup, 1).volume, drum, 0.02 * solid(soup, 1).area);
  EXPECT_NEAR(solid(soup, 2).volume, ball, 0.02 * solid(soup, 2).area);
  const Bounds<3> standing = solid(soup, 0).bounds, lying = solid(soup, 1).bounds,
                  above = solid(soup, 2).bounds;
  EXPECT_NEAR(standing.upper[2], 2 * inch, 1e-9);
  EXPECT_NEAR(lying.lower[1], -2 * inch, 1e-9);
  EXPECT_NEAR(lying.upper[1], 0, 1e-9);
  EXPECT_NEAR(0.5 * (lying.lower[0] + lying.upper[0]), 5 * inch, 0.02);
  EXPECT_NEAR(above.upper[2], 4.5 * inch, 0.02);
}

TEST_F(ReadStep, LooseSurfacesOfIgesAreSewn) {
  const ReadAttempt drum = attempt("drum_inch.igs", 0.01);
  ASSERT_TRUE(drum.ok()) << drum.failure;
  EXPECT_TRUE(notes(drum, "the file is in inch"));
  EXPECT_TRUE(notes(drum, "3 surfaces that belong to no solid were sewn"));
  EXPECT_TRUE(notes(drum, "no edge is left open"));
  const MeshReport report = diagnosed(drum.soup);
  EXPECT_TRUE(report.usable());
  EXPECT_NEAR(report.volume, pi * 100 * 20, 0.01 * report.area);
}

TEST_F(ReadStep, AMissingFaceIsSaidAndStaysOpen) {
  const ReadAttempt box = attempt("open_box_inch.igs", 0);
  ASSERT_TRUE(box.ok()) << box.failure;
  EXPECT_TRUE(notes(box, "4 edges are left open"));
  EXPECT_EQ(diagnosed(box.soup).open_edges, 4U);
}

TEST_F(ReadStep, WithoutADeflectionItIsAThousandthOfTheDiagonal) {
  const ReadAttempt block = attempt("block_fillets_bore.step", 0);
  ASSERT_TRUE(block.facts.deflection.has_value());
  EXPECT_NEAR(*block.facts.deflection, 1e-3 * std::sqrt(60 * 60 + 40 * 40 + 20 * 20), 1e-4);
  EXPECT_NE(attempt("block_fillets_bore.step", 1e-5).failure.find("choose at least"), std::string::npos);
}

TEST_F(ReadStep, WhatIsNoStepIsRefusedInSilence) {
  const bernal::testing::Folder folder;
  const std::string whole =
      bernal::testing::text_of(std::filesystem::path(BERNAL_DATA) / "meshes/assembly_inch.step");
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  for (const auto& [name, content] :
       {std::pair<std::string, std::string>{"text.step", "this is no STEP"},
        {"text.iges", "this is no IGES"},
        {"text.brep", "this is no BREP"},
        {"cut.step", whole.substr(0, whole.size() / 4)},
        {"head.step", whole.substr(0, whole.find("DATA;")) + "DATA;\nENDSEC;\nEND-ISO-10303-21;\n"}}) {
    const ReadAttempt read = cad::read_with_opencascade(folder.write(name, content), 0);
    EXPECT_FALSE(read.ok()) << name;
    EXPECT_EQ(read.failure.find('\n'), std::string::npos) << read.failure;
  }
  EXPECT_TRUE(attempt("assembly_inch.step", 1).ok());
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(ReadStep, ExtensionsInAnyCase) {
  for (const char* name : {"a.step", "a.STP", "a.Iges", "a.igs", "a.BREP", "a.brp"})
    EXPECT_TRUE(cad::opencascade_reads(name)) << name;
  EXPECT_FALSE(cad::opencascade_reads("a.stl"));
}

}  // namespace read_step_test
}  // namespace bernal
