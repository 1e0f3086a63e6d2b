#include "bernal/measure/size_correlation.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bernal/core/random.hpp"
#include "bernal/measure/bond_order.hpp"
#include "bernal/run/run.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"
#include "support/plans.hpp"

namespace bernal {
namespace size_correlation_test {

using testing::ideal_gas;
using testing::packing_of;
using testing::periodic_packing;

/// By all pairs, each once.
template <int D>
void check_against_all_pairs(const Packing& packing, const SizeCorrelationOptions& options) {
  const auto found = size_correlation(packing.spheres, packing.domain, options);
  ASSERT_TRUE(found);
  const Spheres<D> spheres = packing.spheres.in<D>();
  const Boundary<D> metric = boundary_of<D>(packing.domain);
  const auto n = static_cast<double>(spheres.size());
  double mean = 0, variance = 0;
  for (const double r : spheres.r) mean += r / n;
  for (const double r : spheres.r) variance += (r - mean) * (r - mean) / n;
  EXPECT_NEAR(found->mean_diameter, 2 * mean, 1e-12 * mean);
  EXPECT_EQ(found->references, spheres.size());

  std::vector<double> sums(found->c.size(), 0), counts(found->c.size(), 0);
  std::vector<double> at_ends, products;  // of bonds
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double d = metric.minimum_image(spheres.center(i) - spheres.center(j)).norm();
      const double first = spheres.r[i] - mean, second = spheres.r[j] - mean;
      const auto bin = static_cast<std::size_t>(d / found->bin_width);
      if (bin < sums.size()) {
        sums[bin] += first * second / variance;
        ++counts[bin];
      }
      if (d >= (1 + BondOrder::widest_gap) * (spheres.r[i] + spheres.r[j])) continue;
      at_ends.insert(at_ends.end(), {first, second});
      products.push_back(first * second);
    }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    EXPECT_NEAR(found->d[k], (static_cast<double>(k) + 0.5) * found->bin_width, 1e-9 * found->d[k]);
    EXPECT_NEAR(found->c[k], counts[k] > 0 ? sums[k] / counts[k] : 0, 1e-6) << found->d[k];
    EXPECT_NEAR(found->error[k], 1 / std::sqrt(std::max(1.0, counts[k])), 1e-6) << found->d[k];
  }
  ASSERT_TRUE(found->neighbours);
  const auto mean_of = [](const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
  };
  const double at_end = mean_of(at_ends);
  double squares = 0;
  for (const double v : at_ends) squares += (v - at_end) * (v - at_end) / static_cast<double>(at_ends.size());
  EXPECT_EQ(found->neighbours->pairs, products.size());
  double sum = 0, pairs = 0;
  for (std::size_t k = 10; k < 25 && k < sums.size(); ++k) {
    sum += sums[k];
    pairs += std::max(1.0, counts[k]);
  }
  const auto between = found->mean_between(1, 2.5);
  ASSERT_TRUE(between);
  EXPECT_NEAR(between->c, sum / pairs, 1e-6);
  EXPECT_NEAR(between->error, 1 / std::sqrt(pairs), 1e-9);
  EXPECT_NEAR(found->neighbours->correlation, (mean_of(products) - at_end * at_end) / squares, 1e-9);
}

TEST(SizeCorrelation, IsThatOfAllPairs) {
  check_against_all_pairs<3>(periodic_packing<3>(ideal_gas<3>(600, 0.4, 0.6, {9, 10, 11}, 1), {9, 10, 11}),
                             {});
  check_against_all_pairs<3>(periodic_packing<3>(ideal_gas<3>(2000, 0.4, 0.6, {19, 20, 21}, 1), {19, 20, 21}),
                             {.reach = 3});
  check_against_all_pairs<2>(periodic_packing<2>(ideal_gas<2>(500, 0.3, 0.7, {40, 30}, 2), {40, 30}), {});
  check_against_all_pairs<5>(
      periodic_packing<5>(ideal_gas<5>(300, 0.4, 0.6, Vector<5>::Constant(6), 3), Vector<5>::Constant(6)),
      {});
  const Bounds<3> room{Vector<3>::Zero(), Vector<3>(14, 9, 8)};
  check_against_all_pairs<3>(packing_of(testing::scattered(600, 0.3, 0.6, room, 3), {room.lower, room.upper}),
                             {.reach = 4});
}

TEST(SizeCorrelation, SpheresFarFromTheOriginAreTheSame) {
  const Bounds<3> room{Vector<3>::Zero(), Vector<3>::Constant(8)};
  const Spheres<3> spheres = testing::scattered(300, 0.3, 0.6, room, 3);
  const Box here{room.lower, room.upper};
  Spheres<3> moved = spheres;
  const Vector<3> far(1 << 20, -(1 << 20), 1 << 19);  // 2^-33 of their place is what the sums are rounded by
  for (std::size_t i = 0; i < moved.size(); ++i) moved.set_center(i, spheres.center(i) + far);
  Box there = here;
  there.corner += far;
  const auto a = size_correlation(packing_of(spheres, here).spheres, here);
  const auto b = size_correlation(packing_of(moved, here).spheres, there);
  ASSERT_TRUE(a && b);
  for (std::size_t k = 0; k < a->c.size(); ++k) EXPECT_NEAR(a->c[k], b->c[k], 1e-6);
}

