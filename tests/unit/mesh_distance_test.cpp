#include "cad/diagnose/mesh_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "bernal/core/error.hpp"
#include "cad/triangle_tree.hpp"
#include "support/repaired_mesh.hpp"

namespace bernal {
namespace mesh_distance_test {

using namespace test;
using namespace cad;

constexpr double infinity = std::numeric_limits<double>::infinity();

const Mesh unit_box = box_mesh({0, 0, 0}, {1, 1, 1});

Vector<3> random_point(const Mesh& mesh, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform;
  const auto& t = mesh.triangles[random() % mesh.triangles.size()];
  const double u = std::sqrt(uniform(random)), v = uniform(random);
  return (1 - u) * mesh.vertices[t[0]] + u * (1 - v) * mesh.vertices[t[1]] + u * v * mesh.vertices[t[2]];
}

TEST(MeshDistance, IsZeroBetweenTheSameAndKnowsTheSides) {
  const Deviation none = farthest(unit_box, unit_box, {1e-9});
  EXPECT_EQ(none.largest, 0);
  EXPECT_EQ(none.at_most, 0);

  const Mesh open = without_faces(unit_box, [](const Vector<3>& p) { return p[2] == 1; });
  EXPECT_EQ(farthest(open, unit_box, {1e-9}).at_most, 0);
  const Deviation lid = farthest(unit_box, open, {1e-4});  // the middle of the lid is 1/2 from its rim
  EXPECT_LE(lid.largest, 0.5 + 1e-15);
  EXPECT_GE(lid.at_most, 0.5);
  EXPECT_LE(lid.at_most - lid.largest, 1e-4 + 1e-12);
  EXPECT_NEAR((lid.place - Vector<3>(0.5, 0.5, 1)).norm(), 0, 0.02);
}

/// What is asked for is less than coordinates so large can tell.
TEST(MeshDistance, FarAwayIsKnownToTheRoundingInFewLooks) {
  Mesh box = unit_box, moved = unit_box;
  const double far = 0x1p52;
  for (Vector<3>& v : box.vertices) v = 100 * v + Vector<3>::Constant(far);
  for (Vector<3>& v : moved.vertices) v = 100 * v + Vector<3>(far + 3, far, far);
  const Deviation found = farthest(box, divided(moved, 1), {1e-2}, {}, 20'000);
  EXPECT_GE(found.at_most, 3);
  EXPECT_LE(found.largest, 3 + 64);
  EXPECT_LE(found.at_most - found.largest, 4 * 64);
}

/// The same surface in other triangles: bounds meet after so few looks that no halving brings them there.
TEST(MeshDistance, OfAFaceCutDifferentlyIsNoneAtOnce) {
  Mesh turned = unit_box;  // in a mirror: the other diagonal of most sides
  for (Vector<3>& v : turned.vertices) v[0] = 1 - v[0];
  for (auto& t : turned.triangles) std::swap(t[1], t[2]);
  EXPECT_DOUBLE_EQ(volume_of(Domain(turned)), 1);
  for (const auto& [surface, reference] :
       {std::pair{turned, unit_box}, {divided(turned, 2), unit_box}, {turned, divided(unit_box, 3)}}) {
    const Deviation none = farthest(surface, reference, {1e-9}, {}, 5000);
    EXPECT_LE(none.largest, 1e-15);
    EXPECT_LE(none.at_most, 1e-9);
  }
}

TEST(MeshDistance, BoundsHoldAgainstSampling) {
  const Mesh coarse = icosphere_mesh(1, 1), fine = icosphere_mesh(1, 4);
  const Mesh torus = translated(torus_mesh(1, 0.3, 40, 16), {0.1, 0.2, 0});
  for (const auto& [surface, reference] :
       {std::pair{coarse, fine}, {fine, coarse}, {torus, fine}, {coarse, torus}}) {
    const Deviation d = farthest(surface, reference, {1e-3});
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
  const Deviation all = farthest(coarse, fine, {1e-4}), few = farthest(coarse, fine, {1e-4}, {}, 10);
  EXPECT_GE(few.at_most, all.largest);
  EXPECT_LE(few.largest, all.at_most);
  EXPECT_GT(few.at_most - few.largest, 1e-4);
  EXPECT_EQ(farthest(coarse, fine, {1e-4}, {{}, [] { return true; }}).at_most, infinity);
  EXPECT_THROW(farthest(coarse, Mesh{}, {1e-4}), Error);
}

}  // namespace mesh_distance_test
}  // namespace bernal
