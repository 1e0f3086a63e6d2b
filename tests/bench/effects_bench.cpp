#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <vector>

#include "bernal/core/random.hpp"
#include "core/event_clock.hpp"
#include "soft/soft_packing.hpp"
#include "support/flights.hpp"
#include "support/packings.hpp"
#include "work/bed.hpp"
#include "work/counted_container.hpp"

// What it costs that an effect can be there: the same spheres do the same with an effect that is not made,
// and with one that is made and finds nothing to do. What runs without an effect executes no more than that,
// so the ratio, of one run, bounds from above what the effect costs a scene that does not name it.
namespace bernal {
namespace {

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Runs both in turn, each first every second time: the time with the effect over that without, and its
/// standard error.
template <class Off, class On>
void compare(benchmark::State& state, Off off, On on) {
  const auto time = [](auto& act) {
    const double start = processor_seconds();
    act();
    return processor_seconds() - start;
  };
  off(), on();  // memory and caches
  double sum = 0, squares = 0, count = 0;
  for (auto _ : state) {
    const bool first = static_cast<int>(count) % 2 == 0;
    double without = first ? time(off) : 0;
    const double with = time(on);
    if (!first) without = time(off);
    const double ratio = std::log(with / without);
    sum += ratio, squares += ratio * ratio, ++count;
  }
  const double mean = sum / count, variance = squares / count - mean * mean;
  state.counters["on_over_off"] = std::exp(mean);
  state.counters["error"] = std::sqrt(std::max(0.0, variance) / std::max(1.0, count - 1));
}

HardSpheres<3> fluid(HardSphereOptions<3> options) {
  const testing::Gas<3> gas(testing::equal_radii(4000), 0.2);
  HardSpheres<3> flight(gas.spheres, gas.edges, Random(1, stream(Stream::test, 2)), std::move(options));
  const double size = std::cbrt(0.49 / 0.2);
  while (flight.size() < size) flight.fly(0.1, size);
  for (int k = 0; k < 12; ++k) flight.fly(0);
  return flight;
}

/// Equal spheres weigh the same by volume: the same collisions.
void unequal_masses_in_growth(benchmark::State& state) {
  HardSpheres<3> off = fluid({}), on = fluid({.masses = Masses::by_volume});
  compare(
      state, [&] { off.fly(0); }, [&] { on.fly(0); });
}
BENCHMARK(unequal_masses_in_growth)->Iterations(60)->Unit(benchmark::kMillisecond);

/// Walls so far off that no sphere ever meets them.
void walls_in_growth(benchmark::State& state) {
  std::vector<Wall<3>> far;
  for (int k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0}) far.push_back({.along = side * Vector<3>::Unit(k), .extent = 1e6});
  HardSpheres<3> off = fluid({}), on = fluid({.walls = far});
  compare(
      state, [&] { off.fly(0); }, [&] { on.fly(0); });
}
BENCHMARK(walls_in_growth)->Iterations(60)->Unit(benchmark::kMillisecond);

Spheres<3> crowd(double edge) {
  Spheres<3> spheres;
  Random random(1, stream(Stream::test));
  for (int i = 0; i < 4000; ++i)
    spheres.push_back(uniform_point(random, Bounds<3>{Vector<3>::Zero(), Vector<3>::Constant(edge)}), 1);
  return spheres;
}

/// A container that repeats itself along all axes has walls nowhere.
void walls_in_relaxation(benchmark::State& state) {
  const double edge = std::cbrt(4000 * ball_volume(3, 1) / 0.64);
  const Vector<3> edges = Vector<3>::Constant(edge);
  const auto container = make_analytic_container(Box{Vector<3>::Zero(), edges, {true, true, true}},
                                                 WallArithmetic::filtered, 1e-15 * edge);
  SoftPacking off(crowd(edge), edges, soft_kernels().front()),
      on(crowd(edge), *container, soft_kernels().front());
  const auto sweep = [](SoftPacking& packing) {
    for (int k = 0; k < 20; ++k) packing.sweep(5);
  };
  compare(
      state, [&] { sweep(off); }, [&] { sweep(on); });
}
BENCHMARK(walls_in_relaxation)->Iterations(60)->Unit(benchmark::kMillisecond);

/// Spheres in the middle of a box meet neither its walls nor images across them: lists of all neighbours.
void periodic_images_in_lists(benchmark::State& state) {
  const Bounds<3> middle{Vector<3>::Constant(20), Vector<3>::Constant(40)};
  const Spheres<3> spheres = testing::scattered(3000, 0.5, 0.6, middle, 1);
  EffectLog log;
  const auto bed_in = [&](const Container& container) {
    Bed bed(container, 0.5, 0.6, spheres.size(), log);
    for (std::uint32_t i = 0; i < spheres.size(); ++i) bed.insert(spheres.center(i), spheres.r[i], i);
    return bed;
  };
  const Vector<3> edges = Vector<3>::Constant(60);
  const auto closed = make_analytic_container(Box{Vector<3>::Zero(), edges}, WallArithmetic::filtered, 1e-14);
  const auto repeating = make_analytic_container(Box{Vector<3>::Zero(), edges, {true, true, true}},
                                                 WallArithmetic::filtered, 1e-14);
  Bed off = bed_in(*closed), on = bed_in(*repeating);
  compare(
      state, [&] { off.enclose(0.3); }, [&] { on.enclose(0.3); });
}
BENCHMARK(periodic_images_in_lists)->Iterations(60)->Unit(benchmark::kMillisecond);

/// Counting the questions to walls, against a container that nobody counts at: the dearest share it can have.
void counting_questions_to_a_box(benchmark::State& state) {
  const std::shared_ptr<const Container> box =
      make_analytic_container(Box{Vector<3>::Zero(), Vector<3>::Ones()}, WallArithmetic::filtered, 1e-16);
  const CountedContainer counted(box);
  Random random(1, stream(Stream::test));
  std::vector<Vector<3>> places;
  for (int k = 0; k < 20000; ++k)
    places.push_back(uniform_point(random, Bounds<3>{Vector<3>::Zero(), Vector<3>::Ones()}));
  const auto ask = [&](const Container& container) {
    std::size_t inside = 0;
    for (const Vector<3>& p : places) inside += container.contains(p, 0.01);
    benchmark::DoNotOptimize(inside);
  };
  compare(
      state, [&] { ask(*box); }, [&] { ask(counted); });
}
BENCHMARK(counting_questions_to_a_box)->Iterations(60)->Unit(benchmark::kMillisecond);

/// What it costs to time one event in 64, for each event.
void event_clock(benchmark::State& state) {
  EventClock clock;
  for (auto _ : state) {
    const EventClock::Event event(clock);
    benchmark::ClobberMemory();
  }
  benchmark::DoNotOptimize(clock.seconds());
}
BENCHMARK(event_clock);

}  // namespace
}  // namespace bernal
