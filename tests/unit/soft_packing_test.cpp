#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <map>
#include <set>

#include "bernal/core/boundary.hpp"
#include "bernal/core/random.hpp"
#include "soft/soft_packing.hpp"

namespace bernal {
namespace soft_packing_test {

constexpr float omega = 5;

/// `n` spheres at random in a box of the given proportions that they fill, overlaps counted twice, to `phi`.
template <int D>
struct Crowd {
  Spheres<D> spheres;
  Vector<D> edges;

  Crowd(std::size_t n, double phi, Vector<D> proportions, double r_min, double r_max) : edges(proportions) {
    Random random(7, stream(Stream::test));
    double volume = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double r = r_min * std::pow(r_max / r_min, random.uniform());
      spheres.push_back(Vector<D>::Zero(), r);
      volume += std::pow(2 * r, D) * (D == 3 ? 0.5236 : D == 2 ? 0.7854 : 1.0);
    }
    edges *= std::pow(volume / phi / edges.prod(), 1.0 / D);
    for (std::size_t i = 0; i < n; ++i)
      spheres.set_center(i, uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges}));
  }
};

Crowd<3> equal_crowd(std::size_t n) { return {n, 0.8, {1, 1, 1}, 1, 1}; }
Crowd<3> mixed_crowd(std::size_t n) { return {n, 0.8, {1, 2, 1.5}, 0.2, 1.5}; }

template <int D>
Spheres<D> after_sweeps(const Crowd<D>& crowd, const SoftKernels& kernels, int sweeps) {
  SoftPacking packing(crowd.spheres, crowd.edges, kernels);
  for (int k = 0; k < sweeps; ++k) packing.sweep(omega);
  Spheres<D> spheres = crowd.spheres;
  Vector<D> edges;
  packing.write_to(spheres, edges);
  return spheres;
}

TEST(SoftKernels, EndWithTheOneForEveryProcessor) {
  ASSERT_FALSE(soft_kernels().empty());
  EXPECT_EQ(soft_kernels().back().name, "SSE2");
}

TEST(SoftKernels, GiveTheSameBitsInEveryInstructionSet) {
  for (const SoftKernels& kernels : soft_kernels()) {
    SCOPED_TRACE(kernels.name);
    for (const Crowd<3>& crowd : {equal_crowd(3000), mixed_crowd(3000)})
      EXPECT_EQ(after_sweeps(crowd, kernels, 60), after_sweeps(crowd, soft_kernels().back(), 60));
  }
}

TEST(SoftPacking, IsTheSameForAnyNumberOfThreads) {
  const Crowd<3> crowd = mixed_crowd(30000);
  const auto with_threads = [&](std::size_t n) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
    return after_sweeps(crowd, soft_kernels().front(), 20);
  };
  EXPECT_EQ(with_threads(1), with_threads(4));
}

/// All pairs, in double.
template <int D>
double largest_overlap(const Spheres<D>& spheres, const Vector<D>& edges) {
  const Boundary<D> boundary{edges};
  double largest = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double d = boundary.minimum_image(spheres.center(i) - spheres.center(j)).norm();
      largest = std::max(largest, 1 - d / (spheres.r[i] + spheres.r[j]));
    }
  return largest;
}

TEST(SoftPacking, MeasuresTheLargestOverlap) {
  // A sweep measures each sphere when its turn comes; with a step of nothing that is the state itself.
  for (const Crowd<3>& crowd : {equal_crowd(800), mixed_crowd(800)}) {
    SoftPacking packing(crowd.spheres, crowd.edges, soft_kernels().front());
    EXPECT_NEAR(packing.sweep_and_measure(0), largest_overlap(crowd.spheres, crowd.edges), 2e-6);
  }
  const Crowd<2> plane(500, 0.9, {1, 3}, 0.5, 1);
  SoftPacking packing(plane.spheres, plane.edges, soft_kernels().front());
  EXPECT_NEAR(packing.sweep_and_measure(0), largest_overlap(plane.spheres, plane.edges), 2e-6);
}

