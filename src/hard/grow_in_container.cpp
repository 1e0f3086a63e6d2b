#include "hard/grow_in_container.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "hard/convex_walls.hpp"
#include "hard/growth_schedule.hpp"
#include "hard/hard_spheres.hpp"
#include "hard/largest_sphere.hpp"
#include "work/random_insertion.hpp"

namespace bernal {
namespace {

/// Of the smallest radius: facets whose corners are that near to one plane count as one.
constexpr double flatness = 1e-4;
/// What the walls may be inside of the container, in flatness: see `convex_walls`.
constexpr double inset = 6;
/// Spheres start no larger than this share of their radii, clear of such walls wherever they come from.
constexpr double largest_start = 0.99;
/// Random places tried for a sphere before the insertion counts as stuck, and the thinnest insertion.
constexpr int most_trials_between_walls = 10000;
constexpr double least_phi_init = 1e-6;
/// More than what is likely to fit, in shares of it, is not tried at once.
constexpr double most_of_attainable = 1.1;
/// What is left free of the volume that jammed spheres take up when the tail is taken out, so that the rest
/// fits; every further time twice as much. And how much they shrink then, so that they are a fluid again:
/// with less they jam before they are as dense as the first time.
constexpr double caution = 5e-4;
constexpr int most_trims = 8;
constexpr double shrinkage = 0.07;
/// Of the skin: room for rounding beyond it.
constexpr double share_for_rounding = 0.01;
/// Room beside the container in the periodic box around it, in largest diameters, along axes that do not
/// repeat themselves: no sphere meets an image of another, and shells are as large as they like.
constexpr double margin = 3;
/// A milestone for each growth by this much of the volume, or of the logarithm of the compressibility.
constexpr double volume_a_milestone = 0.01, squeeze_a_milestone = 0.1;

double volume_of(const Spheres<3>& spheres) {
  double sum = 0;
  for (const double r : spheres.r) sum += ball_volume(3, r);
  return sum;
}

/// Spheres on their way to their radii.
struct Growing {
  Spheres<3> spheres;
  std::vector<bool> placed;  ///< whether each has a place
  double size = 1;           ///< the share of their radii that they have
  bool grown = false;        ///< they have reached them

  void add(double r) {
    spheres.push_back(Vector<3>::Zero(), r);
    placed.push_back(false);
  }
  double volume() const { return size * size * size * volume_of(spheres); }
};

class Growth {
 public:
  Growth(Work& work, const GrowOptions& options)
      : work_(work),
        options_(options),
        random_(work.random(Stream::grow)),
        full_size_(1 + (1 + share_for_rounding) * work.bed().skin() / work.supply->smallest()),
        walls_(walls_for_growth(work.domain, work.supply->smallest())) {
    const Bounds<3> bounds = work.bed().container().bounds();
    const Boundary<3>& boundary = work.bed().container().boundary();
    edges_ = bounds.size().array() + margin * 2 * work.supply->largest();
    to_box_ = 0.5 * edges_ - bounds.center();
    for (int k = 0; k < 3; ++k) {
      if (!boundary.repeats(k)) continue;
      edges_[k] = boundary.edges[k];
      to_box_[k] = -boundary.origin[k];
    }
    for (Wall<3>& wall : walls_) wall.shift(to_box_);
  }

  StageEnd run() {
    const std::size_t wanted = target_count();
    if (work_.bed().size() >= wanted) return StageEnd::converged;
    require_fitting();
    Growing growing = from_bed();
    std::size_t count = std::min(wanted, count_for(most_of_attainable * work_.attainable));
    for (bool first = true;;
         first = false, count = std::min(wanted, count + std::max<std::size_t>(1, count / 10))) {
      Growing more = growing;
      while (more.spheres.size() < count) more.add(radius_of(more.spheres.size()));
      insert(more);
      const bool jammed = !grow(more);
      if (jammed) trim_and_grow(more);
      if (first || (more.grown && more.spheres.size() > growing.spheres.size())) growing = std::move(more);
      if (jammed || growing.spheres.size() >= wanted) break;
    }
    const bool all_there = hand_over(growing.spheres);
    if (cancelled_) return StageEnd::cancelled;
    if (!all_there) return StageEnd::hit_limit;
    return growing.spheres.size() >= wanted ? StageEnd::converged : StageEnd::full;
  }

