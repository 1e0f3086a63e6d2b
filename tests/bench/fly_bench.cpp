// Collision filling in n dimensions: the search for neighbours among all pairs against grids over the first k
// axes, and where they cross; accepted insertions per second against the size of a batch; how the patent's
// procedure grows with N.
#include <cmath>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "fly/fly_events.hpp"
#include "fly/fly_patent.hpp"
#include "support/fill_work.hpp"

namespace {

using namespace bernal;

/// About random-sequential saturation, by dimension.
constexpr double saturated[] = {0.74, 0.54, 0.38, 0.25, 0.16, 0.09, 0.05, 0.028};

/// How far apart neighbours are: a diameter and the surface distance.
constexpr double reach = 2.3;

/// Of a cube with N unit spheres.
template <int D>
double edge_for(std::size_t n) {
  return std::pow(static_cast<double>(n) * ball_volume(D, 1) / saturated[D - 1], 1.0 / D);
}

/// All neighbours of all of N unit spheres at random in a periodic box, within a surface distance of 0.3; the
/// grid's time to sort is part of it.
template <int D>
void near_pairs(benchmark::State& state, std::size_t n, int axes) {
  const Vector<D> edges = Vector<D>::Constant(edge_for<D>(n));
  PartialGrid::EachAxis<bool> repeats;
  repeats.fill(true);
  Random random(1, stream(Stream::test));
  Spheres<D> spheres;
  for (std::size_t i = 0; i < n; ++i)
    spheres.push_back(uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges}), 1);
  std::size_t found = 0;
  int used = 0;
  for (auto _ : state) {
    PartialGrid grid(edges, repeats, reach, 0, n, axes);
    grid.set_largest(1);
    grid.sort(columns_of(spheres.x), spheres.r, n);
    used = grid.axes();
    found = 0;
    for (std::size_t i = 0; i < n; ++i)
      grid.for_each_near(spheres.center(i).data(), 1.3, [&](std::uint32_t, double) { ++found; });
  }
  benchmark::DoNotOptimize(found);
  state.SetLabel(used == 0 ? "all pairs" : "grid");
  state.counters["s/sphere"] = benchmark::Counter(
      static_cast<double>(n), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// With the number of axes that the grid chooses, and with every number to hold that against.
template <int D>
void on_every_number_of_axes() {
  for (const std::size_t n : {64, 256, 1000, 4000, 16000}) {
    const int most = edge_for<D>(n) < 4 * reach ? 0 : std::min(D, 4);  // no grid has less than four cells
    for (int axes = PartialGrid::automatic; axes <= most; ++axes) {
      const std::string grid = axes == PartialGrid::automatic ? "chosen" : std::to_string(axes);
      const std::string name = fmt::format("near_pairs<{}>/N:{}/axes:{}", D, n, grid);
      benchmark::RegisterBenchmark(name.c_str(), near_pairs<D>, n, axes)
          ->Unit(benchmark::kMicrosecond)
          ->MinTime(0.02);
    }
  }
}
template <int... D>
bool in_every_dimension(std::integer_sequence<int, D...>) {
  (on_every_number_of_axes<D>(), ...);
  return true;
}
[[maybe_unused]] const bool registered =
    in_every_dimension(std::integer_sequence<int, 2, 3, 4, 5, 6, 7, 8>{});

/// Fills a cube with N unit spheres to the packing fraction.
template <int D>
void fill(benchmark::State& state, bool patent, std::size_t n, double phi, int batch) {
  std::size_t placed = 0;
  std::uint64_t collisions = 0;
  for (auto _ : state) {
    const double edge = std::pow(static_cast<double>(n) * ball_volume(D, 1) / phi, 1.0 / D);
    testing::FillCase filled(std::vector<double>(n, 1.0), Vector<dynamic>::Constant(D, edge));
    const Fly options{.batch = batch, .dt = patent ? 0.01 : 0.25, .patience = 1e5};
    patent ? fly_by_patent(filled.in_box, filled.report, options)
           : fly_by_events(filled.in_box, filled.report, options);
    placed = filled.in_box.spheres.size();
    collisions = filled.effects["collisions"].calls;
  }
  state.counters["phi"] = phi * static_cast<double>(placed) / static_cast<double>(n);
  state.counters["collisions"] = static_cast<double>(collisions);
  state.counters["insertions/s"] =
      benchmark::Counter(static_cast<double>(placed), benchmark::Counter::kIsIterationInvariantRate);
}

void insertions_by_batch(benchmark::State& state, bool patent) {
  fill<3>(state, patent, 1000, patent ? 0.38 : 0.43, static_cast<int>(state.range(0)));
}
void every_batch(benchmark::internal::Benchmark* bench) {
  bench->ArgName("batch")->Unit(benchmark::kMillisecond)->Iterations(1);
  for (const int batch : {10, 100, 1000, 10000}) bench->Arg(batch);
}
BENCHMARK_CAPTURE(insertions_by_batch, patent, true)->Apply(every_batch);
BENCHMARK_CAPTURE(insertions_by_batch, flight, false)->Apply(every_batch);

void time_by_number(benchmark::State& state, bool patent) {
  fill<3>(state, patent, static_cast<std::size_t>(state.range(0)), 0.40, 0);
}
void every_count(benchmark::internal::Benchmark* bench) {
  bench->ArgName("N")->Unit(benchmark::kMillisecond)->Iterations(1);
  for (const int n : {250, 500, 1000, 2000}) bench->Arg(n);
}
BENCHMARK_CAPTURE(time_by_number, patent, true)->Apply(every_count);
BENCHMARK_CAPTURE(time_by_number, flight, false)->Apply(every_count);

void fill_plane(benchmark::State& state, bool patent, double phi) { fill<2>(state, patent, 2000, phi, 0); }
void fill_space(benchmark::State& state, bool patent, double phi) { fill<3>(state, patent, 2000, phi, 0); }
void once(benchmark::internal::Benchmark* bench) { bench->Unit(benchmark::kMillisecond)->Iterations(1); }
BENCHMARK_CAPTURE(fill_plane, patent_to_0640, true, 0.64)->Apply(once);
BENCHMARK_CAPTURE(fill_space, patent_to_0420, true, 0.42)->Apply(once);
BENCHMARK_CAPTURE(fill_plane, flight_to_0700, false, 0.70)->Apply(once);
BENCHMARK_CAPTURE(fill_space, flight_to_0480, false, 0.48)->Apply(once);

}  // namespace
