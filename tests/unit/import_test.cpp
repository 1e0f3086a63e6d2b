// How a file becomes the container that its user means: seams, planes, hollows, solids, obstacles, repairs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bernal/cad/read_mesh.hpp"
#include "cad/repair/plane_cut.hpp"
#include "support/broken_meshes.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace import_test {

using namespace test;

class Import : public ::testing::Test {
 protected:
  MeshFile file(const Mesh& mesh, const char* name = "part.off") {
    return {.file = folder.write(name, as_off(mesh))};
  }
  ImportedMesh container(const MeshFile& options) { return read_container_mesh(options, {}); }
  double volume(const MeshFile& options) { return container(options).report.volume; }
  std::string refusal(const MeshFile& options) {
    try {
      container(options);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      return error.what();
    }
    return "is a container";
  }

  bernal::testing::Folder folder;
  const Mesh box = box_mesh({0, 0, 0}, {1, 2, 3});
};

TEST_F(Import, PlanesAreSumsOfCoordinates) {
  for (const char* text :
       {"z = 1.1", "z=1.1", " 1.1 = z", "z - 1.1 = 0", "2 z = 2.2", "2*z < 2.2", "-z > -1.1"}) {
    const cad::CutPlane plane = cad::plane_in(text);
    EXPECT_NEAR(plane.height({5, 6, 1.1}), 0, 1e-15) << text;
    EXPECT_GT(std::abs(plane.height({5, 6, 2.1})), 0.5) << text;
  }
  EXPECT_LT(cad::plane_in("x < 0.5").height({0, 0, 0}), 0);
  EXPECT_GT(cad::plane_in("x > 0.5").height({0, 0, 0}), 0);
  EXPECT_NEAR(cad::plane_in("3 x + 4 z = 10").height({0, 0, 0}), -2, 1e-15);  // of unit length
  for (const char* text : {"", "z", "z =", "= 1", "w = 1", "z = a", "z = 1 = 2", "x y = 1", "0 z = 1",
                           "z < inf", "z == 1", "1 = 1", "z = 1e999"})
    EXPECT_THROW(cad::plane_in(text), Error) << text;
}

TEST_F(Import, AnOpenTopIsClosedByAPlane) {
  MeshFile open = file(without_top(box, 3));
  EXPECT_NE(refusal(open).find("cap = \"z = 3\" helps"), std::string::npos) << refusal(open);
  for (const double level : {0.5, 2.25, 3.0}) {
    open.cap = {fmt::format("z = {}", level)};
    EXPECT_NEAR(volume(open), 2 * level, 1e-14) << level;
    open.cap.clear();
    open.fill_level = level;
    EXPECT_NEAR(volume(open), 2 * level, 1e-14) << level;
    open.fill_level.reset();
  }
  open.cap = {"x + z = 2"};  // the side that has a bottom
  EXPECT_NEAR(volume(open), 2 * 1.5, 1e-14);
  open.cap = {"z > 1"};
  EXPECT_NE(refusal(open).find("open edge"), std::string::npos);
  open.cap = {"z = 4"};
  EXPECT_NE(refusal(open).find("meets no surface"), std::string::npos);
  open.cap = {"z = -1"};
  EXPECT_NE(refusal(open).find("plane \"z = -1\""), std::string::npos);
}

TEST_F(Import, APipeIsClosedAtBothEnds) {
  const auto at_an_end = [](const Vector<3>& v) { return v[2] == 0 || v[2] == 3; };
  Mesh pipe = box;
  std::erase_if(pipe.triangles, [&](const auto& t) {
    return at_an_end(pipe.vertices[t[0]]) && pipe.vertices[t[0]][2] == pipe.vertices[t[1]][2] &&
           pipe.vertices[t[0]][2] == pipe.vertices[t[2]][2];
  });
  MeshFile open = file(pipe);
  EXPECT_NE(refusal(open).find("cap = [\"z = 0\", \"z = 3\"]"), std::string::npos) << refusal(open);
  open.cap = {"z = 0.5", "z = 2"};
  EXPECT_NEAR(volume(open), 2 * 1.5, 1e-14);
}

