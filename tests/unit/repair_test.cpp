// What is left of a broken surface after each repair: closed forms where the part is simple, sampling where
// not.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "cad/mesh_distance.hpp"
#include "cad/mesh_topology.hpp"
#include "cad/repair_crossings.hpp"
#include "cad/repair_holes.hpp"
#include "cad/self_intersections.hpp"
#include "cad/triangle_tree.hpp"
#include "cad/wrap.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace repair_test {

using namespace test;
using namespace cad;

constexpr double infinity = std::numeric_limits<double>::infinity();

const Mesh unit_box = box_mesh({0, 0, 0}, {1, 1, 1});

/// The mesh without the triangles for which `gone(middle)` holds.
template <class Gone>
Mesh without(Mesh mesh, const Gone& gone) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return gone(Vector<3>((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3));
  });
  return mesh;
}

double volume(const Mesh& mesh) { return volume_of(Domain(mesh)); }

bool says(const Mended& mended, std::string_view words) {
  return mended.done.find(words) != std::string::npos && mended.done.find('\n') == std::string::npos;
}

/// Closed, two-sided as it is oriented, and meeting itself nowhere.
void expect_sound(const Mended& mended) {
  const MeshTopology topology = topology_of(mended.mesh);
  EXPECT_TRUE(topology.closed()) << mended.done;
  EXPECT_EQ(topology.misoriented_edges, 0U) << mended.done;
  EXPECT_EQ(count_degenerate(mended.mesh), 0U) << mended.done;
  EXPECT_EQ(count_self_intersections(mended.mesh), 0U) << mended.done;
}

bool same(const Mesh& a, const Mesh& b) { return a.vertices == b.vertices && a.triangles == b.triangles; }

Vector<3> random_point(const Mesh& mesh, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform;
  const auto& t = mesh.triangles[random() % mesh.triangles.size()];
  const double u = std::sqrt(uniform(random)), v = uniform(random);
  return (1 - u) * mesh.vertices[t[0]] + u * (1 - v) * mesh.vertices[t[1]] + u * v * mesh.vertices[t[2]];
}

/// Every triangle with corners of its own, each moved by up to `by` along every axis, every other one turned.
Mesh shaken_soup(const Mesh& mesh, double by, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-by, by);
  Mesh soup;
  for (const auto& t : mesh.triangles) {
    const std::uint32_t first = index(soup.vertices.size());
    for (const std::uint32_t i : t)
      soup.vertices.push_back(mesh.vertices[i] +
                              Vector<3>(uniform(random), uniform(random), uniform(random)));
    soup.triangles.push_back({first, first + 1, first + 2});
    if (first % 2 == 0) std::swap(soup.triangles.back()[1], soup.triangles.back()[2]);
  }
  return soup;
}

// ---- How far apart two surfaces are.

TEST(MeshDistance, IsZeroBetweenTheSameAndKnowsTheSides) {
  const Deviation none = farthest(unit_box, unit_box, 1e-9);
  EXPECT_EQ(none.largest, 0);
  EXPECT_EQ(none.at_most, 0);

  const Mesh open = without(unit_box, [](const Vector<3>& p) { return p[2] == 1; });
  EXPECT_EQ(farthest(open, unit_box, 1e-9).at_most, 0);
  const Deviation lid = farthest(unit_box, open, 1e-4);  // the middle of the lid is 1/2 from its rim
  EXPECT_LE(lid.largest, 0.5 + 1e-15);
  EXPECT_GE(lid.at_most, 0.5);
  EXPECT_LE(lid.at_most - lid.largest, 1e-4 + 1e-12);
  EXPECT_NEAR((lid.place - Vector<3>(0.5, 0.5, 1)).norm(), 0, 0.02);
}

