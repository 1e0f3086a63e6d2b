#include <benchmark/benchmark.h>

#include <ctime>
#include <string>

#include "support/meshes.hpp"
#include "support/plans.hpp"

// What random close packing in containers costs: whole runs in Han's cylinder, without writing. The time is
// that of the processor, summed over the threads.
namespace bernal {
namespace {

const std::string cylinder = "[container]\nkind = \"cylinder\"\nradius = 1.0\nheight = 2.0\n[spheres]\n";
const std::string equal = "radius = 0.0309\n";
const std::string lognormal = "radius = { distribution = \"lognormal\", median = 0.0309, sigma = 0.3 }\n";
const std::string classes =
    "diameter = { distribution = \"classes\", values = [0.12, 0.04], shares = [1, 1], basis = \"volume\" }\n";
const std::string compression =
    "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\n[[stage]]\ndo = \"shake\"\n"
    "[[stage]]\ndo = \"refill\"\n";

Plan in_cylinder(double packing_fraction, const std::string& sizes) {
  return testing::plan_of(cylinder + "packing_fraction = " + std::to_string(packing_fraction) + "\n" + sizes);
}

/// The cylinder as a prism of `sides` sides.
Plan in_prism(int sides, double packing_fraction) {
  Plan plan = in_cylinder(packing_fraction, equal);
  plan.domain = test::prism_mesh(sides, 1, 2);
  plan.container = nullptr;
  return plan;
}

Packing run_whole(benchmark::State& state, const Plan& plan, int threads = 1) {
  RunOptions options;
  options.threads = threads;
  Packing packing;
  for (auto _ : state) packing = run(plan, options);
  state.counters["spheres"] = static_cast<double>(packing.spheres.size());
  state.counters["packing_fraction"] = packing.packing_fraction();
  return packing;
}

void once(benchmark::internal::Benchmark* b) {
  b->Iterations(1)->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kSecond);
}

void dense(benchmark::State& state, double packing_fraction, const std::string& sizes) {
  run_whole(state, in_cylinder(packing_fraction, sizes), static_cast<int>(state.range(0)));
}
void one_thread(benchmark::internal::Benchmark* b) { b->ArgName("threads")->Arg(1)->Apply(once); }
void for_threads(benchmark::internal::Benchmark* b) { b->ArgName("threads")->Arg(1)->Arg(2)->Apply(once); }
BENCHMARK_CAPTURE(dense, equal_to_060, 0.60, equal)->Apply(one_thread);
BENCHMARK_CAPTURE(dense, equal_to_062, 0.62, equal)->Apply(one_thread);
BENCHMARK_CAPTURE(dense, lognormal_to_064, 0.64, lognormal)->Apply(one_thread);
BENCHMARK_CAPTURE(dense, three_to_one_to_066, 0.66, classes)->Apply(one_thread);
BENCHMARK_CAPTURE(dense, equal_100000_to_060, 0.60, "radius = 0.0208\n")->Apply(for_threads);
BENCHMARK_CAPTURE(dense, equal_320000_to_060, 0.60, "radius = 0.01412\n")->Apply(one_thread);

void dense_in_mesh(benchmark::State& state) {
  run_whole(state, in_prism(static_cast<int>(state.range(0)), 0.60));
}
BENCHMARK(dense_in_mesh)->ArgName("sides")->Arg(64)->Arg(2000)->Apply(once);

/// In one run: how much longer compression takes for its packing than relaxation for a denser one.
void dense_against_compression(benchmark::State& state) {
  RunOptions options;
  options.threads = 1;
  const auto timed = [&](const Plan& plan) {
    const std::clock_t start = std::clock();
    const Packing packing = run(plan, options);
    return std::pair(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, packing.packing_fraction());
  };
  for (auto _ : state) {
    const auto [relaxed, dense] = timed(in_cylinder(0.60, equal));
    const auto [compressed, settled] =
        timed(testing::plan_of(cylinder + "fill = true\n" + equal + compression));
    state.counters["relaxation_s"] = relaxed;
    state.counters["relaxation_packing_fraction"] = dense;
    state.counters["compression_s"] = compressed;
    state.counters["compression_packing_fraction"] = settled;
    state.counters["ratio"] = compressed / relaxed;
  }
}
BENCHMARK(dense_against_compression)->Iterations(1)->MeasureProcessCPUTime()->Unit(benchmark::kSecond);

}  // namespace
}  // namespace bernal
