#include <benchmark/benchmark.h>
#include <cuda_runtime_api.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bernal/core/random.hpp"
#include "soft/device_packing.hpp"
#include "soft/growing_box.hpp"
#include "work/random_insertion.hpp"

// What relaxation costs on a GPU: a sweep and lists, on equal spheres that are nearly at rest at random close
// packing, and what its memory gives.
namespace bernal {
namespace {

constexpr float omega = 5;

/// Relaxed until the largest overlaps are a few per cent.
std::unique_ptr<DevicePacking> nearly_at_rest(std::int64_t count) {
  Spheres<3> spheres;
  spheres.resize(static_cast<std::size_t>(count));
  std::ranges::fill(spheres.r, 1.0);
  const Vector<3> edges = Vector<3>::Constant(std::cbrt(static_cast<double>(count) * 4.18879 / 0.86));
  Random random(1, 1);
  place_at_random<3>(spheres, edges, random, 0);
  auto packing = std::make_unique<DevicePacking>(spheres, edges, spheres_on_gpu());
  BoxGrowth growth;
  grow_apart<3>(
      *packing, {.stop = 0.02, .sweeps = 32, .beta = 30}, growth, [] { return false; },
      [](int, double overlap) { return overlap; }, [](double, double) {});
  constexpr int to_rest = 200;
  for (int k = 0; k < to_rest; ++k) packing->sweep(omega);
  packing->sweep_to_overlap(omega);
  return packing;
}

void per_sphere(benchmark::State& state) {
  state.counters["ns_per_sphere"] =
      benchmark::Counter(static_cast<double>(state.range(0)) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Ten at a time, as they are asked for without waiting.
void sweep_on_gpu(benchmark::State& state) {
  const std::unique_ptr<DevicePacking> packing = nearly_at_rest(state.range(0));
  constexpr int at_a_time = 10;
  for (auto _ : state) {
    for (int k = 0; k < at_a_time; ++k) packing->sweep(omega);
    packing->wait();
  }
  per_sphere(state);
  state.counters["ns_per_sphere"].value *= at_a_time;
  state.counters["bytes_a_sphere"] = packing->bytes_a_sweep();
  state.SetLabel(packing->device_name());
}
BENCHMARK(sweep_on_gpu)
    ->ArgName("spheres")
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Arg(10'000'000)
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

void lists_on_gpu(benchmark::State& state) {
  const std::unique_ptr<DevicePacking> packing = nearly_at_rest(state.range(0));
  for (auto _ : state) packing->build_lists();
  per_sphere(state);
}
BENCHMARK(lists_on_gpu)
    ->ArgName("spheres")
    ->Arg(1'000'000)
    ->Arg(10'000'000)
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

/// A copy within it, bytes that are read and written counted.
void memory_of_gpu(benchmark::State& state) {
  constexpr std::size_t bytes = std::size_t{1} << 31;
  void *from = nullptr, *to = nullptr;
  if (cudaMalloc(&from, bytes) != cudaSuccess || cudaMalloc(&to, bytes) != cudaSuccess) {
    state.SkipWithError("there is no GPU with 4 GiB");
    return;
  }
  cudaMemset(from, 1, bytes);
  for (auto _ : state) {
    cudaMemcpy(to, from, bytes, cudaMemcpyDeviceToDevice);
    cudaDeviceSynchronize();
  }
  cudaFree(from);
  cudaFree(to);
  state.counters["GB_a_second"] =
      benchmark::Counter(2e-9 * bytes, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(memory_of_gpu)->UseRealTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace bernal