TEST(SoftPacking, MovesASphereByTheMeanOfItsOverlaps) {
  // Two that overlap by 0.5: each in turn moves by the whole overlap, so that after one sweep they touch.
  Spheres<3> pair;
  pair.push_back({1, 10, 10}, 1);
  pair.push_back({19.5, 10, 10}, 1);  // across the face of the box
  Vector<3> edges(20, 20, 20);
  SoftPacking packing(pair, edges, soft_kernels().front());
  EXPECT_NEAR(packing.sweep_and_measure(1), 0.25, 1e-6);
  packing.write_to(pair, edges);
  const Vector<3> way = Boundary<3>{edges}.minimum_image(pair.center(1) - pair.center(0));
  EXPECT_NEAR(way.norm(), 2, 1e-6);
  EXPECT_NEAR(way[0], -2, 1e-6);
}

TEST(SoftPacking, MovesSpheresTheSameWhetherItMeasuresOrNot) {
  // Spheres of one size in a cube have a loop of their own, which measures nothing and rounds otherwise.
  // Steps are short: a pair that just touches may count for one of both, and takes others along.
  constexpr float short_step = 0.01f;
  for (const Crowd<3>& crowd : {equal_crowd(3000), mixed_crowd(3000)}) {
    SoftPacking measured(crowd.spheres, crowd.edges, soft_kernels().front());
    SoftPacking other(crowd.spheres, crowd.edges, soft_kernels().front());
    measured.sweep_and_measure(short_step);
    other.sweep(short_step);
    Spheres<3> here = crowd.spheres, there = crowd.spheres;
    measured.write_to(here);
    other.write_to(there);
    const Boundary<3> boundary{crowd.edges};
    double farthest = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
      EXPECT_LT(boundary.minimum_image(here.center(i) - there.center(i)).norm(), 1e-7) << i;
      const Vector<3> way = boundary.minimum_image(here.center(i) - crowd.spheres.center(i));
      farthest = std::max(farthest, way.norm());
    }
    EXPECT_GT(farthest, short_step / 10);
  }
}

TEST(SoftPacking, KeepsItsPlacesWhenTheBoxGrows) {
  const Crowd<3> crowd = equal_crowd(200);
  SoftPacking packing(crowd.spheres, crowd.edges, soft_kernels().front());
  packing.grow(1.5);
  Spheres<3> spheres = crowd.spheres;
  Vector<3> edges;
  packing.write_to(spheres, edges);
  EXPECT_TRUE(edges.isApprox(1.5 * crowd.edges, 1e-14));
  for (std::size_t i = 0; i < spheres.size(); ++i)
    EXPECT_LT((spheres.center(i) - 1.5 * crowd.spheres.center(i)).norm(), 1e-8 * edges.norm());
}

/// The spheres of a crowd as the engine has them.
struct SoftCrowd {
  std::vector<SoftSphere> spheres;
  std::vector<std::uint32_t> ids;
  std::array<double, 3> edges;
  SoftSizes sizes;

  explicit SoftCrowd(const Crowd<3>& crowd) {
    for (int k = 0; k < 3; ++k) edges[static_cast<std::size_t>(k)] = crowd.edges[k];
    std::vector<float> radii;
    for (std::size_t i = 0; i < crowd.spheres.size(); ++i) {
      SoftSphere s{};
      for (std::size_t k = 0; k < 3; ++k)
        s.x[k] = static_cast<std::int32_t>(
            static_cast<std::uint32_t>(crowd.spheres.x[k][i] / edges[k] * 4294967295.0));
      s.r = static_cast<float>(crowd.spheres.r[i]);
      spheres.push_back(s);
      ids.push_back(static_cast<std::uint32_t>(i));
      radii.push_back(s.r);
    }
    sizes = SoftSizes(radii);
  }
};

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

