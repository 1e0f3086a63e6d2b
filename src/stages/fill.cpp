#include "stages/fill.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "soft/neighbor_relaxation.hpp"
#include "soft/soft_packing.hpp"
#include "stages/overlapping.hpp"
#include "stages/periodic_holes.hpp"
#include "stages/resize_box.hpp"

namespace bernal {
namespace {

/// Spheres are relaxed with radii that are larger by this share, so that those that were asked for touch
/// nothing; by so many resolutions of the coordinates at least, and never more than the last.
constexpr double least_margin = 1e-4, resolutions_a_margin = 100, largest_margin = 0.01;
/// Of the margin, what single precision leaves to rely on.
constexpr double share_of_margin = 0.97;
constexpr int sweeps_a_look = 25;
/// Stuck: at so many looks in a row the strain is more than this share of the least so far.
constexpr double hardly_freer = 0.85;
constexpr int looks_when_stuck = 2;
constexpr double burst_swelling = 1.02;
constexpr int burst_sweeps = 50;
/// Stirring helps as long as the strain falls below this share of the least so far.
constexpr double progress = 0.9;
/// The share of the spheres that is put elsewhere at a time.
constexpr double relocated = 0.002;
/// Sum of squared overlap ratios of a sphere that will not find its way by itself; and the largest overlap
/// ratio, in strains, above which it is only a few spheres that are stuck.
constexpr float severe_squeeze = 0.05f;
constexpr double local_jam = 40;
/// Moves, in mean radii, that break the symmetry of spheres which come in a lattice or in line.
constexpr double jitter = 1e-6;

/// What pushes spheres apart: the sorted arrays of up to three dimensions where the box is wide enough for
/// them.
template <int D>
class Engine {
 public:
  Engine(const Spheres<D>& spheres, const Vector<D>& edges) {
    if constexpr (D <= 3) {
      if (edges.minCoeff() > 1.1 * burst_swelling * SoftPacking::smallest_edge(spheres.r)) {
        wide_ = std::make_unique<SoftPacking>(spheres, edges, soft_kernels().front());
        return;
      }
    }
    any_ = std::make_unique<NeighborRelaxation<D>>(spheres, edges);
  }
  template <class Act>
  auto with(Act&& act) {
    if constexpr (D <= 3) {
      if (wide_) return act(*wide_);
    }
    return act(*any_);
  }

 private:
  std::unique_ptr<SoftPacking> wide_;
  std::unique_ptr<NeighborRelaxation<D>> any_;
};

template <int D>
class Filling {
 public:
  Filling(PeriodicWork& work, const FillOptions& options)
      : work_(work),
        options_(options),
        random_(work.random(Stream::relax)),
        edges_(*work.target_edges),
        radii_(work.spheres.r),
        spheres_(work.spheres.in<D>()) {
    start();
    for (double& r : spheres_.r) r *= 1 - work.allowed_overlap;
    const double resolution = 0x1p-32 * edges_.maxCoeff() / std::ranges::min(spheres_.r);
    margin_ = std::clamp(resolutions_a_margin * resolution, least_margin, largest_margin);
    prepare();
  }

  StageEnd run() {
    const StageEnd end = relax();
    log_effects();
    if (end != StageEnd::converged) keep_what_is_free();
    work_.spheres = std::move(spheres_);
    work_.edges = edges_;
    work_.needed_volume = edges_.prod();
    work_.placed = true;
    return end;
  }

 private:
  enum class Rest { free, stuck, over, cancelled };

  void start() {
    const Boundary<D> boundary{edges_};
    if (work_.placed) {
      Vector<D> edges = work_.edges;
      resize_box<D>(spheres_, edges, edges_);
    }
    const double step = jitter * std::ranges::min(spheres_.r);
    for (std::size_t i = 0; i < spheres_.size(); ++i)
      spheres_.set_center(
          i, work_.placed ? boundary.wrap(spheres_.center(i) + step * uniform_direction<D>(random_))
                          : uniform_point(random_, Bounds<D>{Vector<D>::Zero(), edges_}));
  }

  /// The spheres in a box that is smaller by the margin: distances to radii are all that matters.
  void prepare() {
    Spheres<D> shrunk = spheres_;
    Vector<D> edges = edges_;
    resize_box<D>(shrunk, edges, edges_ / (1 + margin_));
    if (engine_) builds_ += builds();
    engine_ = std::make_unique<Engine<D>>(shrunk, edges);
  }

  void write() {
    Vector<D> edges;
    engine_->with([&](auto& engine) { engine.write_to(spheres_, edges); });
    // Cut off to the edge: what was shrunk and rounded returns to the very edges that were asked for.
    resize_box<D>(spheres_, edges, edges_);
  }

