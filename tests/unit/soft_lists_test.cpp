#include "soft/soft_lists.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "bernal/core/boundary.hpp"
#include "soft/soft_blocks.hpp"
#include "support/soft_crowds.hpp"

namespace bernal {
namespace soft_lists_test {

using testing::Crowd;
using testing::equal_crowd;
using testing::mixed_crowd;
using testing::SoftCrowd;

constexpr float omega = 5;

/// Builds lists from scratch and reads them back as pairs of the original numbers.
std::multiset<std::pair<std::uint32_t, std::uint32_t>> listed_pairs(const Crowd<3>& crowd, float skin,
                                                                    const SoftKernels& kernels,
                                                                    bool by_octaves) {
  SoftCrowd soft(crowd);
  std::vector<std::uint32_t>& ids = soft.ids;
  SoftLists lists(kernels, by_octaves);
  lists.build(soft.spheres, ids, soft.edges, soft.sizes, skin);
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t g = 0; g < soft.spheres.size() / lanes; ++g) {
    std::set<std::uint32_t> group;
    for (std::size_t l = 0; l < lanes; ++l) group.insert(ids[g * lanes + l]);
    const NeighborRows<std::uint32_t>& rows = lists.groups()[g];
    for (std::size_t e = 0; e < lanes * rows.rows; ++e) {
      const std::uint32_t i = ids[g * lanes + e % lanes], j = ids[rows.first[e]];
      if (j == i) continue;  // fills up a list that is shorter than others
      EXPECT_FALSE(group.contains(j)) << "neighbours are moved together";
      pairs.insert({i, j});
    }
  }
  return pairs;
}

TEST(SoftLists, HoldEveryNeighbourOnce) {
  // The last ones in boxes as narrow as neighbours of twice 1.3 radii allow, along all axes and along one.
  const Crowd<3> narrow = equal_crowd(27), slab(216, 0.8, {1, 4, 2}, 1, 1);
  for (const Crowd<3>& crowd : {equal_crowd(600), mixed_crowd(600), mixed_crowd(80), narrow, slab}) {
    const double skin = 0.3;
    const Boundary<3> boundary{crowd.edges};
    for (std::size_t n = 0; n < 2 * soft_kernels().size(); ++n) {
      const SoftKernels& kernels = soft_kernels()[n / 2];
      const bool by_octaves = n % 2 == 1;
      SCOPED_TRACE(kernels.name);
      SCOPED_TRACE(by_octaves ? "by octaves" : "together");
      const auto listed = listed_pairs(crowd, static_cast<float>(skin), kernels, by_octaves);
      std::size_t surely = 0;
      for (std::uint32_t i = 0; i < crowd.spheres.size(); ++i) {
        for (std::uint32_t j = 0; j < crowd.spheres.size(); ++j) {
          if (i == j) continue;
          const double d = boundary.minimum_image(crowd.spheres.center(i) - crowd.spheres.center(j)).norm();
          const double gap = d - crowd.spheres.r[i] - crowd.spheres.r[j];
          const std::size_t count = listed.count({i, j});
          EXPECT_LE(count, 1u);
          if (gap < 2 * skin - 1e-5) {
            EXPECT_EQ(count, 1u) << i << " " << j;
            ++surely;
          }
        }
      }
      EXPECT_LE(listed.size(), surely + 20);
    }
  }
}

TEST(SoftLists, HoldTheNeighboursOfThoseThatMove) {
  const Crowd<3> crowd = mixed_crowd(600);
  const Boundary<3> boundary{crowd.edges};
  constexpr std::uint32_t movers = 250;
  constexpr float skin = 0.3f;
  SoftCrowd soft(crowd);
  SoftLists lists(soft_kernels().front());
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> listed;
  for (int built = 0; built < 2; ++built) {  // what rests is told from what moves again
    lists.build(soft.spheres, soft.ids, soft.edges, soft.sizes, skin, movers);
    listed.clear();
    std::size_t groups = 0;
    while (soft.ids[groups * lanes] < movers) ++groups;
    for (std::size_t g = 0; g < groups; ++g)
      for (std::size_t e = 0; e < lanes * lists.groups()[g].rows; ++e) {
        const std::uint32_t i = soft.ids[g * lanes + e % lanes], j = soft.ids[lists.groups()[g].first[e]];
        if (j != nobody) listed.insert({i, j});
      }
  }
  for (std::uint32_t i = 0; i < crowd.spheres.size(); ++i)
    for (std::uint32_t j = 0; j < crowd.spheres.size(); ++j) {
      const double d = boundary.minimum_image(crowd.spheres.center(i) - crowd.spheres.center(j)).norm();
      const bool near = d - crowd.spheres.r[i] - crowd.spheres.r[j] < 2 * skin - 1e-5;
      if (i == j || !near) continue;
      EXPECT_EQ(listed.count({i, j}), i < movers ? 1u : 0u) << i << " " << j;
    }
}

/// Of each sphere the sum of its squared overlap ratios, over all images.
std::vector<double> squeezes(const Crowd<3>& crowd) {
  const Boundary<3> boundary{crowd.edges};
  std::vector<double> sums(crowd.spheres.size(), 0.0);
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double reach = crowd.spheres.r[i] + crowd.spheres.r[j];
      const Vector<3> away = crowd.spheres.center(i) - crowd.spheres.center(j);
      boundary.for_each_image(away, reach, [&](const Vector<3>& image) {
        const double square = std::pow(std::max(0.0, 1 - image.norm() / reach), 2);
        sums[i] += square;
        sums[j] += square;
      });
    }
  return sums;
}

