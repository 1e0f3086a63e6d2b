// What the certificate costs: 27,000 spheres that touch or nearly touch, filtered against exact, and the
// growth with N, in containers and in periodic boxes. Sizes and containers are those of Han, Feng & Owen's
// cylinder as the project's scenes state it.
#include <cmath>

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/random.hpp"
#include "bernal/verify/certificate.hpp"
#include "core/close_packing.hpp"
#include "support/integer_meshes.hpp"

namespace {

using namespace bernal;

/// A hexagonal close packing of about n spheres in the cylinder (or prism) of radius 1 and height 2 about the
/// z axis. Every sphere is jittered by up to `jitter` of its radius and shrunk as much, so that gaps run from
/// 0 up.
Spheres<3> close_packing(double n, double jitter) {
  const double spacing = std::cbrt(std::sqrt(2.0) * 2 * M_PI / n);
  const double r = 0.5 * spacing;
  Random random(1, stream(Stream::test));
  Spheres<3> s;
  for (int layer = 0; r + layer * spacing * std::sqrt(2.0 / 3) <= 2 - r; ++layer)
    for (int row = -1000; row <= 1000; ++row) {
      const double y = (row + (layer % 2) / 3.0) * spacing * std::sqrt(0.75);
      if (std::abs(y) > 1) continue;
      const int half = static_cast<int>(1 / spacing) + 1;
      for (int k = -half; k <= half; ++k) {
        const double x = (k + 0.5 * ((row & 1) + layer % 2)) * spacing;
        if (std::hypot(x, y) > (1 - r) * std::cos(M_PI / 50)) continue;
        const Vector<3> c{x, y, r + layer * spacing * std::sqrt(2.0 / 3)};
        s.push_back(c + jitter * r * random.uniform() * uniform_direction<3>(random), r * (1 - jitter));
      }
    }
  return s;
}

const Domain cylinder = Cylinder{.base = {0, 0, 0}, .axis = {0, 0, 1}, .radius = 1, .height = 2};
const Domain prism = meshes::regular_prism(50, 1, 2);  // 196 triangles

void certificate_of(benchmark::State& state, const Spheres<dynamic>& s, const Domain& container,
                    Arithmetic arithmetic) {
  Certificate c;
  tbb::task_arena one_thread(1);
  one_thread.execute([&] {
    for (auto _ : state) c = certify(s, container, {.arithmetic = arithmetic});
  });
  state.SetLabel(c.statement);
  state.counters["spheres"] = static_cast<double>(c.spheres);
  state.counters["decisions"] = static_cast<double>(c.decided_double + c.decided_exact);
  state.counters["exact"] = static_cast<double>(c.decided_exact);
  state.counters["s/sphere"] =
      benchmark::Counter(static_cast<double>(c.spheres),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void certificate(benchmark::State& state, const Domain& container, double jitter, Arithmetic arithmetic) {
  certificate_of(state, close_packing(static_cast<double>(state.range(0)), jitter), container, arithmetic);
}

/// A ball-like mesh around the whole, 2 n² triangles.
Mesh globe(std::uint32_t n, double radius) {
  Mesh mesh;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const double theta = M_PI * i / n, phi = 2 * M_PI * j / n;
      const double across = i == 0 || i == n ? 0 : std::sin(theta);
      mesh.vertices.push_back(
          {radius * across * std::cos(phi), radius * across * std::sin(phi), 1 + radius * std::cos(theta)});
    }
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * n + j, b = i * n + (j + 1) % n, c = a + n, d = b + n;
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a, d, b});
    }
  return mesh;
}

void triangles(benchmark::State& state) {
  const auto n = static_cast<std::uint32_t>(std::sqrt(state.range(0) / 2.0));
  certificate_of(state, close_packing(100'000, 0.01), globe(n, 1.43), Arithmetic::filtered);
}
BENCHMARK(triangles)->RangeMultiplier(10)->Range(1000, 1'000'000)->Unit(benchmark::kMillisecond);

/// Points at random, so many that their boxes meet about as often as those of a close packing: what a
/// periodic packing costs that comes in no order. One dimension after the other.
void periodic(benchmark::State& state) {
  const auto dimension = static_cast<int>(state.range(0));
  const auto n = static_cast<double>(state.range(1));
  const double r = std::pow(random_close_packing[dimension - 1] / n / ball_volume(dimension, 1), 1.0 / dimension);
  Random random(1, stream(Stream::test));
  Spheres<dynamic> s(dimension);
  Vector<dynamic> c(dimension);
  while (static_cast<double>(s.size()) < n) {
    for (double& x : c) x = random.uniform();
    s.push_back(c, r);
  }
  certificate_of(state, s, periodic_box(Vector<dynamic>::Ones(dimension)), Arithmetic::filtered);
}
BENCHMARK(periodic)
    ->Args({2, 10'000})
    ->Args({3, 10'000})
    ->Args({3, 1'000'000})
    ->Args({4, 10'000})
    ->Args({8, 2'000})
    ->Unit(benchmark::kMillisecond);

void cases(benchmark::internal::Benchmark* b) { b->Arg(34000)->Unit(benchmark::kMillisecond); }

BENCHMARK_CAPTURE(certificate, cylinder_loose_filtered, cylinder, 0.01, Arithmetic::filtered)->Apply(cases);
BENCHMARK_CAPTURE(certificate, cylinder_loose_exact, cylinder, 0.01, Arithmetic::exact)->Apply(cases);
BENCHMARK_CAPTURE(certificate, cylinder_touching_filtered, cylinder, 0, Arithmetic::filtered)->Apply(cases);
BENCHMARK_CAPTURE(certificate, cylinder_touching_exact, cylinder, 0, Arithmetic::exact)->Apply(cases);
BENCHMARK_CAPTURE(certificate, prism_loose_filtered, prism, 0.01, Arithmetic::filtered)->Apply(cases);
BENCHMARK_CAPTURE(certificate, prism_loose_exact, prism, 0.01, Arithmetic::exact)->Apply(cases);
BENCHMARK_CAPTURE(certificate, growth, cylinder, 0.01, Arithmetic::filtered)
    ->RangeMultiplier(10)
    ->Range(1000, 10'000'000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