TEST(MeshDistance, BoundsHoldAgainstSampling) {
  const Mesh coarse = icosphere_mesh(1, 1), fine = icosphere_mesh(1, 4);
  const Mesh torus = translated(torus_mesh(1, 0.3, 40, 16), {0.1, 0.2, 0});
  for (const auto& [surface, reference] :
       {std::pair{coarse, fine}, {fine, coarse}, {torus, fine}, {coarse, torus}}) {
    const Deviation d = farthest(surface, reference, 1e-3);
    EXPECT_LE(d.at_most - d.largest, 1e-3 + 1e-12);
    const TriangleTree tree(reference);
    EXPECT_DOUBLE_EQ(tree.distance(d.place, infinity), d.largest);
    std::mt19937 random(1);
    double most = 0;
    for (int i = 0; i < 20'000; ++i)
      most = std::max(most, tree.distance(random_point(surface, random), infinity));
    EXPECT_LE(most, d.at_most);
    EXPECT_GE(most, 0.9 * d.largest);
  }
}

TEST(MeshDistance, HoldsWhenCutShort) {
  const Mesh coarse = icosphere_mesh(1, 0), fine = icosphere_mesh(1, 3);
  const Deviation all = farthest(coarse, fine, 1e-4), few = farthest(coarse, fine, 1e-4, {}, 10);
  EXPECT_GE(few.at_most, all.largest);
  EXPECT_LE(few.largest, all.at_most);
  EXPECT_GT(few.at_most - few.largest, 1e-4);
  EXPECT_EQ(farthest(coarse, fine, 1e-4, {{}, [] { return true; }}).at_most, infinity);
  EXPECT_THROW(farthest(coarse, Mesh{}, 1e-4), Error);
}

// ---- Holes.

TEST(RepairHoles, ClosesMissingFacesOfABox) {
  const auto lid = [](const Vector<3>& p) { return p[2] == 1; };
  const Mended one = close_holes(without(unit_box, lid), 1.5);
  expect_sound(one);
  EXPECT_DOUBLE_EQ(volume(one.mesh), 1);
  EXPECT_EQ(one.done, "closed 1 hole, 1.414 across");

  const Mended two = close_holes(without(unit_box, [](const auto& p) { return p[2] == 1 || p[0] == 0; }), 2);
  expect_sound(two);  // one rim around both, not flat
  EXPECT_NEAR(volume(two.mesh), 1, 0.51);
  EXPECT_TRUE(says(two, "closed 1 hole")) << two.done;

  const Mended ends =
      close_holes(without(divided(unit_box, 2), [](const auto& p) { return p[2] == 1 || p[2] == 0; }), 2);
  expect_sound(ends);
  EXPECT_DOUBLE_EQ(volume(ends.mesh), 1);
  EXPECT_TRUE(says(ends, "closed 2 holes, the widest 1.414 across")) << ends.done;
}

TEST(RepairHoles, AnOpenTopIsNoHoleUnlessAskedFor) {
  const Mesh open = without(divided(unit_box, 3), [](const Vector<3>& p) {
    return p[2] == 1 || (p[0] == 0 && std::abs(p[1] - 0.5) < 0.1 && std::abs(p[2] - 0.5) < 0.1);
  });
  const Mended all = close_holes(open, infinity);
  EXPECT_TRUE(says(all, "closed 1 hole")) << all.done;
  EXPECT_TRUE(says(all, "an open top rather than a hole")) << all.done;
  EXPECT_EQ(topology_of(all.mesh).open_edges, 32U);

  const Mended none = close_holes(open, 0.01);
  EXPECT_TRUE(same(none.mesh, open));
  EXPECT_EQ(none.done, "left 2 holes open: wider than 0.01 (up to 1.414 across)");
  EXPECT_EQ(close_holes(unit_box, infinity).done, "no holes to close");
}

TEST(RepairHoles, FillsAConcaveRimInItsPlane) {
  const Mended lid = close_holes(without(l_shape_mesh(), [](const Vector<3>& p) { return p[2] == 1; }), 5);
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
  const Mended mended = close_holes(without(whole, near_corner), infinity);
  expect_sound(mended);
  EXPECT_TRUE(says(mended, "closed 12 holes, the widest")) << mended.done;
  EXPECT_LT(volume(mended.mesh), volume(whole));
  EXPECT_GT(volume(mended.mesh), 0.97 * volume(whole));
  const Deviation off = farthest(mended.mesh, whole, 1e-3);
  EXPECT_LT(off.at_most, 0.05);

  int n = 0;
  const Mended sieve = close_holes(without(whole, [&](const auto&) { return n++ % 4 == 3; }), infinity);
  expect_sound(sieve);
  EXPECT_NEAR(volume(sieve.mesh), volume(whole), 1e-12) << "single faces come back as they were";
}

TEST(RepairHoles, DoesNotUseAnEdgeASecondTime) {
  Mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  const double whole = volume(tetrahedron);
  tetrahedron.triangles.resize(2);  // the rim is a quadrangle, one of whose diagonals is the edge left within
  const Mended mended = close_holes(tetrahedron, infinity);
  EXPECT_TRUE(says(mended, "an open top")) << mended.done;
  const Mended closed = close_holes(tetrahedron, 2);
  expect_sound(closed);
  EXPECT_DOUBLE_EQ(volume(closed.mesh), whole);
}

TEST(RepairHoles, TurnsFacesThatDisagree) {
  Mesh open = without(divided(unit_box, 2), [](const Vector<3>& p) { return p[2] == 1; });
  for (std::size_t t = 0; t < open.triangles.size(); t += 3)
    std::swap(open.triangles[t][1], open.triangles[t][2]);
  const Mended mended = close_holes(open, 2);
  expect_sound(mended);
  EXPECT_DOUBLE_EQ(volume(mended.mesh), 1);
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
  const Mended moebius = close_holes(band, infinity);
  EXPECT_TRUE(says(moebius, "one-sided")) << moebius.done;
  EXPECT_TRUE(same(moebius.mesh, band));

  Mesh finned = unit_box;  // a fin on an edge of the box
  finned.vertices.emplace_back(2, 2, 0);
  finned.vertices.emplace_back(2, 2, 1);
  finned.triangles.push_back({2, 8, 9});
  finned.triangles.push_back({2, 9, 6});
  const Mended fin = close_holes(finned, 5);
  EXPECT_TRUE(says(fin, "three or more faces meet at the rim")) << fin.done;

  const Mesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Mended flat = close_holes(sheet, 5);
  EXPECT_TRUE(same(flat.mesh, sheet) || topology_of(flat.mesh).open_edges == 4) << flat.done;
  EXPECT_TRUE(says(flat, "left 1 hole open")) << flat.done;
}

// ---- Crossings.

TEST(RepairCrossings, LeavesWhatDoesNotCross) {
  const Mesh two = joined(unit_box, translated(unit_box, {3, 0, 0}));
  const Mended mended = cut_out_crossings(two);
  EXPECT_TRUE(same(mended.mesh, two));
  EXPECT_EQ(mended.done, "nothing crosses");
}

TEST(RepairCrossings, BodiesThatCrossBecomeTheirUnion) {
  const Mended corner = cut_out_crossings(joined(unit_box, translated(unit_box, {0.5, 0.5, 0.5})));
  expect_sound(corner);
  EXPECT_NEAR(volume(corner.mesh), 1.875, 1e-14);
  EXPECT_EQ(corner.done, "united 2 bodies that cross");

  const Mended in_line = cut_out_crossings(joined(unit_box, translated(unit_box, {0.5, 0, 0})));
  expect_sound(in_line);  // four pairs of faces lie in common planes
  EXPECT_NEAR(volume(in_line.mesh), 1.5, 1e-14);

  const Mesh cylinder = prism_mesh(24, 0.3, 4);
  const Mended pierced = cut_out_crossings(joined(box_mesh({-1, -1, 1}, {2, 2, 2}), cylinder));
  expect_sound(pierced);
  EXPECT_NEAR(volume(pierced.mesh), 8 + volume(cylinder) / 2, 1e-13);

  const Mended baffle = cut_out_crossings(joined(unit_box, box_mesh({0.49, 0.3, -0.2}, {0.02, 0.4, 0.7})));
  expect_sound(baffle);
  EXPECT_NEAR(volume(baffle.mesh), 1 + 0.02 * 0.4 * 0.2, 1e-14);
}

TEST(RepairCrossings, BodiesThatTouchAreUnitedWhereThatIsASurface) {
  const Mended face = cut_out_crossings(joined(unit_box, translated(unit_box, {1, 0.5, 0})));
  expect_sound(face);
  EXPECT_DOUBLE_EQ(volume(face.mesh), 2);
  EXPECT_EQ(topology_of(face.mesh).components, 1U);

  const Mended shifted = cut_out_crossings(joined(unit_box, translated(unit_box, {1e-13, 2e-13, 1e-13})));
  expect_sound(shifted);
  EXPECT_NEAR(volume(shifted.mesh), 1, 1e-12);

  const Mended edge = cut_out_crossings(joined(unit_box, translated(unit_box, {1, 1, 0})));
  EXPECT_TRUE(says(edge, "1 body could not be united")) << edge.done;
  EXPECT_FALSE(says(edge, "united 1")) << edge.done;
  EXPECT_DOUBLE_EQ(volume(edge.mesh), 2);
}

TEST(RepairCrossings, WhatIsOrientedInwardIsTakenOut) {
  const Mesh hole = inverted(translated(unit_box, {0.5, 0.5, 0.5}));
  const Mended mended = cut_out_crossings(joined(unit_box, hole));
  expect_sound(mended);
  EXPECT_NEAR(volume(mended.mesh), 0.875, 1e-14);
  EXPECT_TRUE(says(mended, "took 1 body that is oriented inward out of its surroundings")) << mended.done;

  const Mended all_inward = cut_out_crossings(joined(inverted(unit_box), hole));
  EXPECT_NEAR(volume(all_inward.mesh), 1.875, 1e-14) << all_inward.done;
}

TEST(RepairCrossings, UnitesAChainOfManyAndLeavesOthers) {
  Mesh chain = translated(unit_box, {0, 50, 0});
  for (int i = 0; i < 9; ++i) chain = joined(chain, translated(icosphere_mesh(1, 2), {1.5 * i, 0.1 * i, 0}));
  const Mended mended = cut_out_crossings(chain);
  expect_sound(mended);
  EXPECT_EQ(topology_of(mended.mesh).components, 2U);
  EXPECT_EQ(mended.done, "united 9 bodies that cross");
  const double sphere = volume(icosphere_mesh(1, 2));
  EXPECT_LT(volume(mended.mesh), 1 + 9 * sphere);
  EXPECT_GT(volume(mended.mesh), 1 + 8 * sphere * 0.84375 + sphere - 0.2);  // caps of true spheres: 5/32 each
}

TEST(RepairCrossings, CutsOutWhereAPartCrossesItself) {
  Mesh spiked = icosphere_mesh(1, 3);  // one corner is pushed in through the opposite side
  spiked.vertices[0] *= -1.2;
  ASSERT_GT(count_self_intersections(spiked), 0U);
  const Mended mended = cut_out_crossings(spiked);
  expect_sound(mended);
  EXPECT_TRUE(says(mended, "where a part crosses itself")) << mended.done;
  EXPECT_NEAR(volume(mended.mesh), volume(icosphere_mesh(1, 3)), 0.2);
}

TEST(RepairCrossings, RepairsAPartOfSomebodyElse) {
  const Mesh part = read_mesh({.file = BERNAL_DATA "/meshes/openscad_bad_tardis.stl"}).mesh;
  ASSERT_EQ(count_self_intersections(part), 6U);
  const Mended mended = cut_out_crossings(part);
  expect_sound(mended);
  EXPECT_NEAR(volume(mended.mesh), volume(part), 1e-4 * volume(part));
  EXPECT_LT(farthest(mended.mesh, part, 1e-3).at_most, 0.01);
}

TEST(RepairCrossings, WhatRemainsIsCounted) {
  Mesh crumpled = divided(box_mesh({-1, -1, -1}, {2, 2, 2}), 4);
  for (Vector<3>& v : crumpled.vertices)
    v += 0.2 * Vector<3>(std::sin(91 * v[0] + 7 * v[1]), std::sin(53 * v[1] + 3 * v[2]),
                         std::sin(71 * v[2] + 5 * v[0]));
  const std::size_t before = count_self_intersections(crumpled);
  const Mended mended = cut_out_crossings(crumpled);
  const std::size_t after = count_self_intersections(mended.mesh);
  EXPECT_LE(after, before);
  EXPECT_TRUE(topology_of(mended.mesh).closed());
  if (after > 0) {
    EXPECT_TRUE(says(mended, std::to_string(after) + " of " + std::to_string(before) + " crossings remain"))
        << mended.done;
  }
}

TEST(RepairCrossings, AnOpenSheetStaysAndIsSaid) {
  const Mesh sheet{{{0.5, -1, -1}, {0.5, 2, -1}, {0.5, 2, 2}, {0.5, -1, 2}}, {{0, 1, 2}, {0, 2, 3}}};
  const Mended mended = cut_out_crossings(joined(unit_box, sheet));
  EXPECT_GT(count_self_intersections(mended.mesh), 0U);
  EXPECT_TRUE(says(mended, "remain")) << mended.done;
  EXPECT_TRUE(says(mended, "an open sheet")) << mended.done;
}

// ---- Wraps.

TEST(Wrap, LiesWithinABoxOfShakenFaces) {
  const double shake = 0.002, alpha = 0.06, offset = 0.005;
  const Mesh soup = shaken_soup(divided(unit_box, 3), shake, 7);
  const Mended mended = wrap(soup, alpha, offset);
  expect_sound(mended);
  EXPECT_TRUE(says(mended, "wrapped from inside (alpha 0.06, offset 0.005)")) << mended.done;
  for (const Vector<3>& v : mended.mesh.vertices) {
    EXPECT_GT(v.minCoeff(), 0);
    EXPECT_LT(v.maxCoeff(), 1);
  }
  // It crosses the soup nowhere.
  const Mesh both = joined(mended.mesh, soup);
  for (const auto& [s, t] : self_intersecting_pairs(both))
    EXPECT_EQ(s < mended.mesh.triangles.size(), t < mended.mesh.triangles.size());
  // All but a layer of the offset and the shaking; and a chord of 2 alpha may cut the edges off.
  const double layer = offset + 2 * shake, edges = 12 * alpha * alpha;
  EXPECT_LT(volume(mended.mesh), 1);
  EXPECT_GT(volume(mended.mesh), std::pow(1 - 2 * layer, 3) - edges);
  EXPECT_LT(farthest(mended.mesh, unit_box, 1e-3).at_most, alpha);
}

TEST(Wrap, KeepsObstaclesAndChambersApart) {
  const Mesh part = joined(joined(divided(unit_box, 2), box_mesh({0.4, 0.4, 0.4}, {0.2, 0.2, 0.2})),
                           translated(divided(unit_box, 2), {2, 0, 0}));
  const double shake = 1e-4, alpha = 0.07, offset = 0.002;
  const Mended mended = wrap(shaken_soup(part, shake, 3), alpha, offset);
  expect_sound(mended);
  EXPECT_EQ(topology_of(mended.mesh).components, 3U) << mended.done;
  const double exact = 2 - 0.008, area = 12 + 0.24;
  EXPECT_LT(volume(mended.mesh), exact);
  EXPECT_GT(volume(mended.mesh), exact - area * (offset + 2 * shake) - 24 * alpha * alpha);
}

TEST(Wrap, SaysWhenItLiesOutside) {
  const Mesh plate = box_mesh({0, 0, 0}, {1, 1, 0.08});
  const Mended outside = wrap(plate, 0.1, 0.01);
  expect_sound(outside);
  EXPECT_TRUE(says(outside, "wrapped from outside")) << outside.done;
  EXPECT_TRUE(says(outside, "too narrow for alpha")) << outside.done;
  EXPECT_LT(farthest(plate, outside.mesh, 1e-3).at_most, 0.1);
}

TEST(Wrap, DoesNotTakeTheSkinOfASheetForAContainer) {
  const Mesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Mesh open = without(divided(unit_box, 2), [](const Vector<3>& p) { return p[2] == 1; });
  for (const auto& [mesh, why] : {std::pair(sheet, "no inside was found"), {open, "gaps wider than alpha"}}) {
    const Mended none = wrap(mesh, 0.1, 0.01);
    EXPECT_TRUE(says(none, "not wrapped") && says(none, why) && says(none, "close its openings"))
        << none.done;
    EXPECT_TRUE(same(none.mesh, mesh));
  }
}

TEST(Wrap, ListensAndRefuses) {
  const Mended cancelled = wrap(unit_box, 0.02, 0.001, {{}, [] { return true; }});
  EXPECT_TRUE(says(cancelled, "cancelled")) << cancelled.done;
  EXPECT_TRUE(same(cancelled.mesh, unit_box));
  EXPECT_THROW(wrap(unit_box, -1, 0), Error);
  EXPECT_TRUE(says(wrap(Mesh{}, 1, 1), "no faces"));
}

}  // namespace repair_test
}  // namespace bernal
