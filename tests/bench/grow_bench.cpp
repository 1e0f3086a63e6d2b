#include <benchmark/benchmark.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <vector>

#include "bernal/core/random.hpp"
#include "core/large_pages.hpp"
#include "hard/calendar.hpp"
#include "support/flights.hpp"

// What growth costs: a collision in a fluid, by number and sizes of spheres; the queue of events, against a
// binary heap.
namespace bernal {
namespace {

using testing::equal_radii;
using testing::Gas;
using testing::lognormal_radii;

/// Bytes that the process holds in memory.
double resident() {
  std::ifstream pages("/proc/self/statm");
  double all = 0, in_memory = 0;
  pages >> all >> in_memory;
  return in_memory * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// A fluid at packing fraction 0.49, grown there from 0.2. Events: collisions, departures, and spheres that
/// look again.
void collide(benchmark::State& state, const std::vector<double>& radii) {
  const Gas<3> gas(radii, 0.2);
  malloc_trim(0);
  const double before = resident();
  HardSpheres<3> flight(gas.spheres, gas.edges, Random(1, stream(Stream::test, 2)));
  const double size = std::cbrt(0.49 / 0.2);
  while (flight.size() < size) flight.fly(0.1, size);
  for (int k = 0; k < 12; ++k) flight.fly(0);  // shells find their size
  std::uint64_t collisions = 0, departures = 0, predictions = 0, scanned = 0, periods = 0;
  for (auto _ : state) {
    const FlightPeriod period = flight.fly(0);
    collisions += period.collisions;
    departures += period.departures;
    predictions += period.predictions;
    scanned += period.scanned;
    ++periods;
  }
  const auto all = static_cast<double>(collisions);
  state.counters["collisions_per_second"] = benchmark::Counter(all, benchmark::Counter::kIsRate);
  state.counters["events_per_second"] = benchmark::Counter(
      static_cast<double>(predictions - periods * radii.size()) - all, benchmark::Counter::kIsRate);
  state.counters["bytes_a_sphere"] = (resident() - before) / static_cast<double>(radii.size());
  state.counters["scans_a_collision"] = static_cast<double>(predictions) / all;
  state.counters["departures_a_collision"] = static_cast<double>(departures) / all;
  // A scan reads one line of each neighbour, and of its own the sphere, its event, its shell and its list; a
  // departure some 27 cells of equal spheres.
  const auto lines = static_cast<double>(scanned + 4 * predictions + 27 * departures);
  state.counters["lines_a_collision"] = lines / all;
}

void collide_equal(benchmark::State& state) {
  collide(state, equal_radii(static_cast<std::size_t>(state.range(0))));
}
BENCHMARK(collide_equal)
    ->RangeMultiplier(10)
    ->Range(1000, 1000000)
    ->Unit(benchmark::kMillisecond)
    ->MinTime(1);

void collide_lognormal(benchmark::State& state) {
  collide(state, lognormal_radii(static_cast<std::size_t>(state.range(0)), 0.5));
}
BENCHMARK(collide_lognormal)->Arg(10000)->Unit(benchmark::kMillisecond)->MinTime(1);

void collide_one_to_five(benchmark::State& state) {
  std::vector<double> radii(static_cast<std::size_t>(state.range(0)), 0.5);
  std::fill_n(radii.begin(), radii.size() / 126, 2.5);  // half of the volume
  collide(state, radii);
}
BENCHMARK(collide_one_to_five)->Arg(10000)->Unit(benchmark::kMillisecond)->MinTime(1);

/// What memory gives at most of what growth asks for: lines of the cache at places in no order, asked for
/// well ahead, in pages of 2 MiB.
void random_lines(benchmark::State& state) {
  struct alignas(64) Line {
    std::uint32_t number[16];
  };
  constexpr std::uint32_t count = 1u << 23, ahead = 24, a_round = 1u << 20;
  LargePageVector<Line> lines(count);
  const auto next = [](std::uint32_t at) { return (at * 1664525u + 1013904223u) % count; };
  std::uint32_t at = 1, soon = 1, sum = 0;
  for (std::uint32_t k = 0; k < ahead; ++k) soon = next(soon);
  for (auto _ : state) {
    for (std::uint32_t k = 0; k < a_round; ++k) {
      prefetch(&lines[soon]);
      sum += lines[at].number[at % 16];
      soon = next(soon);
      at = next(at);
    }
    benchmark::DoNotOptimize(sum);
  }
  state.counters["s_a_line"] = benchmark::Counter(
      a_round, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(random_lines)->Unit(benchmark::kMillisecond);

/// The other queue that was tried: a binary heap that knows where each event stands.
class BinaryHeap {
 public:
  using Id = Calendar::Id;

  void start_period(std::size_t ids, double, std::size_t) {
    times_.assign(ids, Calendar::never);
    heap_.resize(ids);
    place_.resize(ids);
    for (Id id = 0; id < ids; ++id) heap_[id] = place_[id] = id;
  }
  double time(Id id) const { return times_[id]; }
  void schedule(Id id, double time, Id) {
    times_[id] = time;
    std::size_t at = place_[id];
    while (at > 0 && times_[heap_[(at - 1) / 2]] > time) at = put(at, heap_[(at - 1) / 2], (at - 1) / 2);
    for (std::size_t child; (child = 2 * at + 1) < heap_.size();) {
      if (child + 1 < heap_.size() && times_[heap_[child + 1]] < times_[heap_[child]]) ++child;
      if (times_[heap_[child]] >= time) break;
      at = put(at, heap_[child], child);
    }
    put(at, id, at);
  }
  Id next() const { return heap_[0]; }

 private:
  std::size_t put(std::size_t at, Id id, std::size_t next) {
    heap_[at] = id;
    place_[id] = static_cast<Id>(at);
    return next;
  }

  std::vector<double> times_;
  std::vector<Id> heap_, place_;
};

/// The queue alone, used as collisions use it: of the one that comes up and of one other, the event is
/// replaced by one to come.
template <class Queue>
void events(benchmark::State& state) {
  const auto n = static_cast<Calendar::Id>(state.range(0));
  Random random(1, stream(Stream::test));
  std::vector<double> waits(1 << 16);
  for (double& wait : waits) wait = -std::log(1 - random.uniform());
  std::vector<Calendar::Id> others(1 << 16);
  for (Calendar::Id& other : others) other = static_cast<Calendar::Id>(random.uniform() * n);
  std::size_t count = 0;
  Queue queue;
  for (auto _ : state) {
    queue.start_period(n, 8, 8 * n);
    for (Calendar::Id id = 0; id < n; ++id) queue.schedule(id, waits[(count + id) & 0xFFFF], 0);
    for (std::uint32_t k = 0; k < 6 * n; ++k) {
      const Calendar::Id id = queue.next();
      const double now = queue.time(id);
      queue.schedule(id, now + waits[count & 0xFFFF], 0);
      queue.schedule(others[count & 0xFFFF], now + waits[(count + 1) & 0xFFFF], 0);
      count += 2;
    }
  }
  state.counters["ns_per_event"] = benchmark::Counter(
      6e-9 * n, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(events<Calendar>)->Arg(10000)->Arg(1000000)->Unit(benchmark::kMillisecond)->MinTime(0.5);
BENCHMARK(events<BinaryHeap>)->Arg(10000)->Arg(1000000)->Unit(benchmark::kMillisecond)->MinTime(0.5);

}  // namespace
}  // namespace bernal
