#include "soft/crowd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/error.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace crowd_test {

struct CrowdUnderTest {
  std::unique_ptr<Container> container;
  Places places;
  Random random;
  CrowdInContainer crowd;

  CrowdUnderTest(std::unique_ptr<Container> of, Spheres<3> spheres)
      : container(std::move(of)),
        places(*container),
        random(1, stream(Stream::test)),
        crowd(ContainerGround(*container, places), std::move(spheres)) {}
  /// With this margin at first.
  CrowdUnderTest(std::unique_ptr<Container> of, Spheres<3> spheres, double margin)
      : container(std::move(of)),
        places(*container),
        random(1, stream(Stream::test)),
        crowd(ContainerGround(*container, places, false, false, margin), std::move(spheres)) {}

  StageEnd settle() {
    return crowd.settle({}, [] {});
  }
  /// They count as free of overlap in motion, a few more sweeps bring all of them there: as stages do.
  void come_to_rest() {
    for (int k = 0; k < 4; ++k) (void)settle();
  }
  StageEnd relax(double patience) {
    return crowd.relax({.patience = patience,
                        .hopeless_patience = patience,
                        .failures_a_burst = std::numeric_limits<int>::max(),
                        .milestone = {},
                        .is_over = [] { return false; }},
                       {}, random);
  }
};

std::unique_ptr<Container> box_of(const Vector<3>& size) {
  return make_analytic_container(Box{Vector<3>::Zero(), size}, WallArithmetic::filtered, 0x1p-50);
}

/// At random in the bounds, with radii from half of `largest` to it, which take up `phi` of their volume.
Spheres<3> random_spheres(const Bounds<3>& bounds, double largest, double phi) {
  Random random(2, stream(Stream::test));
  Spheres<3> spheres;
  for (double volume = 0; volume < phi * bounds.volume();) {
    spheres.push_back(uniform_point(random, bounds), random.uniform(0.5 * largest, largest));
    volume += 4.0 / 3.0 * std::numbers::pi * std::pow(spheres.r.back(), 3);
  }
  return spheres;
}

/// "" where there is none.
std::string first_overlap(const Spheres<3>& spheres, const Container& container) {
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (!container.contains(spheres.center(i), spheres.r[i])) return fmt::format("{} and a wall", i);
    for (std::size_t j = 0; j < i; ++j)
      if (container.boundary().minimum_image(spheres.center(i) - spheres.center(j)).norm() <
          spheres.r[i] + spheres.r[j])
        return fmt::format("{} and {}", i, j);
  }
  return "";
}

void expect_free(const Spheres<3>& spheres, const Container& container) {
  EXPECT_EQ(first_overlap(spheres, container), "");
}

TEST(Crowd, ComesFreeWhereThereIsRoom) {
  const Spheres<3> spheres = random_spheres({{0, 0, 0}, {1, 1, 1}}, 0.08, 0.45);
  CrowdUnderTest tested(box_of({1, 1, 1}), spheres);
  EXPECT_EQ(tested.settle(), StageEnd::converged);
  EXPECT_EQ(tested.crowd.spheres().r, spheres.r);
  expect_free(tested.crowd.spheres(), *tested.container);
}

/// Along all axes that repeat themselves, one of them and none: spheres meet across the seam.
TEST(Crowd, ComesFreeWhereSpaceRepeatsItself) {
  const Domain domains[] = {Cylinder{{0.5, 0.5, 0}, {0, 0, 1}, 0.5, 1.3, true},
                            Box{{0, 0, 0}, {1, 1, 1}, {true, false, true}},
                            Box{{0, 0, 0}, {1, 1, 1}, {true, true, true}}};
  for (const Domain& domain : domains) {
    SCOPED_TRACE(name_of(domain));
    auto container = make_analytic_container(domain, WallArithmetic::filtered, 0x1p-50);
    Spheres<3> spheres = random_spheres(container->bounds(), 0.08, 0.35);
    for (std::size_t i = 0; i < spheres.size(); ++i)
      while (!(container->clearance(spheres.center(i)) > 0))
        spheres.set_center(i, 0.5 * (spheres.center(i) + container->bounds().center()));
    CrowdUnderTest tested(std::move(container), spheres);
    ASSERT_EQ(tested.settle(), StageEnd::converged);
    expect_free(tested.crowd.spheres(), *tested.container);
    const Boundary<3>& boundary = tested.container->boundary();
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const Vector<3> c = tested.crowd.spheres().center(i);
      EXPECT_EQ(boundary.wrap(c), c);
      for (int k = 0; k < 3 && i == 0; ++k) {
        if (!boundary.repeats(k)) continue;
        const std::vector<double>& x = tested.crowd.spheres().x[static_cast<std::size_t>(k)];
        EXPECT_LT(std::ranges::min(x), boundary.origin[k] + 0.04) << "a wall stands at the seam";
        EXPECT_GT(std::ranges::max(x), boundary.origin[k] + boundary.edges[k] - 0.04);
      }
    }
    tested.crowd.relocate(0.1, tested.random);
    EXPECT_EQ(tested.settle(), StageEnd::converged);
    expect_free(tested.crowd.spheres(), *tested.container);
  }
}

