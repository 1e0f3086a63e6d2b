#include "soft/size_exchange.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bernal/core/boundary.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/random.hpp"
#include "soft/crowd.hpp"
#include "soft/soft_engine.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace size_exchange_test {

std::vector<double> lognormal_radii(std::size_t n, double sigma) {
  Random random(3, stream(Stream::test));
  std::vector<double> radii;
  for (std::size_t i = 0; i < n; ++i)
    radii.push_back(std::exp(sigma * std::sqrt(12.0) * (random.uniform() - 0.5)));
  return radii;
}

/// So many of each.
std::vector<double> of_classes(const std::vector<double>& classes, std::size_t n) {
  std::vector<double> radii;
  for (const double r : classes) radii.insert(radii.end(), n, r);
  return radii;
}

std::vector<float> random_forces(std::size_t n) {
  Random random(4, stream(Stream::test));
  std::vector<float> forces;
  for (std::size_t i = 0; i < n; ++i) forces.push_back(static_cast<float>(random.uniform()));
  return forces;
}

TEST(SizeExchange, DealsTheSizesInTheOrderOfTheWishes) {
  const std::vector<double> radii = lognormal_radii(500, 0.3);
  const std::vector<float> forces = random_forces(radii.size());
  const double step = 0.02;
  SizeExchange exchange(radii, 3);
  ASSERT_TRUE(exchange.is_of_use());
  const std::vector<std::uint32_t> to = exchange.deal(forces, step);

  // The same by definition, in double: pressures as forces by areas, up to four times their mean.
  double mean = 0;
  std::vector<double> wish;
  for (std::size_t i = 0; i < radii.size(); ++i)
    mean += forces[i] / (radii[i] * radii[i]) / static_cast<double>(radii.size());
  for (std::size_t i = 0; i < radii.size(); ++i)
    wish.push_back(std::log(radii[i]) - step * std::min(forces[i] / (radii[i] * radii[i]) / mean - 1, 3.0));
  std::vector<std::uint32_t> by_wish(radii.size());
  std::iota(by_wish.begin(), by_wish.end(), 0u);
  std::ranges::sort(by_wish, {}, [&](std::uint32_t i) { return wish[i]; });
  std::vector<double> ascending = radii;
  std::ranges::sort(ascending);
  for (std::size_t k = 0; k < radii.size(); ++k) EXPECT_EQ(radii[to[by_wish[k]]], ascending[k]) << k;

  std::vector<std::uint32_t> sorted = to;
  std::ranges::sort(sorted);
  for (std::uint32_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], i) << "no permutation";
}

TEST(SizeExchange, LeavesAllWhereTheyAreWhereNoneIsSqueezedMoreThanOthersOfItsSize) {
  const std::vector<double> radii = lognormal_radii(300, 0.3);
  for (const int dimension : {2, 3, 5}) {
    std::vector<float> even, none(radii.size(), 0.0f);
    for (const double r : radii) even.push_back(static_cast<float>(std::pow(r, dimension - 1)));
    SizeExchange exchange(radii, dimension);
    for (const std::vector<float>& forces : {even, none}) {
      const std::vector<std::uint32_t> to = exchange.deal(forces, 0.01);
      for (std::uint32_t i = 0; i < to.size(); ++i) EXPECT_EQ(to[i], i);
    }
  }
}

