#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <map>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/random.hpp"
#include "bernal/run/run.hpp"
#include "settle/mover.hpp"
#include "support/meshes.hpp"
#include "support/plans.hpp"
#include "support/scenes.hpp"

// What packing costs: whole runs, and the two inner loops over a settled bed of about 28,000 spheres. The
// time of a run is that of the processor, summed over its threads.
namespace bernal {
namespace {

Plan han() { return build(read_scene(BERNAL_DATA "/scenes/cylinder_han.toml")); }

/// The cylinder as a prism of 64 sides.
Plan han_as_mesh() {
  Plan plan = han();
  plan.domain = test::prism_mesh(64, 1, 2);
  plan.container = nullptr;
  return plan;
}

void report(benchmark::State& state, const Packing& packing) {
  const auto spheres = static_cast<double>(packing.spheres.size());
  state.counters["spheres"] = spheres;
  state.counters["packing_fraction"] = packing.packing_fraction();
  state.counters["spheres_per_s"] = benchmark::Counter(spheres, benchmark::Counter::kIsRate);
}

void run_whole(benchmark::State& state, const Plan& plan, int threads) {
  RunOptions options;
  options.threads = threads;
  Packing packing;
  for (auto _ : state) packing = run(plan, options);
  report(state, packing);
}

void once(benchmark::internal::Benchmark* b) {
  b->Iterations(1)->MeasureProcessCPUTime()->Unit(benchmark::kSecond);
}

void pack_han(benchmark::State& state, Plan (*plan)()) {
  run_whole(state, plan(), static_cast<int>(state.range(0)));
}
void for_threads(benchmark::internal::Benchmark* b) { b->ArgName("threads")->Arg(1)->Arg(2)->Apply(once); }
BENCHMARK_CAPTURE(pack_han, cylinder, han)->Apply(for_threads);
BENCHMARK_CAPTURE(pack_han, prism_mesh, han_as_mesh)->Apply(for_threads);

/// What accuracy of the walls costs: 8,000 spheres in a hopper.
void pack_hopper(benchmark::State& state, WallArithmetic walls) {
  Scene scene = testing::small(read_scene(BERNAL_DATA "/scenes/hopper.toml"), 8000);
  scene.walls = walls;
  run_whole(state, build(scene), 1);
}
BENCHMARK_CAPTURE(pack_hopper, double, WallArithmetic::plain)->Apply(once);
BENCHMARK_CAPTURE(pack_hopper, filtered, WallArithmetic::filtered)->Apply(once);
BENCHMARK_CAPTURE(pack_hopper, exact, WallArithmetic::exact)->Apply(once);

/// A settled packing in the packer's frame, made once for each container.
class SettledBed {
 public:
  explicit SettledBed(const Plan& plan) {
    const Packing packing = run(plan);
    const Domain& shape = plan.domain;
    const Frame frame = frame_of(shape);
    container_ = make_local_container(shape, frame, WallArithmetic::filtered);
    const auto [smallest, largest] = std::ranges::minmax(packing.spheres.r);
    bed_ = std::make_unique<Bed>(*container_, smallest / frame.scale, largest / frame.scale,
                                 packing.spheres.size(), effects_);
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      bed_->insert(frame.to_local(packing.spheres.center(i)), packing.spheres.r[i] / frame.scale,
                   static_cast<std::uint32_t>(i));
    }
    bed_->sort_by_height(-Vector<3>::UnitZ());
  }
  Bed& operator*() { return *bed_; }

  static Bed& of(Plan (*plan)()) {
    static std::map<Plan (*)(), SettledBed> beds;
    return *beds.try_emplace(plan, plan()).first->second;
  }

 private:
  EffectLog effects_;
  std::unique_ptr<Container> container_;
  std::unique_ptr<Bed> bed_;
};

void per_sphere(benchmark::State& state, const Bed& bed) {
  state.counters["spheres"] = static_cast<double>(bed.size());
  state.counters["s_per_sphere"] =
      benchmark::Counter(static_cast<double>(bed.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

constexpr double buffer = 0.5;  // in radii, as compression has it

/// One sweep of local directions over all spheres, as compression makes it.
void slide_sweep(benchmark::State& state, Plan (*plan)()) {
  Bed& bed = SettledBed::of(plan);
  bed.enclose(buffer * bed.mean_radius());
  Mover mover(bed);
  Random random(1, stream(Stream::test));
  for (auto _ : state) {
    for (Bed::Id i = 0; i < bed.size(); ++i) {
      const Vector<3> u = (2 * uniform_direction<3>(random) - Vector<3>::UnitZ()).normalized();
      benchmark::DoNotOptimize(mover.slide(i, u, 2 * bed.mean_radius()));
    }
  }
  per_sphere(state, bed);
}
BENCHMARK_CAPTURE(slide_sweep, cylinder, han)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(slide_sweep, prism_mesh, han_as_mesh)->Unit(benchmark::kMillisecond);

/// Bounding boxes, neighbour lists and near walls of all spheres.
void enclose(benchmark::State& state, Plan (*plan)()) {
  Bed& bed = SettledBed::of(plan);
  const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) bed.enclose(buffer * bed.mean_radius());
  per_sphere(state, bed);
}
void lists(benchmark::internal::Benchmark* b) {
  b->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(enclose, cylinder, han)->Apply(lists);
BENCHMARK_CAPTURE(enclose, prism_mesh, han_as_mesh)->Apply(lists);

}  // namespace
}  // namespace bernal
