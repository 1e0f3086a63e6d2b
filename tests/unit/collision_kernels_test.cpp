#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/random.hpp"
#include "hard/collision_kernels.hpp"

namespace bernal {
namespace collision_kernels_test {

constexpr double never = std::numeric_limits<double>::infinity();

/// Spheres in a box of edge 10, and what a scan of all of them needs.
template <int D>
struct Swarm {
  std::vector<FlyingSphere<D>> spheres;
  std::vector<std::uint32_t> neighbors;
  std::vector<double> columns, delays;
  CollisionScan<D> scan{};

  Swarm(std::size_t n, double growth, double spread, std::uint64_t seed = 1) {
    Random random(seed, stream(Stream::test));
    scan.now = 0.3;
    for (std::size_t i = 0; i < n; ++i) {
      FlyingSphere<D> s;
      for (int k = 0; k < D; ++k) {
        s.x0[k] = random.uniform(0, spread);
        s.v[k] = random.uniform(-1, 1);
      }
      s.r = random.uniform(0.1, 0.6);
      spheres.push_back(s);
      if (i > 0) neighbors.push_back(static_cast<std::uint32_t>(i));
    }
    scan.stride = (n + 2 * widest) / widest * widest;
    columns.resize((2 * D + 2) * scan.stride);
    delays.resize(scan.stride);
    scan.spheres = spheres.data();
    scan.self = &spheres[0];
    scan.neighbors = neighbors.data();
    scan.count = neighbors.size();
    scan.size = 0.9;
    scan.growth = growth;
    for (int k = 0; k < D; ++k) scan.edges[k] = 10, scan.inverse_edges[k] = 0.1;
    scan.columns = columns.data();
    scan.delays = delays.data();
  }

  /// Between the centres of sphere 0 and sphere j at `delay` after now.
  double distance(std::uint32_t j, double delay) const {
    const double t = scan.now + delay;
    const FlyingSphere<D>&a = spheres[0], &b = spheres[j];
    const Boundary<D> boundary{Vector<D>::Constant(10)};
    const Vector<D> now = b.position(scan.now) - a.position(scan.now);
    const Vector<D> shift = boundary.minimum_image(now) - now;
    return (b.position(t) + shift - a.position(t)).norm();
  }
  double gap(std::uint32_t j, double delay) const {
    const double size = scan.size + scan.growth * (scan.now + delay);
    return distance(j, delay) - (spheres[0].r + spheres[j].r) * size;
  }
};

template <class T>
class CollisionKernels : public ::testing::Test {};
template <int D>
using Dimension = std::integral_constant<int, D>;
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>, Dimension<4>, Dimension<5>, Dimension<6>>;
TYPED_TEST_SUITE(CollisionKernels, Dimensions);

TYPED_TEST(CollisionKernels, GiveTheSameBitsInEveryInstructionSet) {
  constexpr int D = TypeParam::value;
  for (const double growth : {0.0, 0.05, 2.0}) {
    Swarm<D> swarm(100, growth, 10);
    collision_kernels<D>().back().scan(swarm.scan);
    const std::vector<double> expected = swarm.delays;
    for (const CollisionKernel<D>& kernel : collision_kernels<D>()) {
      SCOPED_TRACE(kernel.name);
      const FirstCollision first = kernel.scan(swarm.scan);
      EXPECT_EQ(swarm.delays, expected);
      EXPECT_EQ(first.delay, expected[first.neighbor]);
    }
  }
}

/// The oracle: the gap never opens to below zero before the delay, and closes there; where no collision is
/// found it stays open as far as anyone looks.
TYPED_TEST(CollisionKernels, FindWhenTheGapCloses) {
  constexpr int D = TypeParam::value;
  int collisions = 0, outgrown = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Swarm<D> swarm(60, seed % 2 ? 0.05 : 1.5, 4, seed);
    collision_kernels<D>().front().scan(swarm.scan);
    for (std::size_t m = 0; m < swarm.scan.count; ++m) {
      const std::uint32_t j = swarm.neighbors[m];
      const double delay = swarm.delays[m];
      if (swarm.gap(j, 0) <= 0) continue;  // overlaps, which no engine lets happen
      const double until = std::min(delay, 2.0);
      for (int step = 1; step < 200; ++step)
        ASSERT_GT(swarm.gap(j, until * step / 200 * (1 - 1e-12)), -1e-12) << "seed " << seed;
      if (delay == never) continue;
      EXPECT_NEAR(swarm.gap(j, delay), 0, 1e-12 * (1 + delay));
      ++collisions;
      outgrown += swarm.distance(j, 1e-6) > swarm.distance(j, 0);
    }
  }
  EXPECT_GT(collisions, 50);
  EXPECT_GT(outgrown, 0);  // parting first, and overtaken by their growth
}

TEST(CollisionKernels, CollideNowWhatOverlapsAndComesCloser) {
  Swarm<3> swarm(2, 0, 1);
  for (int k = 0; k < 3; ++k)
    swarm.spheres[0].x0[k] = swarm.spheres[1].x0[k] = 5, swarm.spheres[1].v[k] = swarm.spheres[0].v[k] = 0;
  swarm.spheres[0].r = swarm.spheres[1].r = 0.5 / 0.9;
  swarm.spheres[1].set_course(swarm.scan.now, {6 * (1 - 1e-15), 5, 5}, {-1, 0, 0});
  EXPECT_EQ(collision_kernels<3>().front().scan(swarm.scan).delay, 0);
  swarm.spheres[1].set_course(swarm.scan.now, {6 * (1 - 1e-15), 5, 5}, {1, 0, 0});  // it parts: never
  EXPECT_EQ(collision_kernels<3>().front().scan(swarm.scan).delay, never);
}

TEST(CollisionKernels, SeeThePartnerAcrossTheFace) {
  Swarm<3> swarm(2, 0, 1);
  for (FlyingSphere<3>& sphere : swarm.spheres) sphere.r = 0.5 / 0.9;
  swarm.spheres[0].set_course(swarm.scan.now, {0.5, 5, 5}, {-1, 0, 0});
  swarm.spheres[1].set_course(swarm.scan.now, {8.5, 5, 5}, {0, 0, 0});
  EXPECT_NEAR(collision_kernels<3>().front().scan(swarm.scan).delay, 1.0, 1e-14);
}

TEST(CollisionKernels, HaveNothingToSayWithoutNeighbors) {
  Swarm<2> swarm(1, 0.1, 1);
  EXPECT_EQ(collision_kernels<2>().front().scan(swarm.scan).delay, never);
}

}  // namespace collision_kernels_test
}  // namespace bernal