  std::uint64_t builds() {
    return engine_->with([](const auto& engine) { return engine.builds(); });
  }

  void sweep(int times, float omega) {
    engine_->with([&](auto& engine) {
      for (int k = 0; k < times; ++k) engine.sweep(omega);
    });
    sweeps_ += times;
  }

  void measure() {
    std::vector<float> stress;
    engine_->with([&](auto& engine) {
      const Pace pace = pace_for(0);
      engine.wear_lists(pace.wear);
      largest_overlap_ = engine.sweep_and_measure(pace.omega * D / 3);
      stress = engine.stress();
    });
    ++sweeps_;
    double sum = 0;
    severe_ = 0;
    for (const float s : stress) {
      sum += std::sqrt(s);
      if (s > severe_squeeze) ++severe_;
    }
    strain_ = sum / static_cast<double>(spheres_.size());
  }

  Rest settle() {
    int slow = 0;
    double least_strain = 1e300;
    for (;;) {
      const Pace pace = pace_for(largest_overlap_);
      engine_->with([&](auto& engine) { engine.wear_lists(pace.wear); });
      for (int k = 1; k < sweeps_a_look; ++k) {
        sweep(1, pace.omega * D / 3);
        if (work_.monitor.stop()) return Rest::cancelled;
      }
      measure();
      if (getenv("FILL_TRACE")) fprintf(stderr, "%6.0f %.2e %.2e\n", sweeps_, largest_overlap_, strain_);
      if (largest_overlap_ < share_of_margin * margin_) return Rest::free;
      if (sweeps_ > options_.sweeps) return Rest::over;
      slow = strain_ > hardly_freer * least_strain ? slow + 1 : 0;
      if (slow == looks_when_stuck) return Rest::stuck;
      least_strain = std::min(least_strain, strain_);
    }
  }

  void burst() {
    engine_->with([&](auto& engine) { engine.grow(1 / burst_swelling); });
    sweep(burst_sweeps, pace_for(0).omega * D / 3);
    engine_->with([&](auto& engine) { engine.grow(burst_swelling); });
  }

  void relocate() {
    const std::vector<float> stress = engine_->with([](const auto& engine) { return engine.stress(); });
    write();
    std::vector<std::uint32_t> ids(spheres_.size());
    std::iota(ids.begin(), ids.end(), 0u);
    const auto count = std::max<std::size_t>(
        severe_, static_cast<std::size_t>(std::ceil(relocated * static_cast<double>(spheres_.size()))));
    std::ranges::stable_sort(ids, std::greater<>(), [&](auto i) { return stress[i]; });
    ids.resize(std::min(count, ids.size()));
    move_to_holes<D>(spheres_, edges_, std::move(ids), random_);
    prepare();
  }

  StageEnd relax() {
    double least_strain = 1e300;
    for (int failures = 0;;) {
      const Rest rest = settle();
      report();
      if (rest == Rest::free) {
        write();
        if (overlapping<D>(spheres_, edges_, work_.allowed_overlap).empty()) return StageEnd::converged;
      }
      if (rest == Rest::cancelled || rest == Rest::over) {
        write();
        return rest == Rest::over ? StageEnd::hit_limit : StageEnd::cancelled;
      }
      if (strain_ < progress * least_strain) {
        least_strain = strain_;
        failures = 0;
      } else if (++failures > options_.patience) {
        write();
        return StageEnd::full;
      }
      const bool local = severe_ > 0 || largest_overlap_ > local_jam * strain_;
      if (failures % 2 == 0 && !local)
        burst();
      else
        relocate();
    }
  }

  void report() { }
  void log_effects() { work_.effects["neighbour lists"].calls += builds_ + builds(); }

  void keep_what_is_free() {}

  PeriodicWork& work_;
  const FillOptions options_;
  Random random_;
  const Vector<D> edges_;
  const std::vector<double> radii_;
  Spheres<D> spheres_;
  double margin_ = 0;
  std::unique_ptr<Engine<D>> engine_;
  double largest_overlap_ = 1, strain_ = 1;
  std::size_t severe_ = 0;
  double sweeps_ = 0;
  std::uint64_t builds_ = 0;
};

}  // namespace

bool fits_box(const PeriodicWork& work) {
  const double largest = std::ranges::max(work.spheres.r);
  return 2 * largest * (1 - work.allowed_overlap) <= work.target_edges->minCoeff();
}

StageEnd fill_by_relaxation(PeriodicWork& work, const FillOptions& options) {
  const EffectTimer timer(work.effects["relaxation"]);
  return with_dimension(work.dimension(), EveryDimension{}, [&](auto dimension) {
    return Filling<decltype(dimension)::value>(work, options).run();
  });
}

}  // namespace bernal