TEST(Crowd, GetsStuckWhereThereIsNone) {
  CrowdUnderTest tested(box_of({1, 1, 1}), random_spheres({{0, 0, 0}, {1, 1, 1}}, 0.1, 0.8));
  EXPECT_EQ(tested.settle(), StageEnd::full);
  EXPECT_GT(tested.crowd.largest_overlap(), 0.01);
  EXPECT_GT(tested.crowd.mean_squeeze(), 0.01);
}

TEST(Crowd, WithAWideMarginComesFreeInFewerSweeps) {
  const Spheres<3> spheres = random_spheres({{0, 0, 0}, {1, 1, 1}}, 0.08, 0.5);
  double sweeps = 0;
  for (const double margin : {1e-4, 2e-2}) {
    CrowdUnderTest tested(box_of({1, 1, 1}), spheres, margin);
    ASSERT_EQ(tested.relax(12), StageEnd::converged);
    if (sweeps > 0) {
      EXPECT_LT(tested.crowd.sweeps(), sweeps);
    }
    sweeps = tested.crowd.sweeps();
    EXPECT_EQ(tested.crowd.spheres().r, spheres.r);
    tested.come_to_rest();
    expect_free(tested.crowd.spheres(), *tested.container);
  }
}

TEST(Crowd, NarrowsAMarginThatIsTooWide) {
  const Spheres<3> spheres = random_spheres({{0, 0, 0}, {1, 1, 1}}, 0.08, 0.56);
  constexpr double too_wide = 0.015;  // they would fill 0.586
  CrowdUnderTest tested(box_of({1, 1, 1}), spheres, too_wide);
  ASSERT_EQ(tested.relax(20), StageEnd::converged);
  EXPECT_EQ(tested.crowd.spheres().r, spheres.r);
  const double margin = std::exp(std::log(tested.crowd.largest_overlap()) / tested.crowd.done());
  EXPECT_LT(margin, 0.51 * too_wide);
  tested.come_to_rest();
  expect_free(tested.crowd.spheres(), *tested.container);
}

TEST(ContainerGround, NarrowsItsMarginToTheLeast) {
  const std::unique_ptr<Container> container = box_of({1, 1, 1});
  const Places places(*container);
  ContainerGround ground(*container, places, false, false, 1e-3);
  ground.place(random_spheres({{0, 0, 0}, {1, 1, 1}}, 0.08, 0.3));
  std::vector<double> margins{ground.margin()};
  while (ground.narrow_margin()) margins.push_back(ground.margin());
  EXPECT_EQ(margins, (std::vector<double>{1e-3, 5e-4, 2.5e-4, 1.25e-4, 1e-4}));
  EXPECT_EQ(ground.margin(), 1e-4);
}

/// From random places some spheres are thrown about in every sweep: not on their account are the lists of all
/// built each time.
TEST(Crowd, BuildsListsForMostOfItsSpheres) {
  constexpr double r = 0.014;
  Random random(3, stream(Stream::test));
  Spheres<3> spheres;
  for (int i = 0; i < 30000; ++i)
    spheres.push_back(uniform_point(random, Bounds<3>{{0, 0, 0}, {1, 1, 1}}),
                      r * std::exp(0.3 * random.uniform(-2, 2)));
  CrowdUnderTest tested(box_of({1, 1, 1}), spheres, 1e-3);
  double looks = 0;
  (void)tested.crowd.settle(
      {}, [&] { ++looks; }, 40);
  EXPECT_EQ(looks, 2);
  EXPECT_LT(static_cast<double>(tested.crowd.lists_built().calls), tested.crowd.sweeps() / 2);
}

TEST(Crowd, StopsWhenItIsTold) {
  CrowdUnderTest tested(box_of({1, 1, 1}), random_spheres({{0, 0, 0}, {1, 1, 1}}, 0.1, 0.8));
  Monitor monitor;
  monitor.cancelled = [] { return true; };
  EXPECT_EQ(tested.crowd.settle(monitor, [] {}), StageEnd::cancelled);
  EXPECT_EQ(tested.crowd.sweeps(), 1u);
}

TEST(Crowd, ThatLosesItsLastKeepsTheOthersToTheBit) {
  const Spheres<3> spheres = random_spheres({{0, 0, 0}, {1, 1, 1}}, 0.1, 0.8);
  CrowdUnderTest tested(box_of({1, 1, 1}), spheres);
  tested.settle();
  tested.crowd.drop_last(40, tested.random);
  ASSERT_EQ(tested.crowd.size(), spheres.size() - 40);
  for (std::size_t i = 0; i < tested.crowd.size(); ++i) {
    EXPECT_EQ(tested.crowd.spheres().r[i], spheres.r[i]);
    EXPECT_TRUE(tested.container->contains(tested.crowd.spheres().center(i), 0));
  }
  tested.settle();
  tested.crowd.drop_last(100000, tested.random);  // never all
  EXPECT_EQ(tested.crowd.size(), 1u);
  EXPECT_EQ(tested.crowd.spheres().r[0], spheres.r[0]);
  EXPECT_EQ(tested.settle(), StageEnd::converged);
}