/// Spheres in blocks of about so many, swept so often.
struct BlockSweeps {
  SoftCrowd soft;
  std::vector<float> squeeze, force;  // by place
  bool fits;

  BlockSweeps(const Crowd<3>& crowd, double size, float step, int sweeps, const SoftKernels& kernels,
              std::uint32_t movers = nobody)
      : soft(crowd) {
    std::vector<SoftSphere> spare;
    SoftBlocks blocks(kernels, size);
    fits = blocks.build(soft.spheres, soft.ids, spare, crowd.spheres.size(), soft.edges, soft.sizes, 0.1f,
                        movers);
    const double r_max = std::ranges::max(crowd.spheres.r);
    squeeze.resize(soft.spheres.size());
    force.resize(soft.spheres.size());
    for (int k = 0; k < sweeps && fits; ++k)
      blocks.sweep({.spheres = soft.spheres.data(),
                    .first_group = 0,
                    .scale = scale_of(soft.edges),
                    .diameter = 0,
                    .omega = step,
                    .walls = nullptr,
                    .measure = true,
                    .squeeze = squeeze.data(),
                    .force = force.data(),
                    .narrow_axes = crowd.edges[2] < 4 * r_max ? 4u : 0u});
  }

  std::vector<std::array<std::int32_t, 3>> places() const {
    std::vector<std::array<std::int32_t, 3>> by_id(soft.ids.size());
    for (std::size_t p = 0; p < soft.ids.size(); ++p)
      if (soft.ids[p] != nobody)
        by_id[soft.ids[p]] = {soft.spheres[p].x[0], soft.spheres[p].x[1], soft.spheres[p].x[2]};
    return by_id;
  }
};

TEST(SoftBlocks, KnowEveryOverlap) {
  // One block thick, and so thin that spheres overlap two images of others.
  const Crowd<3> slab(4000, 0.8, {4, 4, 0.3}, 0.9, 1.1), thin(4000, 0.8, {6, 6, 0.15}, 0.9, 1.1);
  ASSERT_LT(thin.edges[2], 2.5);
  for (const Crowd<3>& crowd : {equal_crowd(4000), mixed_crowd(6000), slab, thin}) {
    const std::vector<double> expected = squeezes(crowd);
    for (const double size : {100, 700}) {
      const BlockSweeps swept(crowd, size, 0, 1, soft_kernels().front());
      ASSERT_TRUE(swept.fits);
      std::size_t found = 0;
      for (std::size_t p = 0; p < swept.soft.ids.size(); ++p) {
        if (swept.soft.ids[p] == nobody) continue;
        const double sum = expected[swept.soft.ids[p]];
        EXPECT_NEAR(swept.squeeze[p], sum, 2e-5 * (1 + sum));
        ++found;
      }
      EXPECT_EQ(found, crowd.spheres.size());
    }
  }
}