TEST(SizeExchange, TakesTheSmallerSizeToTheTighterPlace) {
  SizeExchange exchange({1.0, 1.001}, 3);
  EXPECT_EQ(exchange.deal({1.0f, 3.0f}, 0.01), (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(exchange.deal({3.0f, 1.0f}, 0.01), (std::vector<std::uint32_t>{0, 1}));
}

TEST(SizeExchange, IsOfUseWhereSizesComeCloseToEachOther) {
  EXPECT_FALSE(SizeExchange({1.0, 1.0, 1.0}, 3).is_of_use());
  EXPECT_FALSE(SizeExchange({1.0, 1.4, 1.0, 1.4}, 3).is_of_use());
  EXPECT_FALSE(SizeExchange({1.0}, 3).is_of_use());
  EXPECT_FALSE(SizeExchange({}, 3).is_of_use());
  EXPECT_TRUE(SizeExchange({1.0, 1.4, 1.42}, 3).is_of_use());
  EXPECT_TRUE(SizeExchange(of_classes({1.0, 1.2}, 6), 3).is_of_use());
  EXPECT_FALSE(SizeExchange(of_classes({1.0, 1.2}, 5), 3).is_of_use()) << "so few are no class";
  EXPECT_FALSE(SizeExchange(of_classes({1.0, 1.26}, 100), 3).is_of_use());
}

TEST(SizeExchange, WidensClassesUntilStepsCrossTheGaps) {
  const std::vector<double> given = of_classes({1.0, 1.1, 1.3, 2.0}, 100);
  const std::vector<float> as_given(given.begin(), given.end());
  SizeExchange exchange(given, 3);
  EXPECT_TRUE(exchange.widen(0)) << "engines may have had others";
  EXPECT_EQ(exchange.radii(), as_given);
  EXPECT_FALSE(exchange.widen(0));
  double widest_before = std::log(1.3 / 1.1);
  for (const double share : {0.3, 0.7, 1.0}) {
    SCOPED_TRACE(share);
    ASSERT_TRUE(exchange.widen(share));
    EXPECT_TRUE(exchange.is_widened());
    const std::vector<float>& radii = exchange.radii();
    double widest = 0;
    for (std::size_t i = 1; i < 300; ++i) {
      EXPECT_GE(radii[i], radii[i - 1] * (1 - 1e-6f)) << i;
      widest = std::max(widest, std::log(static_cast<double>(radii[i]) / radii[i - 1]));
    }
    EXPECT_NEAR(widest, (1 - share) * std::log(1.3 / 1.1) + share * std::log(1.3 / 1.1) / 69, 1e-5);
    EXPECT_LT(widest, widest_before);
    widest_before = widest;
    for (std::size_t i = 300; i < 400; ++i) EXPECT_EQ(radii[i], 2.0f) << "too far from the others";
    EXPECT_EQ(radii.front(), 1.0f);
  }
  EXPECT_LT(widest_before, SizeExchange::longest_way);
  EXPECT_TRUE(exchange.widen(0));
  EXPECT_EQ(exchange.radii(), as_given) << "to the bit";
  EXPECT_FALSE(exchange.is_widened());
}

TEST(SizeExchange, CrossesAFewSpheresBetweenTwoClasses) {
  for (const std::size_t few : {1u, 5u, 6u}) {
    SCOPED_TRACE(few);
    std::vector<double> given = of_classes({1.0, 1.16}, 100);
    given.insert(given.begin() + 100, few, 1.08);
    SizeExchange exchange(given, 3);
    ASSERT_TRUE(exchange.is_of_use());
    ASSERT_TRUE(exchange.widen(1));
    const std::vector<float>& radii = exchange.radii();
    for (std::size_t i = 1; i < radii.size(); ++i) {
      EXPECT_GE(radii[i], radii[i - 1] * (1 - 1e-6f)) << i;
      EXPECT_LT(radii[i], radii[i - 1] * (1 + SizeExchange::longest_way)) << i;
    }
  }
  std::vector<double> far = of_classes({1.0, 1.4}, 100);
  far.insert(far.end(), 3, 1.2);
  EXPECT_FALSE(SizeExchange(far, 3).widen(1)) << "the classes are too far from each other";
}

TEST(SizeExchange, LeavesSizesWithoutGapsAsTheyAre) {
  SizeExchange exchange(lognormal_radii(500, 0.3), 3);
  EXPECT_FALSE(exchange.widen(1));
  EXPECT_FALSE(exchange.is_widened());
}

TEST(SizeExchange, ExpectsLessTheFartherClassesAreApart) {
  double before = SizeExchange(lognormal_radii(600, 0.1), 3).gain({});
  for (const double ratio : {1.05, 1.1, 1.2, 1.25}) {
    SCOPED_TRACE(ratio);
    const double gain =
        SizeExchange(of_classes({1.0, ratio, ratio * ratio, std::pow(ratio, 3)}, 150), 3).gain({});
    EXPECT_GT(gain, 1);
    EXPECT_LT(gain, before);
    before = gain;
  }
  EXPECT_EQ(SizeExchange(of_classes({1.0, 1.5}, 150), 3).gain({}), 1);
}

TEST(SizeExchange, ExpectsLessOfUnequalSharesAndOfFewSpheresInABed) {
  const auto of_shares = [](std::size_t first, std::size_t second) {
    std::vector<double> radii(first, 1.0);
    radii.insert(radii.end(), second, 1.1);
    return SizeExchange(radii, 3).gain({});
  };
  EXPECT_GT(of_shares(500, 500) - 1, 3 * (of_shares(950, 50) - 1));
  EXPECT_GT(of_shares(950, 50), 1);
  const SizeExchange sizes(lognormal_radii(600, 0.1), 3);
  const auto in_bed = [&](double volume_in_spheres, bool is_round) {
    return sizes.gain(
        {.has_walls = true, .in_bed = true, .is_round = is_round, .volume_in_spheres = volume_in_spheres});
  };
  EXPECT_LT(in_bed(300, true), in_bed(300, false));
  EXPECT_LT(in_bed(300, false), in_bed(3000, false));
  EXPECT_NEAR(in_bed(1e9, true), sizes.gain({.has_walls = true}), 1e-7);
  EXPECT_GT(in_bed(1, true), 1) << "it is never a loss";
}

TEST(SizeExchange, HasEveryClassAsItIsAtTheEnd) {
  EXPECT_EQ(widening(0), 0);
  EXPECT_EQ(widening(0.2), 1);
  for (const double done : {0.9, 0.95, 1.0}) EXPECT_EQ(widening(done), 0);
  for (double done = 0.3; done < 0.9; done += 0.01) EXPECT_LE(widening(done + 0.01), widening(done));
}

/// What an engine knows after an exchange is what a fresh one finds that is given the spheres that way.
template <int D>
void expect_exchanged(const Vector<D>& edges, double r_max) {
  Spheres<D> spheres = testing::ideal_gas<D>(300, 0.6 * r_max, r_max, edges, 5);
  SoftEngine<D> engine(spheres, edges);
  engine.sweep_and_measure(0);
  SizeExchange exchange(spheres.r, D);
  const std::vector<std::uint32_t> to = exchange.deal(random_forces(spheres.size()), 0.1);
  engine.exchange(to);
  const double largest = engine.sweep_and_measure(0);
  const std::vector<float> forces = engine.forces();
  Spheres<D> written = spheres;
  Vector<D> written_edges;
  engine.write_to(written, written_edges);
  for (std::size_t i = 0; i < to.size(); ++i)
    EXPECT_LT((written.center(to[i]) - spheres.center(i)).norm(), 1e-8 * edges.norm());

  SoftEngine<D> fresh(written, edges);
  EXPECT_NEAR(largest, fresh.sweep_and_measure(0), 2e-6);
  const std::vector<float> expected = fresh.forces();
  for (std::size_t i = 0; i < to.size(); ++i) EXPECT_NEAR(forces[i], expected[i], 1e-4 * r_max * r_max) << i;
}

TEST(SoftEngine, ExchangesInEveryKindOfBox) {
  expect_exchanged<3>(Vector<3>(1, 1.2, 0.9), 0.08);
  expect_exchanged<2>(Vector<2>(1, 1.2), 0.05);
  expect_exchanged<3>(Vector<3>(1, 1.2, 0.3), 0.08);  // several images
  expect_exchanged<4>(Vector<4>(1, 1, 1, 1), 0.15);
}

/// What an engine knows of spheres that it resizes is what a fresh one finds that is given these radii.
template <int D>
void expect_resized(const Vector<D>& edges, double r_max) {
  Spheres<D> spheres = testing::ideal_gas<D>(300, 0.6 * r_max, r_max, edges, 5);
  SoftEngine<D> engine(spheres, edges);
  engine.sweep_and_measure(0);
  std::vector<float> radii;
  for (double& r : spheres.r) {
    r = std::min(0.9 * r_max, 1.05 * r);
    radii.push_back(static_cast<float>(r));
  }
  engine.resize(radii);
  const double largest = engine.sweep_and_measure(0);
  const std::vector<float> forces = engine.forces();
  SoftEngine<D> fresh(spheres, edges);
  EXPECT_NEAR(largest, fresh.sweep_and_measure(0), 2e-6);
  const std::vector<float> expected = fresh.forces();
  for (std::size_t i = 0; i < radii.size(); ++i)
    EXPECT_NEAR(forces[i], expected[i], 1e-4 * r_max * r_max) << i;
}

TEST(SoftEngine, ResizesInEveryKindOfBox) {
  expect_resized<3>(Vector<3>(1, 1.2, 0.9), 0.08);
  expect_resized<2>(Vector<2>(1, 1.2), 0.05);
  expect_resized<4>(Vector<4>(1, 1, 1, 1), 0.15);
}

TEST(SoftPacking, FindsTheForcesOfAllPairs) {
  const Vector<3> edges(1, 1.3, 0.9);
  const Spheres<3> spheres = testing::ideal_gas<3>(400, 0.03, 0.08, edges, 6);
  SoftPacking packing(spheres, edges, soft_kernels().front());
  packing.sweep_and_measure(0);
  const std::vector<float> forces = packing.forces();
  const Boundary<3> boundary{edges};
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    double expected = 0;
    for (std::size_t j = 0; j < spheres.size(); ++j) {
      if (j == i) continue;
      const double reach = spheres.r[i] + spheres.r[j],
                   d = boundary.minimum_image(spheres.center(i) - spheres.center(j)).norm();
      expected += std::max(0.0, 2 * spheres.r[i] * spheres.r[j] / reach * (reach - d));
    }
    EXPECT_NEAR(forces[i], expected, 1e-5 * std::max(0.0064, expected)) << i;
  }
}

TEST(Crowd, EmptiesAsManyPlacesAsSpheresGoAndKeepsTheOthersAboutWhereTheyWere) {
  const auto container =
      make_analytic_container(Box{Vector<3>::Zero(), Vector<3>::Ones()}, WallArithmetic::filtered, 0x1p-50);
  const Places places(*container);
  Random random(5, stream(Stream::test));
  Spheres<3> spheres;
  for (int i = 0; i < 400; ++i)
    spheres.push_back(uniform_point(random, container->bounds()), random.uniform(0.04, 0.08));
  CrowdInContainer crowd(ContainerGround(*container, places), spheres);
  crowd.settle({}, {}, 100);
  const Spheres<3> before = crowd.spheres();
  crowd.drop_last_dealing(20);
  const Spheres<3> after = crowd.spheres();
  ASSERT_EQ(after.size(), 380u);
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after.r[i], spheres.r[i]);
    std::size_t place = 0;  // that was whose
    for (std::size_t j = 0; j < before.size(); ++j)
      if ((before.center(j) - after.center(i)).norm() < (before.center(place) - after.center(i)).norm())
        place = j;
    EXPECT_LT((before.center(place) - after.center(i)).norm(), 1e-8);
    // Of 400 sizes between 0.04 and 0.08, twenty fewer: ranks shift by as many at most.
    EXPECT_NEAR(before.r[place], after.r[i], 0.004) << i;
  }
}

}  // namespace size_exchange_test
}  // namespace bernal
