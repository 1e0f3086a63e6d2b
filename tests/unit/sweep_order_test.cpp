#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bernal/core/boundary.hpp"
#include "bernal/core/random.hpp"
#include "soft/sweep_order.hpp"

namespace bernal {
namespace sweep_order_test {

constexpr float skin = 0.4f;

/// Spheres at random in a box that they fill to 0.8, overlaps counted twice.
struct Bed {
  std::vector<SoftSphere> spheres;
  std::array<double, 3> edges;

  Bed(std::vector<float> radii, const Vector<3>& proportions) {
    double volume = 0;
    for (const float r : radii) volume += 4.18879 * std::pow(double{r}, 3);
    const double scale = std::cbrt(volume / 0.8 / proportions.prod());
    for (int k = 0; k < 3; ++k) edges[static_cast<std::size_t>(k)] = scale * proportions[k];
    Random random(3, stream(Stream::test));
    for (const float r : radii) {
      SoftSphere sphere{{}, r};
      for (std::int32_t& x : sphere.x)
        x = static_cast<std::int32_t>(static_cast<std::uint32_t>(random.uniform() * 0x1p32));
      spheres.push_back(sphere);
    }
  }

  SoftSizes sizes() const {
    std::vector<float> radii;
    for (const SoftSphere& s : spheres) radii.push_back(s.r);
    return SoftSizes(radii);
  }
  SweepOrder order(bool by_octaves = false) const {
    SweepOrder order;
    order.find(spheres, SoftRegion{}, edges, sizes(), skin, by_octaves);
    return order;
  }
  bool may_meet(std::uint32_t a, std::uint32_t b) const {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k)
      square += std::pow(steps_between(spheres[a], spheres[b], k) * edges[k] * 0x1p-32, 2);
    return std::sqrt(square) < spheres[a].r + spheres[b].r + 2 * skin;
  }
};

std::vector<float> equal(std::size_t n) { return std::vector<float>(n, 1.0f); }
std::vector<float> lognormal(std::size_t n, double sigma) {
  Random random(5, stream(Stream::test));
  std::vector<float> radii;
  for (std::size_t i = 0; i < n; ++i) {  // of two even numbers, a normal one
    const double angle = 6.28319 * random.uniform();
    radii.push_back(static_cast<float>(
        std::exp(sigma * std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(angle))));
  }
  return radii;
}
std::vector<float> with_giants(std::size_t n) {
  std::vector<float> radii = lognormal(n, 0.2);
  radii[n / 2] = 12;
  radii[n / 3] = 30;
  return radii;
}

std::vector<Bed> beds() {
  std::vector<Bed> all;
  for (const std::size_t n : {1, 2, 17, 300, 3000}) all.emplace_back(equal(n), Vector<3>(1, 1, 1));
  all.emplace_back(lognormal(3000, 0.3), Vector<3>(1, 2, 1.5));
  all.emplace_back(lognormal(3000, 0.3), Vector<3>(30, 1, 1));
  all.emplace_back(lognormal(3000, 0.3), Vector<3>(1, 30, 20));
  all.emplace_back(lognormal(2000, 1.5), Vector<3>(1, 1, 1));
  all.emplace_back(with_giants(3000), Vector<3>(1, 1, 1));
  return all;
}

TEST(SweepOrder, HasEverySphereOnce) {
  for (const Bed& bed : beds()) {
    for (const bool by_octaves : {false, true}) {
      const SweepOrder order = bed.order(by_octaves);
      std::vector<std::uint32_t> there;
      for (const std::uint32_t i : order.sphere_at())
        if (i != nobody) there.push_back(i);
      std::ranges::sort(there);
      std::vector<std::uint32_t> all(bed.spheres.size());
      std::iota(all.begin(), all.end(), 0u);
      EXPECT_EQ(there, all);
      std::size_t groups = 0;
      for (const auto& chains : order.phases())
        for (const Chain& chain : chains) {
          EXPECT_EQ(chain.first, groups);
          EXPECT_LT(chain.first, chain.last);
          groups = chain.last;
        }
      EXPECT_EQ(groups * lanes, order.sphere_at().size());
    }
  }
}

/// Calls with both for every two spheres that are swept at the same time, or may be.
template <class Visit>
void for_each_at_once(const SweepOrder& order, const Visit& visit) {
  for (const auto& chains : order.phases()) {
    for (std::size_t c = 0; c < chains.size(); ++c)
      for (std::size_t a = chains[c].first * lanes; a < chains[c].last * lanes; ++a) {
        const auto others = [&](std::size_t begin, std::size_t end) {
          for (std::size_t b = begin; b < end; ++b)
            if (order.sphere_at()[a] != nobody && order.sphere_at()[b] != nobody)
              visit(order.sphere_at()[a], order.sphere_at()[b]);
        };
        others(a + 1, (a / lanes + 1) * lanes);
        others(chains[c].last * lanes, chains.back().last * lanes);
      }
  }
}

TEST(SweepOrder, MovesNoTwoNeighboursAtATime) {
  std::vector<Bed> all = beds();
  // So many that pencils are cut and chains share a colour.
  all.emplace_back(equal(20000), Vector<3>(1, 1, 1));
  all.emplace_back(lognormal(20000, 0.3), Vector<3>(30, 1, 1));
  for (const Bed& bed : all) {
    for (const bool by_octaves : {false, true}) {
      std::size_t met = 0;
      for_each_at_once(bed.order(by_octaves),
                       [&](std::uint32_t a, std::uint32_t b) { met += bed.may_meet(a, b); });
      EXPECT_EQ(met, 0u) << bed.spheres.size() << " spheres";
    }
  }
}

TEST(SweepOrder, FillsItsGroupsAndSharesThemOut) {
  for (const std::vector<float>& radii : {equal(100000), lognormal(100000, 0.3), with_giants(100000)}) {
    const Bed bed(radii, Vector<3>(1, 1, 1));
    const SweepOrder order = bed.order();
    EXPECT_LT(order.sphere_at().size(), 1.02 * static_cast<double>(radii.size()));
    // What two threads take where each begins the next chain as soon as it is free.
    std::size_t in_two = 0;
    for (const auto& chains : order.phases()) {
      std::array<std::size_t, 2> thread{};
      for (const Chain& chain : chains) *std::ranges::min_element(thread) += chain.last - chain.first;
      in_two += std::ranges::max(thread);
    }
    EXPECT_LT(2 * in_two * lanes, 1.06 * static_cast<double>(order.sphere_at().size()));
  }
}

TEST(SweepOrder, IsTheSameInThreads) {
  for (const std::vector<float>& radii : {equal(100000), lognormal(100000, 0.3), with_giants(100000)}) {
    Bed bed(radii, Vector<3>(1, 1, 1));
    const SoftSizes sizes = bed.sizes();
    for (std::size_t i = 5; i < bed.spheres.size(); i += 1000) bed.spheres[i] = no_sphere;
    for (const bool by_octaves : {false, true}) {
      std::array<SweepOrder, 2> orders;
      for (const bool in_threads : {false, true})
        for (int time = 0; time < 2; ++time)  // memory of before is used again
          orders[in_threads].find(bed.spheres, SoftRegion{}, bed.edges, sizes, skin, by_octaves, in_threads);
      EXPECT_EQ(orders[0].sphere_at(), orders[1].sphere_at());
      EXPECT_EQ(std::ranges::count_if(orders[0].sphere_at(), [](std::uint32_t i) { return i != nobody; }),
                bed.spheres.size() - 100);
      ASSERT_EQ(orders[0].phases().size(), orders[1].phases().size());
      for (std::size_t p = 0; p < orders[0].phases().size(); ++p)
        EXPECT_TRUE(std::ranges::equal(
            orders[0].phases()[p], orders[1].phases()[p],
            [](const Chain& a, const Chain& b) { return a.first == b.first && a.last == b.last; }));
    }
  }
}

}  // namespace sweep_order_test
}  // namespace bernal