 private:
  double volume_of_container() const { return work_.bed().container().volume(); }
  std::size_t count_for(double packing_fraction) const {
    return work_.supply->count_filling(packing_fraction * volume_of_container());
  }

  std::size_t target_count() const {
    if (work_.target.is_open() && !work_.target.fill) return count_for(work_.attainable);
    return work_.supply->wanted();
  }

  double radius_of(std::size_t tag) const { return work_.supply->radius(static_cast<std::uint32_t>(tag)); }

  /// Of analytic containers that is known beforehand.
  void require_fitting() const {
    if (!std::holds_alternative<Mesh>(work_.domain)) return;
    const LargestSphere largest = largest_sphere_between(walls_, {Vector<3>::Zero(), edges_});
    if (work_.supply->largest() <= largest.radius) return;
    throw Error(
        ErrorCode::bad_scene,
        fmt::format(
            "the largest sphere does not fit into the container, which takes one only {:.6g} times as "
            "large: use smaller ones or check the units",
            largest.radius / work_.supply->largest()));
  }

  /// The first of the drawn sequence, up to the last one that is in the bed.
  Growing from_bed() const {
    const Bed& bed = work_.bed();
    Growing growing;
    for (Bed::Id i = 0; i < bed.size(); ++i) {
      while (growing.spheres.size() <= bed.tag(i)) growing.add(radius_of(growing.spheres.size()));
      growing.spheres.set_center(bed.tag(i), bed[i].center);
      growing.placed[bed.tag(i)] = true;
    }
    return growing;
  }

  /// Finds places for all spheres that have none, and the size at which they do.
  void insert(Growing& growing) {
    const EffectTimer timer(work_.effects["insertion"]);
    const double filled = volume_of(growing.spheres) / volume_of_container();
    double phi = options_.phi_init.value_or(0.2);
    do {
      growing.size = std::min(largest_start, std::cbrt(phi / filled));
      if (try_to_insert(growing)) return;
      phi /= 2;
    } while (phi > least_phi_init);
    throw Error(
        ErrorCode::bad_scene,
        "grow cannot start: random insertion found no place for one of the spheres even where they are "
        "small; use \"relax\"");
  }

  bool try_to_insert(Growing& growing) {
    const Container& container = work_.bed().container();
    const double clear_of_walls = inset * flatness * work_.supply->smallest();
    const bool all = insert_at_random<3>(
        growing.spheres, growing.placed, growing.size, container.bounds(), container.boundary(),
        most_trials_between_walls, [&](double) { return work_.bed().places().draw(random_); },
        [&](const Vector<3>& c, double r) {
          return container.clearance_within(c, r + clear_of_walls) >= r + clear_of_walls;
        });
    if (all) growing.placed.assign(growing.spheres.size(), true);
    return all;
  }

  /// Lets them fly and grow until they have their radii, or jam. Returns whether they have.
  bool grow(Growing& growing) {
    const EffectTimer timer(work_.effects["growth"]);
    Spheres<3> flying = growing.spheres;
    const Boundary<3> box{edges_};
    for (std::size_t i = 0; i < flying.size(); ++i) {
      flying.r[i] *= growing.size;
      flying.set_center(i, box.wrap(flying.center(i) + to_box_));
    }
    if (flying.empty()) return growing.grown = true;
    const GrowthSchedule<3> schedule(flying, volume_of_container(), options_);
    HardSpheres<3> flight(flying, edges_, work_.random(Stream::grow),
                          {.walls = walls_, .masses = options_.masses});
    const double largest = full_size_ / growing.size;
    next_volume_ = next_squeeze_ = 0;
    FlightPeriod period;
    while (flight.size() < largest && period.compressibility < options_.pressure) {
      period = flight.fly(schedule.at(period.compressibility), largest, work_.monitor);
      log(period);
      cancelled_ = period.stopped;
      if (cancelled_) break;
      report(growing, flight.size(), period);
    }
    flight.write_to(flying);
    for (std::size_t i = 0; i < flying.size(); ++i) growing.spheres.set_center(i, flying.center(i) - to_box_);
    growing.size *= flight.size();
    return growing.grown = flight.size() == largest;
  }