/// The sum over the bins of (C / error)² is chi-squared where sizes are put on the places by chance, and so
/// is the sum over several deals.
class NoCorrelation {
 public:
  void add(const SizeCorrelation& found, std::size_t n) {
    for (std::size_t k = 0; k < found.c.size(); ++k) {
      if (found.error[k] > 0.1) continue;
      chi_squared_ += std::pow((found.c[k] + 1 / static_cast<double>(n - 1)) / found.error[k], 2);
      ++bins_;
    }
    EXPECT_GT(bins_, 15 * ++deals_);
  }
  ~NoCorrelation() { EXPECT_NEAR(chi_squared_, bins_, 4 * std::sqrt(2 * bins_)); }

 private:
  double chi_squared_ = 0, bins_ = 0, deals_ = 0;
};

TEST(SizeCorrelation, OfSizesDealtOutByChanceIsNoneWithinItsError) {
  // The places of a jammed packing, whose neighbours are anything but independent.
  const Packing packing = run(testing::plan_of(
      "unit = \"mm\"\n[container]\nkind = \"periodic\"\n[spheres]\ncount = 3000\nradius = { distribution = "
      "\"lognormal\", median = 1.0, sigma = 0.3 }\n"));
  NoCorrelation of_all, of_some;
  std::mt19937 shuffler(7);
  for (int k = 0; k < 8; ++k) {
    Spheres<dynamic> dealt = packing.spheres;
    std::ranges::shuffle(dealt.r, shuffler);
    const auto found = size_correlation(dealt, packing.domain);
    ASSERT_TRUE(found);
    of_all.add(*found, dealt.size());
    const auto sampled = size_correlation(dealt, packing.domain, {.work = 3e5});
    EXPECT_LT(sampled->references, dealt.size());
    of_some.add(*sampled, dealt.size());
    const auto all = found->mean_between(1, 5);
    EXPECT_LT(std::abs(all->c + 1 / static_cast<double>(dealt.size() - 1)), 5 * all->error);
  }
  // As they were packed, near spheres are those that can touch so near: what C does see.
  const auto packed = size_correlation(packing.spheres, packing.domain);
  const auto bin = static_cast<std::size_t>(0.75 * packed->mean_diameter / packed->bin_width);
  EXPECT_GT(packed->c[bin], 5 * packed->error[bin]);
  EXPECT_GT(packed->neighbours->correlation, -0.15);
  EXPECT_LT(packed->neighbours->correlation, 0);
}

TEST(SizeCorrelation, SeesSizesThatSeparate) {
  const Vector<3> edges(20, 20, 40);
  Spheres<3> spheres = ideal_gas<3>(4000, 0.4, 0.6, edges, 3);
  for (std::size_t i = 0; i < spheres.size(); ++i) spheres.r[i] = spheres.center(i)[2] < 20 ? 0.4 : 0.6;
  const auto found = size_correlation(periodic_packing<3>(spheres, edges).spheres, periodic_box(edges));
  ASSERT_TRUE(found);
  // At the distance d a share d / 2h of the pairs lies across one of two borders h = 20 apart: C = 1 - d / h.
  for (std::size_t k = 10; k < found->c.size(); ++k)
    EXPECT_NEAR(found->c[k], 1 - found->d[k] / 20, 0.1) << found->d[k];
  EXPECT_GT(found->neighbours->correlation, 0.9);
}

TEST(SizeCorrelation, IsNotThereWhereThereIsNothingToCompare) {
  const Vector<3> edges = Vector<3>::Constant(10);
  const auto of = [&](const Spheres<3>& spheres) {
    return size_correlation(periodic_packing<3>(spheres, edges).spheres, periodic_box(edges));
  };
  EXPECT_FALSE(of({}));
  EXPECT_FALSE(of(ideal_gas<3>(1, 0.3, 0.7, edges, 1)));
  EXPECT_FALSE(of(ideal_gas<3>(100, 0.7, 0.7, edges, 1)));
  Spheres<3> rounded = ideal_gas<3>(100, 0.7, 0.7, edges, 1);
  rounded.r[3] *= 1 + 1e-15;
  EXPECT_FALSE(of(rounded));
  EXPECT_TRUE(of(ideal_gas<3>(2, 0.3, 0.7, edges, 1)));
  const auto two = of(ideal_gas<3>(2, 0.3, 0.7, edges, 1));
  EXPECT_FALSE(two->mean_between(7, 9));
  // What is too far apart to be a neighbour.
  Spheres<3> apart;
  apart.push_back({1, 1, 1}, 0.5);
  apart.push_back({4, 4, 4}, 0.6);
  ASSERT_TRUE(of(apart));
  EXPECT_FALSE(of(apart)->neighbours);
}

TEST(SizeCorrelation, HasTheSameBitsForAnyNumberOfThreads) {
  const Vector<3> edges = Vector<3>::Constant(14);
  const Packing packing = periodic_packing<3>(ideal_gas<3>(3000, 0.3, 0.7, edges, 1), edges);
  const auto with = [&](std::size_t threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return size_correlation(packing.spheres, packing.domain).value();
  };
  const SizeCorrelation one = with(1), many = with(4);
  EXPECT_EQ(one.c, many.c);
  EXPECT_EQ(one.neighbours->correlation, many.neighbours->correlation);
}

}  // namespace size_correlation_test
}  // namespace bernal