TEST_F(Import, AnObliqueOpeningIsClosedByTheLineThatIsOffered) {
  const Mesh tilted = turned(without_top(divided(box, 3), 3), {1, -2, 3});
  MeshFile open = file(tilted);
  const ImportedMesh as_it_is = read_mesh(open);
  ASSERT_FALSE(as_it_is.report.usable());
  const std::vector<std::string> lines = lines_that_help(open, {}, as_it_is, Effort::quick);
  ASSERT_FALSE(lines.empty());
  ASSERT_TRUE(lines[0].starts_with("cap = \"") && lines[0].ends_with('"')) << lines[0];
  open.cap = {lines[0].substr(7, lines[0].size() - 8)};
  EXPECT_NEAR(volume(open), 6, 6e-3) << lines[0];
  EXPECT_LE(volume(open), 6);
}

TEST_F(Import, APlaneThatWouldCutAnotherOpeningOffIsNotOffered) {
  MeshFile open = file(two_chimneys_mesh());
  const ImportedMesh as_it_is = read_mesh(open);
  ASSERT_FALSE(as_it_is.report.usable());
  const std::vector<std::string> lines = lines_that_help(open, {}, as_it_is, Effort::quick);
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.front(), "repair = [\"holes\"]");
  for (const std::string& line : lines) EXPECT_EQ(line.find("z = 6"), std::string::npos) << line;
  open.repair = {Repair::holes};
  EXPECT_NEAR(volume(open), 32, 1e-12);
}

TEST_F(Import, AWideRimThatIsNotFlatIsClosedByTheLineThatIsOffered) {
  // A cube without two sides that meet: no plane closes it, and its rim is as wide as the part.
  MeshFile open = file(without(divided(box_mesh({0, 0, 0}, {2, 2, 2}), 2),
                               [](const Vector<3>& p) { return p[2] == 2 || p[0] == 2; }));
  EXPECT_NE(refusal(open).find("largest_hole = "), std::string::npos) << refusal(open);
  open.largest_hole = 4;
  EXPECT_NE(refusal(open).find("needs repair"), std::string::npos) << refusal(open);
  open.repair = {Repair::holes};
  const double closed = volume(open);  // by the shortest way or over the missing edge
  EXPECT_TRUE(closed > 3.9 && closed < 8) << closed;
  open.largest_hole = 1;
  EXPECT_NE(refusal(open).find("wider than 1"), std::string::npos) << refusal(open);
}

TEST_F(Import, ADeflectionIsOfCurvedSurfaces) {
  MeshFile triangles = file(box);
  triangles.deflection = 0.1;
  EXPECT_NE(refusal(triangles).find("take the key out"), std::string::npos) << refusal(triangles);
  EXPECT_NE(refusal(triangles).find("STEP, IGES and BREP"), std::string::npos) << refusal(triangles);
}

TEST_F(Import, ASurfaceDrawnFromBothSidesIsOne) {
  Mesh both = box;
  for (const auto& [i, j, k] : box.triangles) both.triangles.push_back({k, j, i});
  EXPECT_NEAR(volume(file(both)), 6, 1e-14);
  both.triangles.pop_back();  // not all of it: something else is meant
  EXPECT_FALSE(refusal(file(both)).empty());
}

TEST_F(Import, WhatStandsInAnOpenVesselIsCutWithIt) {
  const Mesh rod = box_mesh({0.25, 0.5, 1}, {0.5, 1, 3});  // ends above the rim
  MeshFile open = file(joined(without_top(box, 3), rod));
  open.fill_level = 2;
  EXPECT_NEAR(volume(open), 2 * 2 - 0.5 * 1, 1e-14);
}

TEST_F(Import, AClosedPartIsFilledToALevel) {
  MeshFile part = file(icosphere_mesh(1, 4));
  part.fill_level = 0;
  EXPECT_NEAR(volume(part), volume(file(icosphere_mesh(1, 4))) / 2, 1e-12);
}

TEST_F(Import, TheHollowOfACup) {
  MeshFile cup = file(cup_mesh());
  EXPECT_NEAR(volume(cup), 4 * 4 * 2 - 2 * 2 * 1.5, 1e-13);
  cup.interior = Interior::cavity;
  EXPECT_NEAR(volume(cup), 2 * 2 * 1.5, 1e-13);
  cup.fill_level = 1;
  EXPECT_NEAR(volume(cup), 2 * 2 * 0.5, 1e-13);
  cup.fill_level.reset();
  cup.interior = Vector<3>(0, 0, 1);
  EXPECT_NEAR(volume(cup), 2 * 2 * 1.5, 1e-13);
  cup.interior = Vector<3>(1.5, 1.5, 1);
  EXPECT_NEAR(volume(cup), 4 * 4 * 2 - 2 * 2 * 1.5, 1e-13);
  cup.interior = Vector<3>(0, 0, 5);
  EXPECT_NE(refusal(cup).find("(0, 0, 5)"), std::string::npos) << refusal(cup);
}