TEST(SoftBlocks, AreTheSameForAnyThreadsAndInstructions) {
  const Crowd<3> crowd = mixed_crowd(5000);
  const auto with_threads = [&](std::size_t n, const SoftKernels& kernels) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
    return BlockSweeps(crowd, 100, omega, 5, kernels).places();
  };
  const auto one = with_threads(1, soft_kernels().back());
  for (const SoftKernels& kernels : soft_kernels()) EXPECT_EQ(with_threads(4, kernels), one) << kernels.name;
}

TEST(SoftBlocks, HaveAnOrderForEveryTwoNeighbors) {
  const Crowd<3> crowd = equal_crowd(30000);
  SoftCrowd soft(crowd);
  std::vector<SoftSphere> spare;
  SoftBlocks blocks(soft_kernels().front(), 400);
  ASSERT_TRUE(blocks.build(soft.spheres, soft.ids, spare, crowd.spheres.size(), soft.edges, soft.sizes, 0.1f,
                           nobody));
  const Precedence& order = blocks.order();
  ASSERT_GE(order.size(), 64u);  // four along each axis: then 26 others are neighbours
  std::size_t waits = 0, first = 0;
  for (std::size_t b = 0; b < order.size(); ++b) {
    waits += order.waits_for(b);
    first += order.waits_for(b) == 0;
    EXPECT_EQ(order.waits_for(b) + order.waiting(b).size(), 26u) << b;
  }
  EXPECT_EQ(waits, 13 * order.size());
  EXPECT_EQ(first, order.size() / 8) << "one of eight colours begins";
}

TEST(SoftBlocks, SayWhereOneHoldsTooMany) {
  const Crowd<3> crowd = equal_crowd(70000);
  const BlockSweeps swept(crowd, 1e6, 0, 1, soft_kernels().front());
  EXPECT_FALSE(swept.fits);
  const std::set<std::uint32_t> ids(swept.soft.ids.begin(), swept.soft.ids.end());
  EXPECT_EQ(ids.size(), crowd.spheres.size()) << "all are still there";
}

TEST(SoftBlocks, SuitManySpheresInAWideBox) {
  const auto suits = [](const Vector<3>& edges, std::size_t n, double r) {
    return SoftBlocks::suit(n, {edges[0], edges[1], edges[2]},
                            SoftSizes(std::vector<float>(n, static_cast<float>(r))), 0.1f);
  };
  EXPECT_TRUE(suits({200, 200, 200}, 1000000, 1));
  EXPECT_FALSE(suits({60, 60, 60}, 30000, 1));      // fit into a cache
  EXPECT_TRUE(suits({1e6, 3, 3}, 1000000, 1));      // a line is cut along one axis
  EXPECT_TRUE(suits({2000, 2000, 3}, 1000000, 1));  // a sheet is cut along two axes
}

TEST(SoftBlocks, LetSpheresRest) {
  const Crowd<3> crowd = mixed_crowd(6000);
  const std::vector<double> expected = squeezes(crowd);
  constexpr std::uint32_t movers = 2500;
  for (const double size : {100, 700}) {
    const BlockSweeps known(crowd, size, 0, 1, soft_kernels().front(), movers);
    ASSERT_TRUE(known.fits);
    std::size_t found = 0;
    for (std::size_t p = 0; p < known.soft.ids.size(); ++p) {
      if (known.soft.ids[p] == nobody) continue;
      const double sum = known.soft.ids[p] < movers ? expected[known.soft.ids[p]] : 0;
      EXPECT_NEAR(known.squeeze[p], sum, 2e-5 * (1 + sum));
      ++found;
    }
    EXPECT_EQ(found, crowd.spheres.size());
    const auto before = known.places(),
               after = BlockSweeps(crowd, size, omega, 5, soft_kernels().front(), movers).places();
    std::size_t moved = 0;
    for (std::size_t i = 0; i < crowd.spheres.size(); ++i) {
      if (i >= movers) {
        EXPECT_EQ(after[i], before[i]);
      }
      moved += after[i] != before[i];
    }
    EXPECT_GT(moved, movers / 2);
  }
}

}  // namespace soft_lists_test
}  // namespace bernal
