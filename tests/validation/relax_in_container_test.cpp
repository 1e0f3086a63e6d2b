#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "bernal/core/random.hpp"
#include "bernal/measure/wall_profile.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/measured.hpp"
#include "support/meshes.hpp"
#include "support/plans.hpp"

// What relaxation in a container must not depend on, and what is known of packings in tall cylinders.
namespace bernal {
namespace relax_in_container_test {

using testing::plan_of;

Packing certified(const Plan& plan) {
  Packing packing = run(plan);
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  return packing;
}

const std::string in_a_box = "[container]\nkind = \"box\"\nsize = [9.0, 9.0, 9.0]\n[spheres]\n";

Mesh turned(Mesh mesh, Random& random) {
  const Vector<3> axis = uniform_direction<3>(random);
  const Eigen::AngleAxisd rotation(random.uniform(0, 6.283), axis);
  for (Vector<3>& v : mesh.vertices) v = rotation * v;
  return mesh;
}

/// Three thousand spheres differ by 0.003 from seed to seed.
TEST(RelaxationInContainers, DoesNotDependOnHowTheContainerIsTurned) {
  Random random(11, stream(Stream::test));
  const Mesh upright = test::l_shape_mesh();
  const double attainable =
      plan_of(in_a_box + "fill = true\nradius = 0.05\n", upright).attainable_packing_fraction;
  // What is likely to be reached by itself, and more than can be: what it then ends at.
  const double beyond = attainable + 0.03;
  for (const std::string& target : {std::string(), "packing_fraction = " + std::to_string(beyond) + "\n"}) {
    const auto packing_fraction = [&](const Mesh& mesh) {
      return certified(plan_of(in_a_box + target + "radius = 0.05\n", mesh)).packing_fraction();
    };
    const double expected = packing_fraction(upright);
    EXPECT_NEAR(expected, attainable, target.empty() ? 0.02 : 0.023) << target;
    if (!target.empty()) {
      EXPECT_GT(expected, attainable);
    }
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(packing_fraction(turned(upright, random)), expected, 0.01);
  }
}

TEST(RelaxationInContainers, LeavesTheSizesAsTheyWereDrawn) {
  for (const char* sizes :
       {"radius = { distribution = \"lognormal\", median = 0.03, sigma = 0.3, max = 0.1 }\n",
        "radius = { distribution = \"uniform\", min = 0.02, max = 0.045 }\n"}) {
    const Plan plan = plan_of(in_a_box + "fill = true\n" + sizes, test::l_shape_mesh());
    ASSERT_EQ(*plan.scene.draw, Draw::quantiles);
    const Packing packing = certified(plan);
    ASSERT_GT(packing.spheres.size(), 10000u);
    RadiusSequence sequence(*plan.radii, packing.seed, *plan.scene.draw);
    double cubes = 0;
    for (const double r : packing.spheres.r) {
      ASSERT_EQ(r, sequence.next());
      cubes += r * r * r;
    }
    const double mean = cubes / static_cast<double>(packing.spheres.size());
    // Up to one of the largest more or less, that of the lognormal ones 25 times as large as most.
    const double one = std::pow(plan.radii->max(), 3) / cubes;
    EXPECT_NEAR(mean / plan.radii->moment(3), 1, one) << sizes;
  }
}

/// Cylinders D / d = `ratio` wide and high enough that the ends take up a tenth.
class TallCylinder : public ::testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(, TallCylinder, ::testing::Values(6, 10, 20),
                         [](const auto& tested) { return "Of" + std::to_string(int(tested.param)); });

TEST_P(TallCylinder, HasThePorosityOfItsWidth) {
  const double x = GetParam();
  const Packing packing = certified(plan_of(
      "[container]\nkind = \"cylinder\"\nradius = " + std::to_string(x / 2) +
      "\nheight = " + std::to_string(x < 15 ? 5 * x : 2 * x) + "\n[spheres]\nfill = true\nradius = 0.5\n"));
  // Zou & Yu, Chem. Eng. Sci. 50 (1995), the densest; Dixon, Can. J. Chem. Eng. 66 (1988), as poured.
  const double dense = 0.372 + 0.002 * (std::exp(15.306 / x) - 1);
  const double poured = 0.4 + 0.05 / x + 0.412 / (x * x);
  const double porosity = 1 - packing.packing_fraction();
  RecordProperty("porosity", std::to_string(porosity));
  EXPECT_GT(porosity, dense - 0.01);
  EXPECT_LT(porosity, poured + 0.03);

  // The first layer of spheres lies on the wall, cut in the middle half a diameter from it.
  const WallProfile profile = wall_profile(packing).value();
  EXPECT_NEAR(profile.mean_porosity, porosity, 1e-12);
  const double integral =
      std::accumulate(profile.layers.begin(), profile.layers.end(), 0.0,
                      [](double sum, const auto& layer) { return sum + layer.share * layer.porosity; });
  EXPECT_NEAR(integral, porosity, 1e-4);
  ASSERT_TRUE(profile.first_minimum.has_value());
  EXPECT_GT(profile.first_minimum->z, 0.45);
  EXPECT_LT(profile.first_minimum->z, 0.65);
  EXPECT_LT(profile.first_minimum->porosity, porosity - 0.05);
}

}  // namespace relax_in_container_test
}  // namespace bernal