  /// As often as it takes, or a few times: takes out what the jammed spheres had no room for, and a little
  /// more, and lets the others grow.
  void trim_and_grow(Growing& growing) {
    double spare = caution;
    for (int k = 0; k < most_trims && !growing.grown && !cancelled_; ++k, spare *= 2) {
      const std::size_t fitting = work_.supply->count_filling((1 - spare) * growing.volume());
      growing.spheres.resize(std::min(fitting, growing.spheres.size()) - 1);
      growing.size *= 1 - shrinkage;
      grow(growing);
    }
  }

  void log(const FlightPeriod& period) {
    const auto count = [&](std::string_view effect, std::uint64_t calls) {
      if (calls > 0) work_.effects[effect].calls += calls;
    };
    count("collisions", period.collisions);
    count("reflections", period.reflections);
    count("neighbour shells", period.departures + period.builds);
  }

  /// Now and then.
  void report(const Growing& growing, double grown, const FlightPeriod& period) {
    const double size = growing.size * grown;
    const double squeezed = std::log(std::max(1.0, period.compressibility));
    if (size * size * size < next_volume_ && squeezed < next_squeeze_) return;
    next_volume_ = size * size * size + volume_a_milestone;
    next_squeeze_ = squeezed + squeeze_a_milestone;
    work_.crowd_milestone("grow", growing.spheres.size(), size * size * size * volume_of(growing.spheres), 0,
                          std::max(size * size * size, squeezed / std::log(options_.pressure)));
  }

  /// Into the bed, in the order of the sequence, unless there were more before. Returns whether all fit.
  bool hand_over(const Spheres<3>& spheres) {
    Bed& bed = work_.bed();
    std::vector<std::optional<Bed::Ball>> before(spheres.size());
    const std::size_t count_before = bed.size();
    for (Bed::Id i = 0; i < bed.size(); ++i) {
      before.resize(std::max<std::size_t>(before.size(), bed.tag(i) + 1));
      before[bed.tag(i)] = bed[i];
    }
    bed.remove_tags_from(0);
    std::vector<bool> placed(spheres.size(), false);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      placed[i] = bed.fits(spheres.center(i), spheres.r[i]);
      if (placed[i]) bed.insert(spheres.center(i), spheres.r[i], static_cast<std::uint32_t>(i));
    }
    const bool all_fit = bed.size() == spheres.size();
    if (bed.size() < count_before) {
      bed.remove_tags_from(0);
      placed.assign(before.size(), false);
      for (std::uint32_t tag = 0; tag < before.size(); ++tag) {
        placed[tag] = before[tag].has_value();
        if (placed[tag]) bed.insert(before[tag]->center, before[tag]->r, tag);
      }
    }
    work_.supply->set_placed(placed);
    return all_fit;
  }

  Work& work_;
  const GrowOptions options_;
  Random random_;
  const double full_size_;  // at which spheres have their radii and the skin
  std::vector<Wall<3>> walls_;
  Vector<3> edges_, to_box_;
  double next_volume_ = 0, next_squeeze_ = 0;
  bool cancelled_ = false;
};

}  // namespace

std::vector<Wall<3>> walls_for_growth(const Domain& shape, double smallest_radius) {
  return convex_walls(shape, flatness * smallest_radius);
}

StageEnd grow_in_container(Work& work, const GrowOptions& options) { return Growth(work, options).run(); }

}  // namespace bernal
