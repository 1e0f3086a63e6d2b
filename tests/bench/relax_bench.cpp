#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <ctime>
#include <deque>
#include <functional>
#include <queue>
#include <string>
#include <utility>

#include "bernal/core/dimension.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "core/large_pages.hpp"
#include "core/parallel.hpp"
#include "soft/published_loop.hpp"
#include "soft/soft_packing.hpp"
#include "support/sorted_cells.hpp"
#include "work/random_insertion.hpp"

// What relaxation costs: a sweep and a list of the fast path, by instruction set, sizes and threads, on
// spheres that are nearly at rest at random close packing.
namespace bernal {
namespace {

constexpr float omega = 5;

Scene scene_of(const std::string& sizes, std::int64_t count, const std::string& stage) {
  return parse_scene("[container]\nkind = \"periodic\"\n[spheres]\ncount = " + std::to_string(count) +
                         "\nradius = " + sizes + "\n[[stage]]\ndo = \"relax\"\n" + stage,
                     "bench.toml");
}

const std::string equal = "1.0";
const std::string two_sizes = "{ distribution = \"classes\", values = [1.0, 0.5], shares = [1, 1] }";
const std::string lognormal = "{ distribution = \"lognormal\", median = 1.0, sigma = 0.3 }";
/// Small spheres are a fifth of the volume and all but fifty of the number.
const std::string one_to_twenty =
    "{ distribution = \"classes\", values = [20.0, 1.0], shares = [80, 20], basis = \"volume\" }";

struct Crowd {
  Spheres<3> spheres;
  Vector<3> edges;
};

/// Spheres pushed apart until the largest overlaps are some per cent.
Crowd crowd(const std::string& sizes, std::int64_t count) {
  RunOptions options;
  options.threads = 1;
  const Packing packing = run(build(scene_of(sizes, count, "alpha = 0.2\nstop = 0.02")), options);
  return {packing.spheres.in<3>(), 0.99 * std::get<Box>(packing.domain).size};
}

void per_sphere(benchmark::State& state, std::size_t spheres) {
  state.counters["ns_per_sphere"] =
      benchmark::Counter(static_cast<double>(spheres) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// How many times as fast so many threads visit the blocks as one does, if a visit takes as long as it copies
/// places, and a thread that is free takes the visit that has been ready for longest.
double speedup(const SoftBlocks& blocks, std::size_t threads) {
  const Precedence& order = blocks.order();
  std::vector<std::uint32_t> left;
  std::deque<std::size_t> ready;
  double all = 0, now = 0;
  for (std::size_t b = 0; b < order.size(); ++b) {
    left.push_back(order.waits_for(b));
    if (left.back() == 0) ready.push_back(b);
    all += static_cast<double>(blocks.places_of_visit(b));
  }
  using Visit = std::pair<double, std::size_t>;  // its end, and the block
  std::priority_queue<Visit, std::vector<Visit>, std::greater<>> under_way;
  while (!ready.empty() || !under_way.empty()) {
    for (; !ready.empty() && under_way.size() < threads; ready.pop_front())
      under_way.emplace(now + static_cast<double>(blocks.places_of_visit(ready.front())), ready.front());
    const auto [end, block] = under_way.top();
    under_way.pop();
    now = end;
    for (const std::uint32_t next : order.waiting(block))
      if (--left[next] == 0) ready.push_back(next);
  }
  return all / now;
}

void sweep(benchmark::State& state, const std::string& sizes) {
  const auto kernel = static_cast<std::size_t>(state.range(1));
  const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(state.range(2)));
  if (kernel >= soft_kernels().size()) {
    state.SkipWithError("not on this processor");
    return;
  }
  const Crowd start = crowd(sizes, state.range(0));
  SoftPacking packing(start.spheres, start.edges, soft_kernels()[kernel]);
  // Until lists last: of many spheres so few sweeps are timed that theirs would be counted.
  constexpr int to_rest = 100;
  for (int k = 0; k < to_rest; ++k) packing.sweep(omega);
  for (auto _ : state) packing.sweep(omega);
  state.SetLabel(std::string(soft_kernels()[kernel].name));
  per_sphere(state, start.spheres.size());
  const auto bytes = static_cast<double>(packing.bytes_a_sweep());
  state.counters["bytes_a_sphere"] = bytes / static_cast<double>(start.spheres.size());
  state.counters["GB_a_second"] =
      benchmark::Counter(1e-9 * bytes, benchmark::Counter::kIsIterationInvariantRate);
  if (const SoftBlocks* blocks = packing.blocks()) {
    state.counters["blocks"] = static_cast<double>(blocks->order().size());
    for (const std::size_t n : {16, 64})
      state.counters["times_on_" + std::to_string(n)] = speedup(*blocks, n);
  }
}
void kernels_and_sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"spheres", "kernel", "threads"})->UseRealTime();
  for (const std::int64_t kernel : {0, 1, 2}) b->Args({10000, kernel, 1});
  b->Args({1000, 0, 1})
      ->Args({100000, 0, 1})
      ->Args({100000, 0, 2})
      ->Args({1000000, 0, 1})
      ->Args({1000000, 0, 2})
      ->Args({10000000, 0, 1})
      ->Args({10000000, 0, 2});
}
BENCHMARK_CAPTURE(sweep, equal, equal)->Apply(kernels_and_sizes);
BENCHMARK_CAPTURE(sweep, two_sizes, two_sizes)
    ->ArgNames({"spheres", "kernel", "threads"})
    ->Args({10000, 0, 1});
