#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "bernal/core/boundary.hpp"
#include "bernal/core/random.hpp"
#include "soft/soft_packing.hpp"
#include "support/soft_crowds.hpp"

namespace bernal {
namespace soft_packing_test {

using testing::Crowd;
using testing::equal_crowd;
using testing::mixed_crowd;

constexpr float omega = 5;

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
    const Crowd<3> thin(400, 0.9, {2, 2, 0.25}, 0.9, 1);
    for (const Crowd<3>& crowd : {equal_crowd(3000), mixed_crowd(3000), thin})
      EXPECT_EQ(after_sweeps(crowd, kernels, 60), after_sweeps(crowd, soft_kernels().back(), 60));
  }
}

/// Along axes with walls centres keep their radii from both ends, whatever pushes them, and no two spheres
/// meet across a wall; in every instruction set alike.
TEST(SoftPacking, KeepsSpheresBetweenWalls) {
  for (const std::vector<bool>& walls : {std::vector{false, false, true}, std::vector{true, true, true}})
    for (const Crowd<3>& crowd :
         {equal_crowd(2000), mixed_crowd(2000), Crowd<3>(400, 0.9, {2, 2, 0.25}, 0.9, 1)}) {
      Spheres<3> expected;
      for (const SoftKernels& kernels : soft_kernels()) {
        SCOPED_TRACE(kernels.name);
        SoftPacking packing(crowd.spheres, crowd.edges, kernels);
        packing.keep_between_walls(walls, 1);
        for (int k = 0; k < 60; ++k) packing.sweep(omega);
        Spheres<3> spheres = crowd.spheres;
        Vector<3> edges;
        packing.write_to(spheres, edges);
        for (int k = 0; k < 3; ++k)
          for (std::size_t i = 0; i < spheres.size() && walls[static_cast<std::size_t>(k)]; ++i) {
            const double r = std::min(spheres.r[i], (0.5 - 1e-7) * edges[k]);
            ASSERT_GE(spheres.x[static_cast<std::size_t>(k)][i], r) << i;
            ASSERT_LE(spheres.x[static_cast<std::size_t>(k)][i], edges[k] - r) << i;
          }
        if (expected.size() == 0) expected = spheres;
        EXPECT_EQ(spheres, expected);
      }
    }
}

/// One that is pushed off a wall lies where the other pushes it to, and one that is pushed at it stops there.
TEST(SoftPacking, StopsSpheresAtWalls) {
  Spheres<3> spheres;
  spheres.push_back({1, 1, 0.15}, 0.1);
  spheres.push_back({1, 1, 0.25}, 0.1);
  SoftPacking packing(spheres, Vector<3>(2, 2, 2), soft_kernels().front());
  packing.keep_between_walls({false, false, true}, 1);
  for (int k = 0; k < 20; ++k) packing.sweep(1);
  Vector<3> edges;
  packing.write_to(spheres, edges);
  EXPECT_NEAR(spheres.x[2][0], 0.1, 1e-6);
  EXPECT_NEAR(spheres.x[2][1], 0.3, 1e-6);
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

/// With omega = 0 nothing moves: the overlaps and forces are those of all images of all pairs.
template <int D>
void expect_all_images(const Crowd<D>& crowd) {
  const Boundary<D> boundary{crowd.edges};
  const std::size_t n = crowd.spheres.size();
  std::vector<double> squeezes(n, 0.0), forces(n, 0.0);
  double largest = 0;
  int second_images = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      const double reach = crowd.spheres.r[i] + crowd.spheres.r[j];
      int images = 0;
      boundary.for_each_image(crowd.spheres.center(i) - crowd.spheres.center(j), reach,
                              [&](const Vector<D>& away) {
                                const double ratio = 1 - away.norm() / reach;
                                if (!(ratio > 0)) return;
                                squeezes[i] += ratio * ratio;
                                forces[i] += 2 * crowd.spheres.r[i] * crowd.spheres.r[j] * ratio;
                                largest = std::max(largest, ratio);
                                if (++images > 1) ++second_images;
                              });
    }
  EXPECT_GE(second_images, 10);
  for (const SoftKernels& kernels : soft_kernels()) {
    SCOPED_TRACE(kernels.name);
    SoftPacking packing(crowd.spheres, crowd.edges, kernels);
    EXPECT_NEAR(packing.sweep_and_measure(0), largest, 2e-6);
    const std::vector<float> squeeze = packing.squeeze(), force = packing.forces();
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(squeeze[i], squeezes[i], 2e-5 * (1 + squeezes[i])) << i;
      EXPECT_NEAR(force[i], forces[i], 2e-5 * (1 + forces[i])) << i;
    }
  }
}

TEST(SoftPacking, MeetsAllImagesInNarrowBoxes) {
  expect_all_images(Crowd<3>(40, 4, {1, 1.1, 1.2}, 0.7, 1));  // along all axes
  expect_all_images(Crowd<3>(400, 0.9, {0.25, 2, 2}, 0.9, 1));
  expect_all_images(Crowd<3>(200, 0.9, {0.2, 6, 0.2}, 0.9, 1));
  expect_all_images(Crowd<2>(60, 0.9, {9, 0.4}, 0.8, 1));
  expect_all_images(Crowd<1>(12, 8, Vector<1>(1.0), 0.8, 1));
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

}  // namespace soft_packing_test
}  // namespace bernal
