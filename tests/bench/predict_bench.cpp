// What a prediction costs, by number of rods: lognormal sizes, two classes, equal spheres.
#include <limits>

#include <benchmark/benchmark.h>

#include "bernal/predict/predict.hpp"

namespace {

using namespace bernal;

void predict(benchmark::State& state, const std::unique_ptr<SizeDistribution>& sizes) {
  Prediction p;
  for (auto _ : state) p = predict_packing_fraction(*sizes, static_cast<int>(state.range(0)));
  state.counters["phi"] = p.phi;
  state.counters["error"] = p.error;
}

const auto equal = make_constant(1);
const auto two_classes = make_classes({1, 5}, {0.25, 0.75}, Basis::volume);
const auto lognormal = make_lognormal(1, 0.5, Basis::number, 0, std::numeric_limits<double>::infinity());

void counts(benchmark::internal::Benchmark* b) {
  b->Arg(4000)->Arg(16000)->Arg(64000)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(predict, equal, equal)->Apply(counts);
BENCHMARK_CAPTURE(predict, two_classes, two_classes)->Apply(counts);
BENCHMARK_CAPTURE(predict, lognormal, lognormal)->Apply(counts);

}  // namespace
