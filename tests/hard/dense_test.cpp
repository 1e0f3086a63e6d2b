#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "bernal/core/error.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/meshes.hpp"
#include "support/plans.hpp"

// Relaxation in containers that make it hard: parts that no sphere passes between, walls without thickness,
// sharp tips, spheres of very different sizes, more of them than fit.
namespace bernal {
namespace dense_test {

using testing::plan_of;

/// Has no part in it: the container is replaced.
const std::string container = "[container]\nkind = \"box\"\nsize = [4.0, 4.0, 4.0]\n[spheres]\n";
const std::string relax = "[[stage]]\ndo = \"relax\"\n";

Plan plan_in(const Domain& shape, const std::string& spheres, const std::string& stages = relax) {
  return plan_of(container + spheres + stages, shape);
}

/// The drawn sequence less its tail, of whose last ones a few may have found no place.
void expect_drawn(const Packing& packing, const Plan& plan) {
  constexpr std::size_t window = 16;
  RadiusSequence sequence(*plan.radii, packing.seed, *plan.scene.draw);
  std::size_t passed_over = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    while (packing.spheres.r[i] != sequence.next() && passed_over <= window) ++passed_over;
    ASSERT_LE(passed_over, window) << "by sphere " << i;
  }
}

Packing certified(const Plan& plan) {
  RunOptions options;
  options.threads = 1;
  Packing packing = run(plan, options);
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  expect_drawn(packing, plan);
  return packing;
}

Packing certified(const Domain& shape, const std::string& spheres, const std::string& stages = relax) {
  return certified(plan_in(shape, spheres, stages));
}

/// Of those spheres whose centres have x in [from, to), over `volume`.
double packing_fraction_between(const Packing& packing, double from, double to, double volume) {
  double sum = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i)
    if (packing.spheres.x[0][i] >= from && packing.spheres.x[0][i] < to)
      sum += 4.0 / 3.0 * std::numbers::pi * std::pow(packing.spheres.r[i], 3);
  return sum / volume;
}

const std::string fill = "fill = true\nradius = ";

/// Two cubes of edge 1 with a neck between them that is narrower than any sphere here.
Mesh two_chambers() { return test::scaled(test::two_cubes_mesh(0.1), 0.5); }

TEST(DenseRelaxation, FillsBothChambersThatANarrowNeckJoins) {
  const Packing packing = certified(two_chambers(), fill + "0.06\n");
  const double left = packing_fraction_between(packing, 0, 1, 1);
  const double right = packing_fraction_between(packing, 1.5, 2.5, 1);
  EXPECT_GT(left, 0.56);
  EXPECT_NEAR(left, right, 0.02);  // a sphere is 0.001, and one cube of them differs from another by some
  EXPECT_EQ(packing_fraction_between(packing, 1, 1.5, 0.005), 0);
}

TEST(DenseRelaxation, FillsBothSidesOfABaffle) {
  const double whole = certified(Box{{0, 0, 0}, {1, 1, 1}}, fill + "0.07\n").packing_fraction();
  for (const double thickness : {0.0, 1e-4}) {
    SCOPED_TRACE(thickness);
    const Mesh mesh =
        test::joined(test::box_mesh({-1, 0, 0}, {1, 1, 1}), test::box_mesh({thickness, 0, 0}, {1, 1, 1}));
    const Packing packing = certified(mesh, fill + "0.07\n");
    EXPECT_NEAR(packing_fraction_between(packing, -1, 0, 1), whole, 0.03);
    EXPECT_NEAR(packing_fraction_between(packing, 0, 2, 1), whole, 0.03);
  }
}

TEST(DenseRelaxation, AroundAnObstacle) {
  const Mesh cube = test::box_mesh({0, 0, 0}, {1, 1, 1});
  for (const Mesh& obstacle : {test::box_mesh({0.3, 0.3, 0.3}, {0.4, 0.4, 0.4}),
                               test::translated(test::icosphere_mesh(0.3, 2), {0.5, 0.5, 0.5}),
                               test::box_mesh({0.45, 0.1, 0.1}, {1e-3, 0.8, 0.8})}) {
    const Packing packing = certified(test::joined(cube, test::inverted(obstacle)), fill + "0.06\n");
    EXPECT_GT(packing.packing_fraction(), 0.5);
  }
}

TEST(DenseRelaxation, InSharpTips) {
  // Tetrahedra: one with a right-angled corner, one with an edge of 6° and a tip where nothing fits.
  Mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  EXPECT_GT(certified(tetrahedron, fill + "0.03\n").packing_fraction(), 0.45);
  tetrahedron.vertices[2] = {0.5, 0.1, 0.5};
  EXPECT_GT(certified(tetrahedron, fill + "0.012\n").packing_fraction(), 0.25);
}

