#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>

#include "bernal/core/dimension.hpp"
#include "bernal/core/random.hpp"
#include "support/near_indices.hpp"

// What every index costs a sphere that is put into it and then asked for its neighbours, in one thread:
// random places at a packing fraction of 0.6, equal spheres, and those whose centres are nearer than 1.2
// diameters.
namespace bernal {
namespace {

template <class Index, int D>
void near_all(benchmark::State& state) {
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const auto count = static_cast<std::size_t>(state.range(0));
  const double r = std::pow(0.6 / (ball_volume(D, 1) * static_cast<double>(count)), 1.0 / D);
  const Vector<D> edges = Vector<D>::Ones();
  Random random(1, stream(Stream::test));
  Spheres<D> spheres;
  for (std::size_t i = 0; i < count; ++i)
    spheres.push_back(uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges}), r);
  std::size_t found = 0;
  for (auto _ : state) {
    const Index index(spheres, edges, 1.4 * r);
    found = 0;
    for (std::size_t i = 0; i < count; ++i) index.near(spheres.center(i), [&](std::uint32_t) { ++found; });
  }
  const auto n = static_cast<double>(count);
  state.counters["near"] = static_cast<double>(found) / n;
  state.counters["s/sphere"] =
      benchmark::Counter(n, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

#define BERNAL_NEAR(Index, D, least, most) \
  BENCHMARK(near_all<test::Index<D>, D>)   \
      ->RangeMultiplier(10)                \
      ->Range(least, most)                 \
      ->Unit(benchmark::kMillisecond)
BERNAL_NEAR(InCellGrid, 3, 1'000, 1'000'000);
BERNAL_NEAR(InLinkedCells, 3, 1'000, 1'000'000);
BERNAL_NEAR(InSortedCells, 3, 1'000, 1'000'000);
BERNAL_NEAR(InPointGrid, 3, 1'000, 1'000'000);
BERNAL_NEAR(InPartialGrid, 3, 1'000, 1'000'000);
BERNAL_NEAR(InFixedPointGrid, 3, 1'000, 1'000'000);
BERNAL_NEAR(InHomeGrid, 3, 1'000, 1'000'000);
BERNAL_NEAR(InSphereTree, 3, 1'000, 1'000'000);
BERNAL_NEAR(InCellGrid, 5, 1'000, 10'000);
BERNAL_NEAR(InPointGrid, 5, 1'000, 10'000);
BERNAL_NEAR(InPartialGrid, 5, 1'000, 10'000);
BERNAL_NEAR(InFixedPointGrid, 5, 1'000, 10'000);
BERNAL_NEAR(InCellGrid, 7, 1'000, 1'000);
BERNAL_NEAR(InPartialGrid, 7, 1'000, 1'000);
BERNAL_NEAR(InFixedPointGrid, 7, 1'000, 1'000);
#undef BERNAL_NEAR

}  // namespace
}  // namespace bernal
