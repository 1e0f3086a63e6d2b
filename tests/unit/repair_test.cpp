// What is left of a broken surface after each repair: closed forms where the part is simple, sampling where
// not.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "bernal/cad/read_mesh.hpp"
#include "cad/diagnose/mesh_distance.hpp"
#include "cad/repair/repair_crossings.hpp"
#include "cad/repair/repair_holes.hpp"
#include "support/broken_meshes.hpp"
#include "support/repaired_mesh.hpp"

namespace bernal {
namespace repair_test {

using namespace test;
using namespace cad;

constexpr double infinity = std::numeric_limits<double>::infinity();

const Mesh unit_box = box_mesh({0, 0, 0}, {1, 1, 1});

double volume(const Mesh& mesh) { return volume_of(Domain(mesh)); }

bool same(const Mesh& a, const Mesh& b) { return a.vertices == b.vertices && a.triangles == b.triangles; }

// ---- Holes.

TEST(RepairHoles, ClosesMissingFacesOfABox) {
  const auto lid = [](const Vector<3>& p) { return p[2] == 1; };
  const RepairedMesh one = close_holes(without_faces(unit_box, lid), 1.5);
  expect_sound(one);
  EXPECT_DOUBLE_EQ(volume(one.mesh), 1);
  EXPECT_EQ(one.done, "closed 1 hole, 1.414 across");

  const RepairedMesh two =
      close_holes(without_faces(unit_box, [](const auto& p) { return p[2] == 1 || p[0] == 0; }), 2);
  expect_sound(two);  // one rim around both, not flat
  EXPECT_NEAR(volume(two.mesh), 1, 0.51);
  EXPECT_TRUE(says(two, "closed 1 hole")) << two.done;

  const RepairedMesh ends = close_holes(
      without_faces(divided(unit_box, 2), [](const auto& p) { return p[2] == 1 || p[2] == 0; }), 2);
  expect_sound(ends);
  EXPECT_DOUBLE_EQ(volume(ends.mesh), 1);
  EXPECT_TRUE(says(ends, "closed 2 holes, the widest 1.414 across")) << ends.done;
}

TEST(RepairHoles, AnOpenTopIsNoHoleUnlessAskedFor) {
  const Mesh open = without_faces(divided(unit_box, 3), [](const Vector<3>& p) {
    return p[2] == 1 || (p[0] == 0 && std::abs(p[1] - 0.5) < 0.1 && std::abs(p[2] - 0.5) < 0.1);
  });
  const RepairedMesh all = close_holes(open, infinity);
  EXPECT_TRUE(says(all, "closed 1 hole")) << all.done;
  EXPECT_TRUE(says(all, "an open top rather than a hole")) << all.done;
  EXPECT_EQ(topology_of(all.mesh).open_edges, 32U);

  const RepairedMesh none = close_holes(open, 0.01);
  EXPECT_TRUE(same(none.mesh, open));
  EXPECT_EQ(none.done, "left 2 holes open: wider than 0.01 (up to 1.414 across)");
  EXPECT_EQ(close_holes(unit_box, infinity).done, "no holes to close");
}

TEST(RepairHoles, FillsAConcaveRimInItsPlane) {
  const RepairedMesh lid =
      close_holes(without_faces(l_shape_mesh(), [](const Vector<3>& p) { return p[2] == 1; }), 5);
  expect_sound(lid);
  EXPECT_DOUBLE_EQ(volume(lid.mesh), 3);
}

TEST(RepairHoles, ClosesManyHolesOfACurvedSurface) {
  // Around the twelve corners of the icosahedron; then the middle one of every four faces, which meet in
  // corners.
  const Mesh whole = icosphere_mesh(1, 3);
  const auto near_corner = [&](const Vector<3>& p) {
    for (const Vector<3>& corner : icosphere_mesh(1, 0).vertices)
      if ((p - corner).norm() < 0.16) return true;
    return false;
  };
  const RepairedMesh repaired = close_holes(without_faces(whole, near_corner), infinity);
  expect_sound(repaired);
  EXPECT_TRUE(says(repaired, "closed 12 holes, the widest")) << repaired.done;
  EXPECT_LT(volume(repaired.mesh), volume(whole));
  EXPECT_GT(volume(repaired.mesh), 0.97 * volume(whole));
  const Deviation off = farthest(repaired.mesh, whole, {1e-3});
  EXPECT_LT(off.at_most, 0.05);

  int n = 0;
  const RepairedMesh sieve =
      close_holes(without_faces(whole, [&](const auto&) { return n++ % 4 == 3; }), infinity);
  expect_sound(sieve);
  EXPECT_NEAR(volume(sieve.mesh), volume(whole), 1e-12) << "single faces come back as they were";
}

TEST(RepairHoles, DoesNotUseAnEdgeASecondTime) {
  Mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  const double whole = volume(tetrahedron);
  tetrahedron.triangles.resize(2);  // the rim is a quadrangle, one of whose diagonals is the edge left within
  const RepairedMesh repaired = close_holes(tetrahedron, infinity);
  EXPECT_TRUE(says(repaired, "an open top")) << repaired.done;
  const RepairedMesh closed = close_holes(tetrahedron, 2);
  expect_sound(closed);
  EXPECT_DOUBLE_EQ(volume(closed.mesh), whole);
}

TEST(RepairHoles, TurnsFacesThatDisagree) {
  Mesh open = without_faces(divided(unit_box, 2), [](const Vector<3>& p) { return p[2] == 1; });
  for (std::size_t t = 0; t < open.triangles.size(); t += 3)
    std::swap(open.triangles[t][1], open.triangles[t][2]);
  const RepairedMesh repaired = close_holes(open, 2);
  expect_sound(repaired);
  EXPECT_DOUBLE_EQ(volume(repaired.mesh), 1);
}

TEST(RepairHoles, SaysWhereItCannot) {
  Mesh band;  // a Möbius band of 12 quadrangles
  for (int i = 0; i < 12; ++i) {
    const double a = i * std::numbers::pi / 6;
    const Vector<3> out(std::cos(a), std::sin(a), 0);
    for (const double s : {-0.3, 0.3})
      band.vertices.push_back(out + s * (std::cos(a / 2) * out + std::sin(a / 2) * Vector<3>::UnitZ()));
  }
  for (std::uint32_t i = 0; i < 12; ++i) {
    const bool last = i == 11;
    const std::uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    band.triangles.push_back({a, c, b});
    band.triangles.push_back({b, c, d});
  }
  const RepairedMesh moebius = close_holes(band, infinity);
  EXPECT_TRUE(says(moebius, "one-sided")) << moebius.done;
  EXPECT_TRUE(same(moebius.mesh, band));

  Mesh finned = unit_box;  // a fin on an edge of the box
  finned.vertices.emplace_back(2, 2, 0);
  finned.vertices.emplace_back(2, 2, 1);
  finned.triangles.push_back({2, 8, 9});
  finned.triangles.push_back({2, 9, 6});
  const RepairedMesh fin = close_holes(finned, 5);
  EXPECT_TRUE(says(fin, "three or more faces meet at the rim")) << fin.done;

  const Mesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const RepairedMesh flat = close_holes(sheet, 5);
  EXPECT_TRUE(same(flat.mesh, sheet) || topology_of(flat.mesh).open_edges == 4) << flat.done;
  EXPECT_TRUE(says(flat, "left 1 hole open")) << flat.done;
}

// ---- Crossings.

TEST(RepairCrossings, LeavesWhatDoesNotCross) {
  const Mesh two = joined(unit_box, translated(unit_box, {3, 0, 0}));
  const RepairedMesh repaired = cut_out_crossings(two);
  EXPECT_TRUE(same(repaired.mesh, two));
  EXPECT_EQ(repaired.done, "nothing crosses");
}

TEST(RepairCrossings, BodiesThatCrossBecomeTheirUnion) {
  const RepairedMesh corner = cut_out_crossings(joined(unit_box, translated(unit_box, {0.5, 0.5, 0.5})));
  expect_sound(corner);
  EXPECT_NEAR(volume(corner.mesh), 1.875, 1e-14);
  EXPECT_EQ(corner.done, "united 2 bodies that cross");

  const RepairedMesh in_line = cut_out_crossings(joined(unit_box, translated(unit_box, {0.5, 0, 0})));
  expect_sound(in_line);  // four pairs of faces lie in common planes
  EXPECT_NEAR(volume(in_line.mesh), 1.5, 1e-14);

  const Mesh cylinder = prism_mesh(24, 0.3, 4);
  const RepairedMesh pierced = cut_out_crossings(joined(box_mesh({-1, -1, 1}, {2, 2, 2}), cylinder));
  expect_sound(pierced);
  EXPECT_NEAR(volume(pierced.mesh), 8 + volume(cylinder) / 2, 1e-13);

  const RepairedMesh baffle =
      cut_out_crossings(joined(unit_box, box_mesh({0.49, 0.3, -0.2}, {0.02, 0.4, 0.7})));
  expect_sound(baffle);
  EXPECT_NEAR(volume(baffle.mesh), 1 + 0.02 * 0.4 * 0.2, 1e-14);
}

TEST(RepairCrossings, BodiesThatTouchAreUnitedWhereThatIsASurface) {
  const RepairedMesh face = cut_out_crossings(joined(unit_box, translated(unit_box, {1, 0.5, 0})));
  expect_sound(face);
  EXPECT_DOUBLE_EQ(volume(face.mesh), 2);
  EXPECT_EQ(topology_of(face.mesh).components, 1U);

  const RepairedMesh shifted =
      cut_out_crossings(joined(unit_box, translated(unit_box, {1e-13, 2e-13, 1e-13})));
  expect_sound(shifted);
  EXPECT_NEAR(volume(shifted.mesh), 1, 1e-12);

  const RepairedMesh edge = cut_out_crossings(joined(unit_box, translated(unit_box, {1, 1, 0})));
  EXPECT_TRUE(says(edge, "1 body could not be united")) << edge.done;
  EXPECT_FALSE(says(edge, "united 1")) << edge.done;
  EXPECT_DOUBLE_EQ(volume(edge.mesh), 2);
}

TEST(RepairCrossings, WhatIsOrientedInwardIsTakenOut) {
  const Mesh hole = inverted(translated(unit_box, {0.5, 0.5, 0.5}));
  const RepairedMesh repaired = cut_out_crossings(joined(unit_box, hole));
  expect_sound(repaired);
  EXPECT_NEAR(volume(repaired.mesh), 0.875, 1e-14);
  EXPECT_TRUE(says(repaired, "took 1 body that is oriented inward out of its surroundings")) << repaired.done;

  const RepairedMesh all_inward = cut_out_crossings(joined(inverted(unit_box), hole));
  EXPECT_NEAR(volume(all_inward.mesh), 1.875, 1e-14) << all_inward.done;
}

TEST(RepairCrossings, UnitesAChainOfManyAndLeavesOthers) {
  Mesh chain = translated(unit_box, {0, 50, 0});
  for (int i = 0; i < 9; ++i) chain = joined(chain, translated(icosphere_mesh(1, 2), {1.5 * i, 0.1 * i, 0}));
  const RepairedMesh repaired = cut_out_crossings(chain);
  expect_sound(repaired);
  EXPECT_EQ(topology_of(repaired.mesh).components, 2U);
  EXPECT_EQ(repaired.done, "united 9 bodies that cross");
  const double sphere = volume(icosphere_mesh(1, 2));
  EXPECT_LT(volume(repaired.mesh), 1 + 9 * sphere);
  EXPECT_GT(volume(repaired.mesh),
            1 + 8 * sphere * 0.84375 + sphere - 0.2);  // caps of true spheres: 5/32 each
}

TEST(RepairCrossings, OfAPartThatCrossesItselfAllStaysThatItWindsAround) {
  const Mesh eight = figure_of_eight_mesh();
  Mesh inward = eight;
  for (auto& t : inward.triangles) std::swap(t[1], t[2]);
  for (const Mesh& mesh : {eight, inward, joined(eight, box_mesh({10, 0, 0}, {1, 1, 1}))}) {
    const RepairedMesh repaired = cut_out_crossings(mesh);
    expect_sound(repaired);
    EXPECT_TRUE(says(repaired, "outer walls are kept")) << repaired.done;
    const double rest = mesh.triangles.size() > eight.triangles.size() ? 1 : 0;
    EXPECT_NEAR(std::abs(volume(repaired.mesh)), figure_of_eight_volume() + rest, 1e-9) << repaired.done;
    EXPECT_LT(farthest(repaired.mesh, mesh, {1e-6}).at_most, 1e-6);  // it has no walls of its own
  }
}

TEST(RepairCrossings, CutsOutWhereAPartCrossesItself) {
  Mesh spiked = icosphere_mesh(1, 3);  // one corner is pushed in through the opposite side
  spiked.vertices[0] *= -1.2;
  ASSERT_GT(count_self_intersections(spiked), 0U);
  const RepairedMesh repaired = cut_out_crossings(spiked);
  expect_sound(repaired);
  EXPECT_TRUE(says(repaired, "crosses itself")) << repaired.done;
  EXPECT_NEAR(volume(repaired.mesh), volume(icosphere_mesh(1, 3)), 0.2);
}

TEST(RepairCrossings, SaysWhereRoomMayBeLost) {
  const RepairedMesh repaired = cut_out_crossings(divided(figure_of_eight_mesh(0), 3));  // faces coincide
  expect_sound(repaired);
  EXPECT_TRUE(says(repaired, "some room may be lost")) << repaired.done;
}

TEST(RepairCrossings, RepairsAPartOfSomebodyElse) {
  const Mesh part = read_mesh({.file = BERNAL_DATA "/meshes/openscad_bad_tardis.stl"}).mesh;
  ASSERT_EQ(count_self_intersections(part), 6U);
  const RepairedMesh repaired = cut_out_crossings(part);
  expect_sound(repaired);
  EXPECT_NEAR(volume(repaired.mesh), volume(part), 1e-4 * volume(part));
  EXPECT_LT(farthest(repaired.mesh, part, {1e-3}).at_most, 0.01);
}

TEST(RepairCrossings, WhatRemainsIsCounted) {
  Mesh crumpled = divided(box_mesh({-1, -1, -1}, {2, 2, 2}), 4);
  for (Vector<3>& v : crumpled.vertices)
    v += 0.2 * Vector<3>(std::sin(91 * v[0] + 7 * v[1]), std::sin(53 * v[1] + 3 * v[2]),
                         std::sin(71 * v[2] + 5 * v[0]));
  const std::size_t before = count_self_intersections(crumpled);
  const RepairedMesh repaired = cut_out_crossings(crumpled);
  const std::size_t after = count_self_intersections(repaired.mesh);
  EXPECT_LE(after, before);
  EXPECT_TRUE(topology_of(repaired.mesh).closed());
  if (after > 0) {
    EXPECT_TRUE(says(repaired, std::to_string(after) + " of " + std::to_string(before) + " crossings remain"))
        << repaired.done;
  }
}

TEST(RepairCrossings, AnOpenSheetStaysAndIsSaid) {
  const Mesh sheet{{{0.5, -1, -1}, {0.5, 2, -1}, {0.5, 2, 2}, {0.5, -1, 2}}, {{0, 1, 2}, {0, 2, 3}}};
  const RepairedMesh repaired = cut_out_crossings(joined(unit_box, sheet));
  EXPECT_GT(count_self_intersections(repaired.mesh), 0U);
  EXPECT_TRUE(says(repaired, "remain")) << repaired.done;
  EXPECT_TRUE(says(repaired, "an open sheet")) << repaired.done;
}

}  // namespace repair_test
}  // namespace bernal