TEST(Crowd, TakesMoreWhereThereAreHoles) {
  const Spheres<3> spheres = random_spheres({{0, 0, 0}, {1, 1, 1}}, 0.08, 0.4);
  CrowdUnderTest tested(box_of({1, 1, 1}), spheres);
  tested.settle();
  const std::vector<double> more{0.03, 0.09, 0.05, 0.09};
  ASSERT_TRUE(tested.crowd.add(more, tested.random));
  ASSERT_EQ(tested.crowd.size(), spheres.size() + more.size());
  for (std::size_t k = 0; k < more.size(); ++k)
    EXPECT_EQ(tested.crowd.spheres().r[spheres.size() + k], more[k]);
  EXPECT_EQ(tested.settle(), StageEnd::converged);
  expect_free(tested.crowd.spheres(), *tested.container);
}

TEST(Crowd, StaysAsItIsWhereThereAreNoHoles) {
  // No place in the slab clears its wall by half the radius of a sphere that is to come.
  CrowdUnderTest tested(box_of({1, 1, 0.2}), random_spheres({{0, 0, 0}, {1, 1, 0.2}}, 0.05, 0.2));
  ASSERT_EQ(tested.settle(), StageEnd::converged);
  const Spheres<3> before = tested.crowd.spheres();
  const std::vector<double> large{0.21, 0.22};
  EXPECT_FALSE(tested.crowd.add(large, tested.random));
  EXPECT_EQ(tested.crowd.spheres(), before);
  EXPECT_EQ(tested.settle(), StageEnd::converged);
}

TEST(Crowd, IsPutBackAsItWas) {
  CrowdUnderTest tested(box_of({1, 1, 1}), random_spheres({{0, 0, 0}, {1, 1, 1}}, 0.08, 0.4));
  ASSERT_EQ(tested.settle(), StageEnd::converged);
  const Spheres<3> before = tested.crowd.spheres();
  tested.crowd.burst();
  tested.crowd.restore(before);
  EXPECT_EQ(tested.crowd.spheres(), before);
  // It is free of overlap already: nothing moves farther than the coordinates are good to.
  EXPECT_EQ(tested.settle(), StageEnd::converged);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT((tested.crowd.spheres().center(i) - before.center(i)).norm(), 1e-3 * before.r[i]);
}

TEST(Crowd, MovesFromAChamberThatIsTooFullToOneThatIsEmpty) {
  // No sphere is as small as the neck between two cubes of edge 1.
  const Mesh mesh = test::scaled(test::two_cubes_mesh(0.1), 0.5);
  ASSERT_NEAR(volume_of(Domain(mesh)), 2.005, 1e-12);
  const Spheres<3> spheres = random_spheres({{0.01, -0.49, -0.49}, {0.99, 0.49, 0.49}}, 0.12, 0.9);
  CrowdUnderTest tested(make_mesh_container(mesh, WallArithmetic::filtered, 0x1p-50), spheres);
  ASSERT_EQ(tested.settle(), StageEnd::full);
  const auto on_the_right = [&] {
    return std::ranges::count_if(tested.crowd.spheres().x[0], [](double x) { return x > 1.5; });
  };
  EXPECT_EQ(on_the_right(), 0);
  StageEnd rest = StageEnd::full;
  for (int k = 0; k < 60 && rest != StageEnd::converged; ++k) {
    tested.crowd.relocate(0.05, tested.random);
    rest = tested.settle();
  }
  ASSERT_EQ(rest, StageEnd::converged) << tested.crowd.mean_squeeze();
  // They were seen free in motion: a few more sweeps bring all of them there.
  for (int k = 0; k < 5 && !first_overlap(tested.crowd.spheres(), *tested.container).empty(); ++k)
    ASSERT_EQ(tested.settle(), StageEnd::converged);
  expect_free(tested.crowd.spheres(), *tested.container);
  // Of 0.9 of a chamber's volume at least a quarter has to go.
  EXPECT_GT(static_cast<double>(on_the_right()), 0.25 * static_cast<double>(spheres.size()));
}

TEST(Crowd, OfSpheresThatSinglePrecisionCannotTellApartIsRefused) {
  Spheres<3> dust;
  dust.push_back({0.5, 0.5, 0.5}, 1e-6);
  try {
    CrowdUnderTest tested(box_of({1, 1, 1}), dust);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    EXPECT_NE(std::string(error.what()).find("1e+06 times smaller"), std::string::npos) << error.what();
  }
  dust.r[0] = 1e-5;
  CrowdUnderTest tested(box_of({1, 1, 1}), dust);
  EXPECT_EQ(tested.settle(), StageEnd::converged);
}

}  // namespace crowd_test
}  // namespace bernal
