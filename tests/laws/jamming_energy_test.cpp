#include "jam/jamming_energy.hpp"

#include <gtest/gtest.h>

#include "bernal/core/random.hpp"
#include "bernal/scene/scene.hpp"
#include "support/containers.hpp"

// What every energy of soft spheres obeys, whatever the walls: its gradient is its slope and its Hessian that
// of the gradient, against differences.
namespace bernal {
namespace jamming_energy_test {

constexpr std::size_t spheres_tested = 60;

/// Spheres at random that overlap each other and press against the walls, but with their centres well inside.
Spheres<3> crowd_in(const Container& container, Random& random) {
  const Bounds<3> bounds = container.bounds();
  double widest = 0;
  for (int k = 0; k < 2000; ++k) {
    Vector<3> p;
    for (int a = 0; a < 3; ++a) p[a] = random.uniform(bounds.lower[a], bounds.upper[a]);
    widest = std::max(widest, container.clearance(p));
  }
  Spheres<3> spheres;
  while (spheres.size() < spheres_tested) {
    Vector<3> p;
    for (int a = 0; a < 3; ++a) p[a] = random.uniform(bounds.lower[a], bounds.upper[a]);
    const double r = random.uniform(0.3, 0.5) * widest, clearance = container.clearance(p);
    if (clearance > 0.85 * r && clearance < 1.5 * r) spheres.push_back(p, r);
  }
  return spheres;
}

Vector<3> edges_around(const Container& container, const Spheres<3>& spheres) {
  Vector<3> edges = container.bounds().size().array() + 8 * std::ranges::max(spheres.r);
  for (int k = 0; k < 3; ++k)
    if (container.boundary().repeats(k)) edges[k] = container.boundary().edges[k];
  return edges;
}

class SoftSpheres : public ::testing::TestWithParam<test::ContainerUnderTest> {};

INSTANTIATE_TEST_SUITE_P(, SoftSpheres, ::testing::ValuesIn(test::containers_under_test()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(SoftSpheres, HaveTheSlopesOfTheirEnergy) {
  const auto container = GetParam().container();
  Random random(5, stream(Stream::test));
  const Spheres<3> spheres = crowd_in(*container, random);
  for (const double smoothing : {0.0, 0.003}) {
    JammingEnergy<3> energy(spheres, edges_around(*container, spheres),
                            std::make_shared<Enclosure<3>>(*container));
    energy.set_level(0.01, smoothing);
    std::size_t walls = 0;
    for (const auto& contact : energy.contacts()) walls += !contact.is_pair();
    ASSERT_GT(walls, 5u);
    ASSERT_GT(energy.contacts().size(), walls);
    Eigen::VectorXd direction(energy.unknowns()), product(energy.unknowns());
    for (double& x : direction) x = random.uniform(-1, 1);
    // A kink of the second derivative that lies between the two ends shows with the share of one contact.
    const double h = 1e-6 * std::ranges::min(spheres.r);
    const Eigen::VectorXd gradient = energy.gradient();
    energy.hessian_times(direction, product);
    // In the coordinates of the place reached the slope of the dilation has moved on with the others'.
    product[energy.unknowns() - 1] += gradient.dot(direction);
    const double up = energy.move(h * direction);
    const Eigen::VectorXd above = energy.gradient();
    energy.take_back();
    const double down = energy.move(-h * direction);
    const Eigen::VectorXd below = energy.gradient();
    energy.take_back();
    const double curvature = direction.dot(product);
    EXPECT_NEAR((up - down) / (2 * h), gradient.dot(direction),
                1e-6 * gradient.norm() + h * std::abs(curvature));
    EXPECT_NEAR(((above - below) / (2 * h) - product).norm() / product.norm(), 0, 1e-5) << smoothing;
  }
}

}  // namespace jamming_energy_test
}  // namespace bernal
