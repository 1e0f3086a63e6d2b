#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include "bernal/verify/certificate.hpp"
#include "support/fill_work.hpp"

// What it costs to fill a periodic box of given edges with spheres of given radii, on one thread; every
// result is certified, outside the time that is measured.
namespace bernal {
namespace {

using Fill = StageEnd (*)(SpheresInBox&, Reporter&, const FillOptions&);

void run(benchmark::State& state, Fill fill, const std::vector<double>& radii, int dimension,
         double packing_fraction) {
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const Vector<dynamic> box = testing::cube_filled_to(packing_fraction, radii, dimension);
  testing::FillCase filled(radii, box);
  StageEnd end = StageEnd::converged;
  for (auto _ : state) end = fill(filled.in_box, filled.report, {});
  const Spheres<dynamic>& spheres = filled.in_box.spheres;
  if (end != StageEnd::converged || spheres.r != radii || filled.in_box.edges != box)
    state.SkipWithError("not all spheres found a place");
  else if (!certify(spheres, periodic_box(box)).certified)
    state.SkipWithError("not certified");
  state.counters["packing_fraction"] = packing_fraction;
}

void once(benchmark::internal::Benchmark* b) { b->Iterations(1)->Unit(benchmark::kSecond); }

void fill_equal(benchmark::State& state, int dimension, double packing_fraction) {
  run(state, fill_by_relaxation, std::vector<double>(2000, 1.0), dimension, packing_fraction);
}
BENCHMARK_CAPTURE(fill_equal, 1d_to_0980, 1, 0.98)->Apply(once);
BENCHMARK_CAPTURE(fill_equal, 2d_to_0820, 2, 0.82)->Apply(once);
BENCHMARK_CAPTURE(fill_equal, 3d_to_0620, 3, 0.62)->Apply(once);
BENCHMARK_CAPTURE(fill_equal, 4d_to_0435, 4, 0.435)->Apply(once);
BENCHMARK_CAPTURE(fill_equal, 5d_to_0290, 5, 0.29)->Apply(once);
BENCHMARK_CAPTURE(fill_equal, 6d_to_0187, 6, 0.187)->Apply(once);
BENCHMARK_CAPTURE(fill_equal, 7d_to_0110, 7, 0.11)->Apply(once);
BENCHMARK_CAPTURE(fill_equal, 8d_to_0065, 8, 0.065)->Apply(once);

/// Ratios 10 : 4 : 1, volume shares .6, .25, .15.
void fill_three_classes(benchmark::State& state, Fill fill, double packing_fraction) {
  run(state, fill, testing::three_classes(static_cast<std::size_t>(state.range(0))), 3, packing_fraction);
}
void counts(benchmark::internal::Benchmark* b) { b->ArgName("spheres")->Arg(10000)->Arg(40000)->Apply(once); }
BENCHMARK_CAPTURE(fill_three_classes, relaxation_to_070, fill_by_relaxation, 0.70)->Apply(counts);
BENCHMARK_CAPTURE(fill_three_classes, insertion_to_070, fill_by_classes, 0.70)->Apply(counts);
BENCHMARK_CAPTURE(fill_three_classes, relaxation_to_075, fill_by_relaxation, 0.75)->Apply(counts);

}  // namespace
}  // namespace bernal
