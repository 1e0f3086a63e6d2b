// What a prediction costs, by number of rods: equal spheres, classes, lognormal sizes, mixtures and a density
// that is integrated. The sizes are made once.
#include <limits>
#include <vector>

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

std::unique_ptr<SizeDistribution> a_hundred_classes() {
  std::vector<double> radii, shares;
  for (int k = 0; k < 100; ++k) {
    radii.push_back(1 + 0.1 * k);
    shares.push_back(1 + k % 7);
  }
  return make_classes(radii, shares, Basis::volume);
}

std::unique_ptr<SizeDistribution> two_lognormals() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<std::unique_ptr<SizeDistribution>> of;
  of.push_back(make_lognormal(1, 0.3, Basis::volume, 0, infinity));
  of.push_back(make_lognormal(4, 0.6, Basis::volume, 0, infinity));
  return make_mixture(std::move(of), {0.3, 0.7}, Basis::volume);
}

const auto hundred_classes = a_hundred_classes();
const auto mixture = two_lognormals();
const auto normal = make_normal(1, 0.15, Basis::number, 0.1, 2);

void counts(benchmark::internal::Benchmark* b) {
  b->Arg(4000)->Arg(16000)->Arg(64000)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(predict, equal, equal)->Apply(counts);
BENCHMARK_CAPTURE(predict, two_classes, two_classes)->Apply(counts);
BENCHMARK_CAPTURE(predict, hundred_classes, hundred_classes)->Apply(counts);
BENCHMARK_CAPTURE(predict, lognormal, lognormal)->Apply(counts);
BENCHMARK_CAPTURE(predict, two_lognormals, mixture)->Apply(counts);
BENCHMARK_CAPTURE(predict, normal, normal)->Apply(counts);

}  // namespace
