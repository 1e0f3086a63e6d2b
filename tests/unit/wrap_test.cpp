#include "cad/repair/wrap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bernal/core/error.hpp"
#include "cad/diagnose/mesh_distance.hpp"
#include "cad/repair/caged_repair.hpp"
#include "cad/triangle_tree.hpp"
#include "support/repaired_mesh.hpp"

namespace bernal {
namespace wrap_test {

using namespace test;
using namespace cad;

const Mesh unit_box = box_mesh({0, 0, 0}, {1, 1, 1});

double volume(const Mesh& mesh) { return volume_of(Domain(mesh)); }

bool same(const Mesh& a, const Mesh& b) { return a.vertices == b.vertices && a.triangles == b.triangles; }

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

TEST(Wrap, LiesWithinABoxOfShakenFaces) {
  const double shake = 0.002, alpha = 0.06, offset = 0.005;
  const Mesh soup = shaken_soup(divided(unit_box, 3), shake, 7);
  const RepairedMesh repaired = wrap(soup, alpha, offset);
  expect_sound(repaired);
  EXPECT_TRUE(says(repaired, "wrapped from inside (alpha 0.06, offset 0.005)")) << repaired.done;
  for (const Vector<3>& v : repaired.mesh.vertices) {
    EXPECT_GT(v.minCoeff(), 0);
    EXPECT_LT(v.maxCoeff(), 1);
  }
  // It crosses the soup nowhere.
  const Mesh both = joined(repaired.mesh, soup);
  for (const auto& [s, t] : self_intersecting_pairs(both))
    EXPECT_EQ(s < repaired.mesh.triangles.size(), t < repaired.mesh.triangles.size());
  // All but a layer of the offset and the shaking; and a chord of 2 alpha may cut the edges off.
  const double layer = offset + 2 * shake, edges = 12 * alpha * alpha;
  EXPECT_LT(volume(repaired.mesh), 1);
  EXPECT_GT(volume(repaired.mesh), std::pow(1 - 2 * layer, 3) - edges);
  EXPECT_LT(farthest(repaired.mesh, unit_box, {1e-3}).at_most, alpha);
}

TEST(Wrap, KeepsObstaclesAndChambersApart) {
  const Mesh part = joined(joined(divided(unit_box, 2), box_mesh({0.4, 0.4, 0.4}, {0.2, 0.2, 0.2})),
                           translated(divided(unit_box, 2), {2, 0, 0}));
  const double shake = 1e-4, alpha = 0.07, offset = 0.002;
  const RepairedMesh repaired = wrap(shaken_soup(part, shake, 3), alpha, offset);
  expect_sound(repaired);
  EXPECT_EQ(topology_of(repaired.mesh).components, 3U) << repaired.done;
  const double exact = 2 - 0.008, area = 12 + 0.24;
  EXPECT_LT(volume(repaired.mesh), exact);
  EXPECT_GT(volume(repaired.mesh), exact - area * (offset + 2 * shake) - 24 * alpha * alpha);
}

TEST(Wrap, LosesNoPlaceWhereASphereFits) {
  // Four legs of a square section through the walls of a body, each a piece of its own.
  const double half = 0.03, length = 1;
  Mesh part = divided(unit_box, 2);
  for (const Vector<3>& out : {Vector<3>(1, 0, 0), {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}) {
    const Vector<3> aside = Vector<3>::Constant(2 * half) - 2 * half * out.cwiseAbs();
    const Vector<3> from = Vector<3>::Constant(0.5) + 0.4 * out, to = from + length * out;
    const Vector<3> lower = from.cwiseMin(to) - aside / 2, upper = from.cwiseMax(to) + aside / 2;
    test::append(part, divided(box_mesh(lower, upper - lower), 3));
  }
  const Mesh soup = shaken_soup(part, 1e-5, 3);
  const RepairedMesh repaired = wrap_for_spheres(soup, 0.9 * half);
  expect_sound(repaired);
  const TriangleTree tree(repaired.mesh);
  for (const Vector<3>& out : {Vector<3>(1, 0, 0), {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}})
    for (const double along : {0.55, 0.75, 1.1, 1.36})
      EXPECT_EQ(tree.crossing(Vector<3>::Constant(0.5) + along * out, 2, 1e9), Crossing::odd)
          << along << ": " << repaired.done;
  EXPECT_EQ(what_is_left(soup, repaired.mesh), "");
  // Spheres that fit into no leg do not need them, and it is said that they went.
  const RepairedMesh coarse = wrap_for_spheres(soup, 0.3);
  EXPECT_NE(what_is_left(soup, coarse.mesh), "") << coarse.done;
}

TEST(Wrap, SaysWhenItLiesOutside) {
  const Mesh plate = box_mesh({0, 0, 0}, {1, 1, 0.08});
  const RepairedMesh outside = wrap(plate, 0.1, 0.01);
  expect_sound(outside);
  EXPECT_TRUE(says(outside, "wrapped from outside")) << outside.done;
  EXPECT_TRUE(says(outside, "too narrow for alpha")) << outside.done;
  EXPECT_LT(farthest(plate, outside.mesh, {1e-3}).at_most, 0.1);
}

TEST(Wrap, DoesNotTakeTheSkinOfASheetForAContainer) {
  const Mesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Mesh open = without_faces(divided(unit_box, 2), [](const Vector<3>& p) { return p[2] == 1; });
  for (const auto& [mesh, why] : {std::pair(sheet, "no inside was found"), {open, "gaps wider than alpha"}}) {
    const RepairedMesh none = wrap(mesh, 0.1, 0.01);
    EXPECT_TRUE(says(none, "not wrapped") && says(none, why) && says(none, "close its openings"))
        << none.done;
    EXPECT_TRUE(same(none.mesh, mesh));
  }
}

TEST(Wrap, EndsSoonWhereItGetsOut) {
  const Mesh open = without_faces(divided(unit_box, 2), [](const Vector<3>& p) { return p[2] == 1; });
  // Around both sides of the walls it would ask some three hundred times, once in 256 points; to look for the
  // inside takes some twenty.
  int asked = 0;
  const RepairedMesh none = wrap(open, 0.02, 0.001, {{}, [&] { return ++asked < 0; }});
  EXPECT_TRUE(says(none, "gaps wider than alpha")) << none.done;
  EXPECT_LT(asked, 60);
}

TEST(Wrap, ListensAndRefuses) {
  const RepairedMesh cancelled = wrap(unit_box, 0.02, 0.001, {{}, [] { return true; }});
  EXPECT_TRUE(says(cancelled, "cancelled")) << cancelled.done;
  EXPECT_TRUE(same(cancelled.mesh, unit_box));
  EXPECT_THROW(wrap(unit_box, -1, 0), Error);
  EXPECT_TRUE(says(wrap(Mesh{}, 1, 1), "no faces"));
}

}  // namespace wrap_test
}  // namespace bernal