TEST_F(Import, EveryHollowOfOneBrim) {
  MeshFile cups = file(joined(cup_mesh(), translated(cup_mesh(), {5, 0, 0})));
  cups.interior = Interior::cavity;
  EXPECT_NEAR(volume(cups), 2 * 2 * 2 * 1.5, 1e-12);
}

TEST_F(Import, ALevelAboveAClosedPartChangesNothing) {
  MeshFile part = file(box);
  EXPECT_EQ(container(part).report.cautions, std::vector<std::string>{});
  part.fill_level = 100;
  EXPECT_NEAR(volume(part), 6, 1e-14);
  part.fill_level.reset();
  part.cap = {"z = 2", "x = 7"};
  const MeshReport report = container(part).report;
  EXPECT_NEAR(report.volume, 4, 1e-14);
  ASSERT_EQ(report.cautions.size(), 1U);
  EXPECT_NE(report.cautions[0].find("\"x = 7\" cuts nothing off"), std::string::npos) << report.cautions[0];
}

TEST_F(Import, ACupWithARoundBrim) {
  Mesh cup = cup_mesh();
  const auto brim = index(cup.vertices.size());  // a roof over the four brims, its ridge at z = 2.5
  for (const auto& [x, y] : {std::pair{-1.5, -1.5}, {1.5, -1.5}, {1.5, 1.5}, {-1.5, 1.5}})
    cup.vertices.emplace_back(x, y, 2.5);
  std::erase_if(cup.triangles, [&](const auto& t) {
    return cup.vertices[t[0]][2] == 2 && cup.vertices[t[1]][2] == 2 && cup.vertices[t[2]][2] == 2;
  });
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    cup.triangles.insert(cup.triangles.end(), {{4 + i, 4 + j, brim + j},
                                               {4 + i, brim + j, brim + i},
                                               {brim + i, brim + j, 8 + j},
                                               {brim + i, 8 + j, 8 + i}});
  }
  MeshFile round = file(cup);
  round.interior = Interior::cavity;
  const double above = (9 + 4 + std::sqrt(9.0 * 4)) / 3 * 0.5;  // a frustum
  EXPECT_NEAR(volume(round), 2 * 2 * 1.5 + above, 1e-2);
}

