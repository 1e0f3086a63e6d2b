#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/random.hpp"
#include "bernal/measure/local_packing.hpp"
#include "bernal/measure/pore_sizes.hpp"
#include "bernal/measure/structure_factor.hpp"
#include "support/meshes.hpp"

// What the measurements of structure cost a sphere, in one thread: cells of the power diagram, the structure
// factor, the distances in the pores.
namespace bernal {
namespace {

using OneThread = oneapi::tbb::global_control;

/// Spheres of many sizes that do not overlap, about so many in the unit of volume, off the sites of a
/// lattice.
Spheres<dynamic> about_a_lattice(const Container* container, const Bounds<3>& bounds, double spheres) {
  const double edge = std::cbrt(4 * bounds.volume() / spheres);
  Random random(1, stream(Stream::test));
  Spheres<dynamic> found(3);
  const Vector<3> cells = (bounds.size() / edge).array().floor();
  const Vector<3> size = bounds.size().cwiseQuotient(cells);
  Vector<3> cell;
  for (cell[0] = 0; cell[0] < cells[0]; ++cell[0])
    for (cell[1] = 0; cell[1] < cells[1]; ++cell[1])
      for (cell[2] = 0; cell[2] < cells[2]; ++cell[2])
        for (const Vector<3>& site :
             {Vector<3>(0, 0, 0), Vector<3>(0, .5, .5), Vector<3>(.5, 0, .5), Vector<3>(.5, .5, 0)}) {
          const Vector<3> off = 0.1 * uniform_direction<3>(random);
          const Vector<3> p =
              bounds.lower + (cell + site + Vector<3>::Constant(0.2) + off).cwiseProduct(size);
          const double r = random.uniform(0.15, 0.25) * edge;
          if (!container || container->clearance(p) > r) found.push_back(p, r);
        }
  return found;
}

void measure_cells(benchmark::State& state, const Domain& domain, double bounds_a_volume) {
  const OneThread one(OneThread::max_allowed_parallelism, 1);
  const std::shared_ptr<const Container> container =
      has_walls(domain) ? local_container(domain, nullptr) : nullptr;
  const auto made = has_walls(domain) ? make_container(domain, WallArithmetic::plain, 1e-16) : nullptr;
  const Spheres<dynamic> spheres =
      about_a_lattice(made.get(), bounds_of(domain), bounds_a_volume * static_cast<double>(state.range(0)));
  double error = 0;
  for (auto _ : state) error = local_packing(spheres, domain, {}, container)->volume_error;
  const auto n = static_cast<double>(spheres.size());
  state.counters["spheres"] = n;
  state.counters["volume_error"] = error;
  state.counters["s/sphere"] =
      benchmark::Counter(n, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void cells_periodic(benchmark::State& state) { measure_cells(state, periodic_box(Vector<3>(1, 1, 1)), 1); }
void cells_cylinder(benchmark::State& state) {
  measure_cells(state, Cylinder{.radius = 0.5, .height = 1}, 4 / std::numbers::pi);
}
void cells_mesh(benchmark::State& state) { measure_cells(state, test::torus_mesh(1, 0.4, 128, 64, 0), 2); }

void structure(benchmark::State& state) {
  const OneThread one(OneThread::max_allowed_parallelism, 1);
  const Domain box = periodic_box(Vector<3>(1, 1, 1));
  const auto spheres = about_a_lattice(nullptr, bounds_of(box), static_cast<double>(state.range(0)));
  std::uint64_t vectors = 0;
  for (auto _ : state) vectors = structure_factor(spheres, box)->references;
  state.counters["spheres"] = static_cast<double>(spheres.size());
  state.counters["s/wave"] =
      benchmark::Counter(static_cast<double>(spheres.size() * vectors),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void pores(benchmark::State& state) {
  const OneThread one(OneThread::max_allowed_parallelism, 1);
  const Domain box = periodic_box(Vector<3>(1, 1, 1));
  const auto spheres = about_a_lattice(nullptr, bounds_of(box), static_cast<double>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(pore_sizes(spheres, box));
  state.counters["spheres"] = static_cast<double>(spheres.size());
}

BENCHMARK(cells_periodic)->RangeMultiplier(10)->Range(10'000, 1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(cells_cylinder)->RangeMultiplier(10)->Range(10'000, 100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(cells_mesh)->RangeMultiplier(10)->Range(10'000, 100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(structure)->RangeMultiplier(10)->Range(10'000, 1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(pores)->RangeMultiplier(10)->Range(10'000, 1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace bernal