BENCHMARK_CAPTURE(sweep, lognormal, lognormal)
    ->ArgNames({"spheres", "kernel", "threads"})
    ->Args({10000, 0, 1});

/// What memory gives at most: a = b + s c over arrays that no cache holds, in pages of 2 MiB.
void memory(benchmark::State& state) {
  constexpr std::size_t size = std::size_t{1} << 25;
  const auto threads = static_cast<std::size_t>(state.range(0));
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
  std::vector<double> a, b, c;
  for (auto* array : {&a, &b, &c}) {
    resize_anew(*array, size);
    std::ranges::fill(*array, 1.0);
  }
  for (auto _ : state)
    parallel_ranges(size, size / 16, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) a[i] = b[i] + 0.5 * c[i];
      benchmark::ClobberMemory();
    });
  state.counters["GB_a_second"] =
      benchmark::Counter(24e-9 * size, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(memory)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime();

/// The published loop on linked lists and on sorted arrays: the same sweeps, to the bit. Crowded: the first
/// twenty from random places at 0.86, when spheres change their cells all the time; else nearly at rest.
template <template <int> class Cells>
void published_sweep(benchmark::State& state, const std::string& sizes) {
  const bool crowded = state.range(1) == 1;
  Crowd start = crowd(sizes, state.range(0));
  const Vector<3> edges = start.edges;
  if (crowded) {
    double volume = 0;
    for (const double r : start.spheres.r) volume += ball_volume(3, r);
    start.edges *= std::cbrt(volume / 0.86 / edges.prod());
    Random random(1, 1);
    place_at_random<3>(start.spheres, start.edges, random);
  } else {
    start.edges /= 0.99;
    resize_box<3>(start.spheres, start.edges, edges);
  }
  PublishedLoop<3, Cells> loop(start.spheres, start.edges, false, Random(1, 2));
  if (!crowded) loop.sweep();
  const std::uint64_t tested = loop.pairs_tested();
  for (auto _ : state) loop.sweep();
  per_sphere(state, start.spheres.size());
  state.counters["pair_tests"] = static_cast<double>(loop.pairs_tested() - tested) /
                                 static_cast<double>(start.spheres.size()) /
                                 static_cast<double>(state.iterations());
}
void sizes_of_published(benchmark::internal::Benchmark* b) {
  b->ArgNames({"spheres", "crowded"})->Iterations(20)->Unit(benchmark::kMillisecond);
  for (const std::int64_t crowded : {1, 0})
    for (const std::int64_t spheres : {1000, 10000, 100000, 1000000}) b->Args({spheres, crowded});
}
void one_size_of_published(benchmark::internal::Benchmark* b) {
  b->ArgNames({"spheres", "crowded"})->Iterations(20)->Unit(benchmark::kMillisecond)->Args({10000, 0});
}
void linked_sweep(benchmark::State& state, const std::string& sizes) {
  published_sweep<LinkedCells>(state, sizes);
}
BENCHMARK_CAPTURE(linked_sweep, equal, equal)->Apply(sizes_of_published);
BENCHMARK_CAPTURE(linked_sweep, lognormal, lognormal)->Apply(one_size_of_published);
void sorted_sweep(benchmark::State& state, const std::string& sizes) {
  published_sweep<SortedCells>(state, sizes);
}
BENCHMARK_CAPTURE(sorted_sweep, equal, equal)->Apply(sizes_of_published);
BENCHMARK_CAPTURE(sorted_sweep, lognormal, lognormal)->Apply(one_size_of_published);

/// From scratch: sorting the spheres and finding their neighbours.
void build_lists(benchmark::State& state, const std::string& sizes) {
  const Crowd start = crowd(sizes, state.range(0));
  const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(state.range(1)));
  std::vector<SoftSphere> spheres;
  std::vector<std::uint32_t> ids;
  std::array<double, 3> edges;
  for (int k = 0; k < 3; ++k) edges[static_cast<std::size_t>(k)] = start.edges[k];
  double mean = 0;
  for (std::size_t i = 0; i < start.spheres.size(); ++i) {
    SoftSphere s{};
    for (std::size_t k = 0; k < 3; ++k)
      s.x[k] = static_cast<std::int32_t>(
          static_cast<std::uint32_t>(std::fmod(start.spheres.x[k][i] / edges[k], 1.0) * 4294967295.0));
    s.r = static_cast<float>(start.spheres.r[i]);
    mean += s.r / static_cast<double>(start.spheres.size());
    spheres.push_back(s);
    ids.push_back(static_cast<std::uint32_t>(i));
  }
  const std::vector<float> radii(start.spheres.r.begin(), start.spheres.r.end());
  const SoftSizes of_radii(radii);
  SoftLists lists(soft_kernels().front());
  for (auto _ : state) lists.build(spheres, ids, edges, of_radii, static_cast<float>(0.4 * mean));
  per_sphere(state, start.spheres.size());
}
void spheres_and_threads(benchmark::internal::Benchmark* b) {
  b->ArgNames({"spheres", "threads"})->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(build_lists, equal, equal)
    ->Apply(spheres_and_threads)
    ->UseRealTime()
    ->Args({10000, 1})
    ->Args({100000, 1})
    ->Args({100000, 2});
BENCHMARK_CAPTURE(build_lists, lognormal, lognormal)->Apply(spheres_and_threads)->Args({10000, 1});
BENCHMARK_CAPTURE(build_lists, one_to_twenty, one_to_twenty)->Apply(spheres_and_threads)->Args({100000, 1});

/// Whole runs, without writing: the schedule from quick to thorough, and the published loop for comparison.
void relax(benchmark::State& state, const std::string& sizes, const char* method) {
  const std::string stage = "alpha = " + std::to_string(state.range(1)) + "\nmethod = \"" + method + "\"\n";
  const Plan plan = build(scene_of(sizes, state.range(0), stage));
  RunOptions options;
  options.threads = static_cast<int>(state.range(2));
  Packing packing;
  for (auto _ : state) packing = run(plan, options);
  state.counters["packing_fraction"] = packing.packing_fraction();
}
void once(benchmark::internal::Benchmark* b) {
  b->ArgNames({"spheres", "alpha", "threads"})
      ->Iterations(1)
      ->MeasureProcessCPUTime()
      ->UseRealTime()
      ->Unit(benchmark::kSecond);
}
BENCHMARK_CAPTURE(relax, equal, equal, "fast")
    ->Apply(once)
    ->Args({10000, 5, 1})
    ->Args({10000, 17, 1})
    ->Args({100000, 2, 1})
    ->Args({100000, 2, 2});
BENCHMARK_CAPTURE(relax, one_to_twenty, one_to_twenty, "fast")->Apply(once)->Args({100000, 2, 1});

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Processor time of one run on one thread, and what it reached.
std::pair<double, double> timed(const std::string& sizes, std::int64_t count, const std::string& stage) {
  const Plan plan = build(scene_of(sizes, count, stage));
  RunOptions options;
  options.threads = 1;
  const double start = processor_seconds();
  const Packing packing = run(plan, options);
  return {processor_seconds() - start, packing.packing_fraction()};
}

/// How time grows with the number of spheres: time ~ N^exponent, from one size to the next and over all.
void relax_growth(benchmark::State& state) {
  for (auto _ : state) {
    double first = 0, last = 0;
    for (std::int64_t decade = 3, count = 1000; decade <= 6; ++decade, count *= 10) {
      const auto [seconds, fraction] = timed(equal, count, "alpha = 2");
      const std::string name = "1e" + std::to_string(decade);
      state.counters[name + "_s"] = seconds;
      state.counters[name + "_packing_fraction"] = fraction;
      if (decade == 3)
        first = seconds;
      else
        state.counters[name + "_exponent"] = std::log10(seconds / last);
      last = seconds;
    }
    state.counters["exponent"] = std::log10(last / first) / 3;
  }
}
BENCHMARK(relax_growth)->Iterations(1)->MeasureProcessCPUTime()->Unit(benchmark::kSecond);

/// The published loop with the published parameters over the fast path where it packs as densely.
void relax_fast_against_reference(benchmark::State& state) {
  for (auto _ : state) {
    const auto [fast, dense] = timed(equal, 10000, "alpha = 2");
    const auto [reference, as_published] = timed(equal, 10000, "alpha = 17\nmethod = \"reference\"");
    state.counters["fast_s"] = fast;
    state.counters["fast_packing_fraction"] = dense;
    state.counters["reference_s"] = reference;
    state.counters["reference_packing_fraction"] = as_published;
    state.counters["ratio"] = reference / fast;
  }
}
BENCHMARK(relax_fast_against_reference)->Iterations(1)->MeasureProcessCPUTime()->Unit(benchmark::kSecond);

}  // namespace
}  // namespace bernal