/// Of each sphere the sum of its squared overlap ratios.
std::vector<double> squeezes(const Crowd<3>& crowd) {
  const Boundary<3> boundary{crowd.edges};
  std::vector<double> sums(crowd.spheres.size(), 0.0);
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double reach = crowd.spheres.r[i] + crowd.spheres.r[j];
      const double d = boundary.minimum_image(crowd.spheres.center(i) - crowd.spheres.center(j)).norm();
      if (!(d < reach)) continue;
      sums[i] += std::pow(1 - d / reach, 2);
      sums[j] += std::pow(1 - d / reach, 2);
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
                    .force = force.data()});
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
  const Crowd<3> slab(4000, 0.8, {4, 4, 0.3}, 0.9, 1.1);  // one block thick
  for (const Crowd<3>& crowd : {equal_crowd(4000), mixed_crowd(6000), slab}) {
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

/// Movers that touch nothing but what rests, so that the order of a sweep does not matter: a grid of cells,
/// each with one mover among three that rest. Ids: movers first.
Crowd<3> movers_among_resting(int across, double r_min, double r_max) {
  Crowd<3> crowd(0, 1, {1, 1, 1}, 1, 1);
  crowd.edges = Vector<3>::Constant(8.0 * across);
  Random random(11, stream(Stream::test));
  const std::size_t cells = static_cast<std::size_t>(across * across * across);
  for (std::size_t n = 0; n < 4 * cells; ++n) {
    const auto cell = static_cast<int>(n % cells);
    const Vector<3> middle(8 * (cell % across) + 4, 8 * (cell / across % across) + 4,
                           8 * (cell / across / across) + 4);
    const double r = r_min + (r_max - r_min) * random.uniform();
    const Vector<3> off = 0.9 * (uniform_point(random, Bounds<3>{Vector<3>::Zero(), Vector<3>::Ones()}) * 2 -
                                 Vector<3>::Ones());
    crowd.spheres.push_back(n < cells ? middle : Vector<3>(middle + off * 1.4), r);
  }
  return crowd;
}

/// By equations 3 and 4 of the paper, see SoftKernels::sweep, in double.
Vector<3> after_a_sweep(const Crowd<3>& crowd, std::size_t mover) {
  const Boundary<3> boundary{crowd.edges};
  Vector<3> push = Vector<3>::Zero();
  double n = 0;
  const double ri = crowd.spheres.r[mover];
  for (std::size_t j = 0; j < crowd.spheres.size(); ++j) {
    const Vector<3> away = boundary.minimum_image(crowd.spheres.center(mover) - crowd.spheres.center(j));
    const double d = away.norm(), rj = crowd.spheres.r[j];
    if (j == mover || d >= ri + rj) continue;
    const double weight = 2 * rj / (ri + rj);
    push += weight * (ri + rj - d) / d * away;
    n += weight;
  }
  return n > 0 ? Vector<3>(crowd.spheres.center(mover) + std::min(double{omega} / n, 1.0) * push)
               : crowd.spheres.center(mover);
}

TEST(SoftPacking, MovesTheFirstWhileTheLastRest) {
  for (const Crowd<3>& crowd : {movers_among_resting(6, 1, 1), movers_among_resting(6, 0.5, 1)}) {
    const std::size_t movers = crowd.spheres.size() / 4;
    SoftPacking packing(crowd.spheres, crowd.edges, soft_kernels().front(), false,
                        crowd.spheres.size() - movers);
    packing.sweep_to_overlap(omega);
    Spheres<3> after = crowd.spheres;
    packing.write_to(after);
    const Boundary<3> boundary{crowd.edges};
    int moved = 0;
    for (std::size_t i = 0; i < crowd.spheres.size(); ++i) {
      const Vector<3> expected = i < movers ? after_a_sweep(crowd, i) : crowd.spheres.center(i);
      EXPECT_LT(boundary.minimum_image(after.center(i) - expected).norm(), i < movers ? 1e-5 : 1e-7) << i;
      moved += (after.center(i) - crowd.spheres.center(i)).norm() > 0.01;
    }
    EXPECT_GT(moved, 100);
    // And so for good: what rests is where it was to the bit.
    Spheres<3> later = after;
    for (int k = 0; k < 50; ++k) packing.sweep(omega);
    packing.write_to(later);
    for (std::size_t i = movers; i < crowd.spheres.size(); ++i) EXPECT_EQ(later.center(i), after.center(i));
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

}  // namespace soft_packing_test
}  // namespace bernal