TEST(DenseRelaxation, OfOneSphere) {
  for (const Domain& shape :
       {Domain(Box{{0, 0, 0}, {1, 1, 1}}), Domain(Sphere{{0, 0, 0}, 0.5}),
        Domain(test::box_mesh({0, 0, 0}, {1, 1, 1})), Domain(test::icosphere_mesh(0.6, 1))}) {
    for (const double r : {0.1, 0.4, 0.48}) {
      const Packing packing = certified(shape, "count = 1\nradius = " + std::to_string(r) + "\n");
      EXPECT_EQ(packing.spheres.size(), 1u) << r;
      EXPECT_EQ(packing.outcome, Outcome::converged);
    }
  }
}

TEST(DenseRelaxation, OfTwoSpheresThatFillAPipe) {
  for (const Domain& shape :
       {Domain(Cylinder{{0, 0, 0}, {0, 0, 1}, 0.5, 2}), Domain(test::box_mesh({0, 0, 0}, {1, 1, 2}))}) {
    const Packing packing = certified(shape, "count = 2\nradius = 0.49\n");
    EXPECT_EQ(packing.spheres.size(), 2u) << packing.reason;
    EXPECT_EQ(certified(shape, "count = 3\nradius = 0.49\n").spheres.size(), 2u);
  }
}

TEST(DenseRelaxation, OfSizesThatDifferTwentyfold) {
  const Packing packing = certified(
      test::box_mesh({0, 0, 0}, {0.9, 0.9, 0.9}),
      "fill = true\nradius = { distribution = \"uniform\", min = 0.012, max = 0.24, basis = \"volume\" }\n");
  EXPECT_GT(packing.packing_fraction(), 0.5);
  const auto [smallest, largest] = std::ranges::minmax(packing.spheres.r);
  EXPECT_GT(largest, 15 * smallest);
}

TEST(DenseRelaxation, OfFarMoreThanFitIsFull) {
  const std::string sizes = "radius = { distribution = \"uniform\", min = 0.04, max = 0.08 }\n";
  for (const Domain& shape : {Domain(Box{{0, 0, 0}, {1, 1, 1}}), Domain(test::l_shape_mesh())}) {
    const Packing packing = certified(shape, "count = 20000\n" + sizes);
    EXPECT_EQ(packing.outcome, Outcome::full) << packing.reason;
    EXPECT_GT(packing.packing_fraction(), 0.56);
    EXPECT_NE(packing.reason.find("20,000"), std::string::npos) << packing.reason;
  }
}

TEST(DenseRelaxation, OfACompressedBedLeavesNoLess) {
  const std::string compressed = "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\n";
  const std::string refilled = compressed + "[[stage]]\ndo = \"refill\"\n";
  for (const Domain& shape : {Domain(Cylinder{{0, 0, 0}, {0, 0, 1}, 0.5, 1}), Domain(test::l_shape_mesh())}) {
    for (const std::string& stages : {compressed, refilled}) {
      const Plan plan = plan_in(shape, fill + "0.07\n", stages);
      const Packing before = run(plan);
      const Packing after = certified(shape, fill + "0.07\n", stages + relax);
      EXPECT_GE(after.spheres.size(), before.spheres.size());
      EXPECT_GT(after.packing_fraction(), 0.52);
    }
  }
}

TEST(DenseRelaxation, OfAFewSpecksInAHugeContainerIsInsertion) {
  const Packing packing = certified(Box{{0, 0, 0}, {1, 1, 1}}, "count = 100\nradius = 1e-5\n");
  EXPECT_EQ(packing.outcome, Outcome::converged);
  EXPECT_EQ(packing.spheres.size(), 100u);
  EXPECT_TRUE(std::ranges::none_of(packing.effects, [](const Effect& e) { return e.name == "relaxation"; }));
}

TEST(DenseRelaxation, OfDustThatFillsAHugeContainerIsRefused) {
  try {
    plan_in(Box{{0, 0, 0}, {1, 1, 1}}, fill + "1e-5\n");
    FAIL() << "10^14 spheres";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    EXPECT_NE(std::string(error.what()).find("2^31"), std::string::npos) << error.what();
  }
}

TEST(DenseRelaxation, ThatIsOutOfTimeLeavesWhatIsFreeAndSaysSo) {
  for (const char* limit : {"seconds = 1e-3\n", "sweeps = 100\n"}) {
    const Packing packing = certified(Box{{0, 0, 0}, {1, 1, 1}}, fill + "0.04\n", relax + limit);
    EXPECT_EQ(packing.outcome, Outcome::hit_limit) << packing.reason;
    EXPECT_GT(packing.packing_fraction(), 0.4);
  }
}

TEST(DenseRelaxation, FarAwayAndAtAnyScale) {
  const std::string spheres = "fill = true\nradius = 0.08\n";
  const double at_home = certified(two_chambers(), spheres).packing_fraction();
  const auto expect_as_dense = [&](const Plan& plan) {
    EXPECT_NEAR(certified(plan).packing_fraction(), at_home, 0.02);
  };
  for (const double factor : {1e-9, 1e9})
    expect_as_dense(testing::scaled(plan_in(two_chambers(), spheres), factor));
  expect_as_dense(testing::shifted(plan_in(two_chambers(), spheres), {3e5, -2e5, 1e5}));
}

}  // namespace dense_test
}  // namespace bernal
