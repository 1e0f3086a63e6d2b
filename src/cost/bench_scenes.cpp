#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/fly/fly.hpp"
#include "bernal/hard/grow.hpp"
#include "bernal/predict/mixtures.hpp"
#include "bernal/predict/predict.hpp"
#include "bernal/run/run.hpp"
#include "bernal/settle/insert.hpp"
#include "bernal/settle/refill.hpp"
#include "bernal/soft/relax.hpp"
#include "bernal/verify/certificate.hpp"
#include "cost/bench_tables.hpp"
#include "cost/trial.hpp"
#include "soft/soft_packing.hpp"

namespace bernal::cost {
namespace {

/// One run of a bench: what it took and how much work that was.
struct BenchRun {
  double seconds = 0;
  double units = 0;
  std::string result = {};  ///< a phrase: "0.6429 of the box"
};

struct BenchScene {
  Bench bench;
  std::string_view unit;   ///< of work
  std::int64_t count = 0;  ///< spheres, or rods
  /// Makes what is to be measured; the run of it is called again and again.
  std::function<BenchRun()> (*prepare)(std::int64_t count, const BenchOptions&);
};

/// Quick benches are repeated as often as they fit in, and the median taken.
constexpr double seconds_to_repeat = 0.3;
constexpr std::size_t most_repeats = 21;

std::function<BenchRun()> packed(const Scene& scene, std::string_view effect, const BenchOptions& options) {
  return [plan = std::make_shared<Plan>(build(scene)), effect, monitor = options.monitor] {
    const double before = processor_seconds();
    const Packing packing = run(*plan, {{}, 1, monitor});
    const double seconds = processor_seconds() - before;
    if (packing.outcome == Outcome::cancelled) throw Cancelled();
    if (!certify(packing.spheres, packing.domain, {.threads = 1}).certified)
      throw Error(ErrorCode::bad_argument, "a packing of the benchmark is not certified");
    const auto n = static_cast<double>(packing.spheres.size());
    double units = n;
    for (const Effect& e : packing.effects)
      if (e.name == effect) units = static_cast<double>(e.calls);
    return BenchRun{seconds, units,
                    fmt::format("{} spheres, packing fraction {:.4f}", grouped(packing.spheres.size()),
                                packing.packing_fraction())};
  };
}

Scene scene_in(SceneContainer container, std::int64_t count, std::uint64_t seed) {
  Scene scene;
  scene.container = std::move(container);
  scene.sizes = Constant{1};
  scene.target.count = count;
  scene.seed = seed;
  return scene;
}

std::function<BenchRun()> relax_in_box(std::int64_t count, const BenchOptions& options) {
  Scene scene = scene_in(PeriodicBox{}, count, options.seed);
  scene.stages = {Relax{.alpha = 2}};
  return packed(scene, "", options);
}

constexpr float usual_omega = 5;  // of the fast relaxation

/// A sweep of the fast relaxation alone, over spheres that overlap by some per cent.
std::function<BenchRun()> sweep_in_box(std::int64_t count, const BenchOptions& options) {
  static constexpr int sweeps = 200;
  Scene scene = scene_in(PeriodicBox{}, count, options.seed);
  scene.stages = {Relax{.alpha = 0.2, .stop = 0.02}};
  const Packing packing = run(build(scene), {{}, 1, options.monitor});
  if (packing.outcome == Outcome::cancelled) throw Cancelled();
  const Vector<3> edges = 0.99 * std::get<Box>(packing.domain).size;
  return [count, edges, spheres = packing.spheres.in<3>()] {
    SoftPacking soft(spheres, edges, soft_kernels()[0]);
    soft.sweep(usual_omega);  // makes the lists
    const double before = processor_seconds();
    for (int k = 0; k < sweeps; ++k) soft.sweep(usual_omega);
    return BenchRun{processor_seconds() - before, static_cast<double>(sweeps * count),
                    fmt::format("{} spheres, {} sweeps", grouped(static_cast<std::uint64_t>(count)), sweeps)};
  };
}

/// That of Han, Feng & Owen: radius 1, height 2, filled to 0.60 by so many spheres.
Scene in_han_cylinder(std::int64_t count, std::uint64_t seed) {
  constexpr double volume = 2 * std::numbers::pi, phi = 0.6;
  Scene scene = scene_in(Cylinder{.radius = 1, .height = 2}, count, seed);
  scene.sizes = Constant{std::cbrt(phi * volume / (static_cast<double>(count) * 4 / 3 * std::numbers::pi))};
  return scene;
}

std::function<BenchRun()> relax_in_cylinder(std::int64_t count, const BenchOptions& options) {
  Scene scene = in_han_cylinder(count, options.seed);
  scene.stages = {Relax{}};
  return packed(scene, "", options);
}

std::function<BenchRun()> compress_in_cylinder(std::int64_t count, const BenchOptions& options) {
  Scene scene = in_han_cylinder(count, options.seed);
  scene.target = {.fill = true};
  scene.stages = {Insert{}, Compress{}, Shake{}, Refill{}};
  return packed(scene, "", options);
}

std::function<BenchRun()> grow_in_box(std::int64_t count, const BenchOptions& options) {
  Scene scene = scene_in(PeriodicBox{}, count, options.seed);
  scene.target.packing_fraction = 0.64;
  scene.stages = {Grow{}};
  return packed(scene, "collisions", options);
}

std::function<BenchRun()> fly_in_box(std::int64_t count, const BenchOptions& options) {
  Scene scene = scene_in(PeriodicBox{}, count, options.seed);
  scene.target.packing_fraction = 0.60;
  scene.stages = {Fly{}};
  return packed(scene, "", options);
}

std::function<BenchRun()> predict_lognormal(std::int64_t count, const BenchOptions&) {
  return [rods = static_cast<int>(count)] {
    const auto sizes = make_two_populations({.sigma_a = 0.5, .share = 0});
    const double before = processor_seconds();
    const Prediction prediction = predict_packing_fraction(*sizes, rods);
    return BenchRun{processor_seconds() - before, static_cast<double>(rods),
                    fmt::format("packing fraction {:.5f}", prediction.phi)};
  };
}

std::function<BenchRun()> certify_in_cylinder(std::int64_t count, const BenchOptions& options) {
  Scene scene = in_han_cylinder(count, options.seed);
  scene.stages = {Relax{}};
  auto packing = std::make_shared<Packing>(run(build(scene), {{}, 1, options.monitor}));
  if (packing->outcome == Outcome::cancelled) throw Cancelled();
  return [packing] {
    const double before = processor_seconds();
    const Certificate certificate = certify(packing->spheres, packing->domain, {.threads = 1});
    return BenchRun{processor_seconds() - before, static_cast<double>(certificate.pairs_tested),
                    fmt::format("{} spheres, {}", grouped(certificate.spheres),
                                certificate.certified ? "certified" : "not certified")};
  };
}

constexpr BenchScene bench_list[] = {
    {{"relax", "equal spheres in a periodic box by relaxation, alpha = 2"}, "spheres", 10'000, relax_in_box},
    {{"sweep", "sweeps of that relaxation alone"}, "spheres swept", 10'000, sweep_in_box},
    {{"relax_cylinder", "a cylinder filled to 0.60 by relaxation"}, "spheres", 30'000, relax_in_cylinder},
    {{"compress_cylinder", "the same cylinder by compression, shaking and refilling"},
     "spheres",
     30'000,
     compress_in_cylinder},
    {{"grow", "equal spheres in a periodic box grown to 0.64"}, "collisions", 10'000, grow_in_box},
    {{"fly", "a periodic box of given size filled to 0.60"}, "spheres", 2'000, fly_in_box},
    {{"predict", "the rod model of lognormal sizes, sigma 0.5"}, "rods", 16'000, predict_lognormal},
    {{"certify", "the cylinder at 0.60 certified"}, "near pairs", 30'000, certify_in_cylinder}};

/// The run of median time.
BenchRun measured(const BenchScene& scene, const BenchOptions& options) {
  const bool of_spheres = scene.unit != "rods";
  const auto once = scene.prepare(of_spheres && options.spheres > 0 ? options.spheres : scene.count, options);
  std::vector<BenchRun> runs;
  double total = 0;
  do {
    oneapi::tbb::task_arena(1).execute([&] { runs.push_back(once()); });
    total += runs.back().seconds;
    if (options.monitor.stop()) throw Cancelled();
  } while (total < seconds_to_repeat && runs.size() < most_repeats);
  std::ranges::nth_element(runs, runs.begin() + static_cast<std::ptrdiff_t>(runs.size() / 2), {},
                           &BenchRun::seconds);
  return runs[runs.size() / 2];
}

}  // namespace

std::span<const Bench> scenes_to_bench() {
  static const auto all = [] {
    std::vector<Bench> list;
    for (const BenchScene& scene : bench_list) list.push_back(scene.bench);
    return list;
  }();
  return all;
}

BenchFiles bench_scenes(std::span<const std::string_view> names, const BenchOptions& options) {
  std::string csv = "bench,seconds,work,unit_of_work,ns_each,result\n";
  std::string table =
      "| bench | what | result | seconds | work | ns each | a second |\n|---|---|---|--:|--:|--:|--:|\n";
  double done = 0;
  for (const BenchScene& scene : bench_list) {
    const Bench& bench = scene.bench;
    if (std::ranges::find(names, bench.name) == names.end()) continue;
    options.monitor.report({bench.name, done / static_cast<double>(names.size()), ""});
    BenchOptions quiet = options;
    quiet.monitor.on_progress = nullptr;
    const BenchRun run = measured(scene, quiet);
    const double ns = 1e9 * run.seconds / run.units;
    csv += fmt::format("{},{:.6f},{:.0f},{},{:.1f},\"{}\"\n", bench.name, run.seconds, run.units, scene.unit,
                       ns, run.result);
    table += fmt::format("| {} | {} | {} | {:.3g} | {} {} | {} | {} |\n", bench.name, bench.what, run.result,
                         run.seconds, grouped(static_cast<std::uint64_t>(run.units)), scene.unit,
                         grouped(static_cast<std::uint64_t>(std::llround(ns))),
                         grouped(static_cast<std::uint64_t>(std::llround(1e9 / ns))));
    ++done;
  }
  return {{"bench.md", table}, {"bench.csv", csv}};
}

}  // namespace bernal::cost