TEST_F(Import, ATroughThatIsOpenAtItsEndsToo) {
  // A U of walls 1 thick, 4 wide and 3 high, 10 long.
  const Mesh trough = extrude({{0, 0}, {4, 0}, {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 10,
                              {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}, {0, 5, 6}, {0, 6, 7}});
  MeshFile part = file(trough);
  part.interior = Interior::cavity;
  EXPECT_NEAR(volume(part), 2 * 2 * 10, 1e-12);
  part.cap = {"y = 3", "z = 0", "z = 10"};
  EXPECT_NEAR(volume(part), 2 * 2 * 10, 1e-12);
  part.cap = {"y = 2", "z = 1", "z = 9"};
  EXPECT_NEAR(volume(part), 2 * 1 * 8, 1e-12);
  part.cap = {"y = 2"};
  EXPECT_NEAR(volume(part), 2 * 1 * 10, 1e-12);
}

TEST_F(Import, TheVoidsOfASolid) {
  const Mesh hollow = joined(box_mesh({0, 0, 0}, {4, 4, 4}), inverted(box_mesh({1, 1, 1}, {2, 2, 2})));
  const Mesh filled = joined(hollow, box_mesh({1.5, 1.5, 1.5}, {1, 1, 1}));
  MeshFile part = file(filled);
  EXPECT_NEAR(volume(part), 64 - 8 + 1, 1e-12);
  part.interior = Interior::cavity;
  EXPECT_NEAR(volume(part), 8 - 1, 1e-12);
  part.interior = Vector<3>(1.25, 2, 2);
  EXPECT_NEAR(volume(part), 8 - 1, 1e-12);
  part.interior = Vector<3>(2, 2, 2);
  EXPECT_NEAR(volume(part), 1, 1e-12);
  part.interior = Vector<3>(0.5, 2, 2);
  EXPECT_NEAR(volume(part), 64 - 8, 1e-12);
}

TEST_F(Import, ABoxHasNoHollow) {
  MeshFile part = file(box);
  part.interior = Interior::cavity;
  EXPECT_NE(refusal(part).find("no hollow"), std::string::npos);
  MeshFile open = file(without_top(box, 3));
  open.interior = Interior::cavity;
  EXPECT_NE(refusal(open).find("the surface is open"), std::string::npos);
  open.cap = {"z = 2"};
  EXPECT_NEAR(volume(open), 4, 1e-14);
}

TEST_F(Import, CornersThatDifferByRoundingAreWelded) {
  const double third = 1.0 / 3;
  const Mesh part = scaled(icosphere_mesh(1, 3), third);
  // Every face with corners of its own, each read to six digits after it was moved.
  const MeshFile unwelded{.file =
                              folder.write("unwelded.stl", as_text_stl(jittered(torn(part), 3e-7), "p", 6))};
  const ImportedMesh imported = container(unwelded);
  EXPECT_NEAR(imported.report.volume, volume(file(part)), 1e-5);
  EXPECT_EQ(imported.report.faces, part.triangles.size());

  MeshFile loose = file(jittered(torn(part), 1e-5));
  const std::string offered = refusal(loose);
  ASSERT_NE(offered.find("weld = "), std::string::npos) << offered;
  loose.weld = std::stod(offered.substr(offered.find("weld = ") + 7));
  EXPECT_LT(*loose.weld, 2e-4);
  EXPECT_NEAR(volume(loose), volume(file(part)), 1e-4);
}

TEST_F(Import, AClosedSurfaceKeepsItsCloseCorners) {
  Mesh needle = box_mesh({0, 0, 0}, {1, 1, 1e-9});
  MeshFile part = file(needle);
  part.weld = 1e-3;
  EXPECT_NEAR(volume(part), 1e-9, 1e-20);
}

TEST_F(Import, EdgesAreSplitAtTheirNeighboursCorners) {
  // A quarter of the lid is divided, and its neighbours do not know.
  Mesh part = without_top(box_mesh({0, 0, 0}, {1, 1, 1}), 1);
  const auto lid = index(part.vertices.size());
  for (const auto& [x, y] :
       {std::pair{0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}, {0.5, 0.}, {0.25, 0.}, {1., 0.3}})
    part.vertices.emplace_back(x, y, 1);
  for (const auto& [i, j, k] :
       {std::array{0U, 5U, 3U}, {5U, 4U, 3U}, {4U, 1U, 6U}, {4U, 6U, 2U}, {4U, 2U, 3U}})
    part.triangles.push_back({lid + i, lid + j, lid + k});
  const ImportedMesh imported = container(file(part));
  EXPECT_NEAR(imported.report.volume, 1, 1e-14);
  EXPECT_EQ(imported.report.open_edges, 0U);
}

TEST_F(Import, FacesWithoutAreaAndDoubledFacesAreDropped) {
  Mesh part = box_mesh({0, 0, 0}, {1, 1, 1});
  // The middle of one edge, and a face of three corners on that edge.
  const auto [a, b, c] = part.triangles[0];
  part.vertices.push_back((part.vertices[a] + part.vertices[b]) / 2);
  const auto middle = index(part.vertices.size() - 1);
  part.triangles.push_back({a, middle, b});
  part.triangles[0] = {a, middle, c};
  part.triangles.push_back({middle, b, c});
  ASSERT_NE(part.triangles.size(), 12U);
  EXPECT_NEAR(volume(file(part)), 1, 1e-14);

  Mesh doubled = box_mesh({0, 0, 0}, {1, 1, 1});
  const auto [i, j, k] = doubled.triangles[3];
  doubled.triangles.push_back({i, k, j});
  EXPECT_NEAR(volume(file(doubled)), 1, 1e-14);
}

TEST_F(Import, SolidsAreChosenByNumber) {
  MeshFile two = file(joined(box, box_mesh({5, 0, 0}, {1, 1, 1})));
  EXPECT_NEAR(volume(two), 7, 1e-13);
  two.solids = {"1"};
  EXPECT_NEAR(volume(two), 6, 1e-13);
  two.solids = {"2"};
  EXPECT_NEAR(volume(two), 1, 1e-13);
  two.solids = {"2", "1"};
  EXPECT_NEAR(volume(two), 7, 1e-13);
  two.solids = {"3"};
  EXPECT_NE(refusal(two).find("no solid \"3\"; it has 2 solids"), std::string::npos) << refusal(two);
}

TEST_F(Import, ObstaclesAreTakenOut) {
  MeshFile part = file(box_mesh({0, 0, 0}, {3, 3, 3}));
  part.obstacles = {file(box_mesh({1, 1, 1}, {1, 1, 1}), "inside.off").file};
  EXPECT_NEAR(volume(part), 26, 1e-13);
  part.obstacles = {file(box_mesh({1, 1, 2}, {1, 1, 5}), "through.off").file};
  EXPECT_NEAR(volume(part), 26, 1e-13);
  part.obstacles = {file(box_mesh({7, 1, 2}, {1, 1, 5}), "outside.off").file};
  EXPECT_NE(refusal(part).find("lies outside"), std::string::npos) << refusal(part);
  part.obstacles = {file(box_mesh({1, 1, -1}, {1, 1, 5}), "shaft.off").file};
  EXPECT_NEAR(volume(part), 24, 1e-12);
  part.obstacles = {file(box_mesh({-1, -1, 1}, {5, 5, 1}), "baffle.off").file};
  EXPECT_NEAR(volume(part), 18, 1e-12);
  part.obstacles = {file(box_mesh({-1, -1, -1}, {5, 5, 5}), "larger.off").file};
  EXPECT_NE(refusal(part).find("leaves nothing"), std::string::npos) << refusal(part);
  part.obstacles = {part.file};
  EXPECT_NE(refusal(part).find("leaves nothing"), std::string::npos) << refusal(part);
  part.obstacles = {folder / "inside.off", folder / "inside.off"};
  EXPECT_NE(refusal(part).find("twice"), std::string::npos) << refusal(part);
  part.obstacles = {file(without_top(box, 3), "open.off").file};
  EXPECT_NE(refusal(part).find("open.off cannot be an obstacle"), std::string::npos) << refusal(part);
}

TEST_F(Import, UpTurnsWithoutMirroring) {
  for (const Up up : {Up::x, Up::y, Up::z}) {
    MeshFile part = file(box_mesh({0, 0, 0}, {1, 2, 3}));
    part.up = up;
    const MeshReport report = container(part).report;
    EXPECT_NEAR(report.volume, 6, 1e-14);
    EXPECT_EQ(report.orientation, "outward");
    const double height = up == Up::x ? 1 : up == Up::y ? 2 : 3;
    EXPECT_EQ(report.bounds.lower[2], 0);
    EXPECT_EQ(report.bounds.upper[2], height);
  }
}

TEST_F(Import, LinesAreOfferedThatHelp) {
  const Mesh holed = without(icosphere_mesh(1, 3), [](const Vector<3>& v) { return v[0] > 0.95; });
  for (const Mesh& mesh :
       {holed, joined(box, translated(box, {0.5, 0.5, 0.5})), without_top(cup_mesh(), 0)}) {
    const MeshFile options = file(mesh);
    const ImportedMesh as_it_is = read_mesh(options);
    ASSERT_FALSE(as_it_is.report.usable());
    EXPECT_FALSE(as_it_is.report.defects.empty());
    EXPECT_FALSE(lines_that_help(options, {}, as_it_is, Effort::quick).empty());
  }
}

TEST_F(Import, RepairedWallsAreCalledSo) {
  MeshFile two = file(joined(box, translated(box, {0.5, 0.5, 0.5})));
  two.repair = {Repair::self_intersections};
  const MeshReport report = container(two).report;
  EXPECT_TRUE(report.is_repaired);
  EXPECT_NEAR(report.volume, 12 - 0.5 * 1.5 * 2.5, 1e-12);
  MeshFile sound = file(box);
  sound.repair = {Repair::holes, Repair::self_intersections, Repair::wrap};
  EXPECT_FALSE(container(sound).report.is_repaired);
}

TEST_F(Import, ThePlacesCanBeLookedAt) {
  const ImportedMesh imported = read_mesh(file(without_top(box, 3)));
  const auto written = folder / "bad.ply";
  write_places(imported, written);
  const MeshReport again = read_mesh({.file = written}).report;
  EXPECT_EQ(again.faces, imported.report.faces);
  EXPECT_EQ(again.bounds.upper, imported.report.bounds.upper);
}

}  // namespace import_test
}  // namespace bernal
