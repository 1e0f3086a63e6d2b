#include "hard/grow.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hard/convex_walls.hpp"
#include "jam/polish.hpp"
#include "settle/insert.hpp"
#include "work/random_insertion.hpp"
#include "work/reporter.hpp"
#include "work/snug_places.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {
namespace {

/// Of the smallest radius: facets whose corners are that near to one plane count as one.
constexpr double flatness = 1e-4;
/// What such walls may be inside of the container, in flatness: see `convex_walls`.
constexpr double inset = 6;
/// Of the smallest radius: what round walls that are not convex may be inside of the container, as facets.
constexpr double roundness = 1e-3;
/// Spheres start no larger than this share of their radii, clear of such walls wherever they come from.
constexpr double largest_start = 0.99;
/// Random places tried for a sphere before the insertion counts as stuck, and the thinnest insertion.
constexpr int most_trials_between_walls = 10000;
constexpr double least_phi_init = 1e-6;
/// More than what is likely to fit, in shares of it, is not tried at once; and less than that is not
/// expected.
constexpr double most_of_attainable = 1.1, least_of_attainable = 0.9;
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

/// Spheres on their way to their radii.
struct Growing : FirstDrawn {
  double size = 1;          ///< the share of their radii that they have
  bool grown = false;       ///< they have reached them
  bool keeps_room = false;  ///< their centres are as far from walls as they will be

  void archive(Archive& a) { a(spheres, placed, size, grown, keeps_room); }
};

template <int D>
double root(double volume) {
  return D == 3 ? std::cbrt(volume) : std::pow(volume, 1.0 / D);
}
template <int D>
double power(double size) {
  double volume = size;
  for (int k = 1; k < D; ++k) volume *= size;
  return volume;
}

/// In a container of D dimensions.
template <int D>
class Growth {
 public:
  Growth(SpheresInBed& in_bed, Reporter& report, const Grow& options)
      : in_bed_(in_bed),
        report_(report),
        options_(options),
        random_(report.random(Stream::grow)),
        full_size_(1 + (1 + share_for_rounding) * in_bed.bed().skin() / in_bed.supply->smallest()),
        arena_{{},
               convex_walls<D>(in_bed.task.domain, flatness * in_bed.supply->smallest()),
               in_bed.task.container->volume()},
        inside_(in_bed.supply->smallest() * (!arena_.walls.empty() ? inset * flatness
                                             : std::holds_alternative<Revolved>(in_bed.task.domain)
                                                 ? roundness
                                                 : 0)) {
    const Bounds<3> bounds = in_bed.bed().container().bounds();
    const Boundary<3>& boundary = in_bed.bed().container().boundary();
    arena_.edges = bounds.size().head<D>().array() + margin * 2 * in_bed.supply->largest();
    to_box_ = 0.5 * arena_.edges - bounds.center().head<D>();
    for (int k = 0; k < D; ++k) {
      if (!boundary.repeats(k)) continue;
      arena_.edges[k] = boundary.edges[k];
      to_box_[k] = -boundary.origin[k];
    }
    for (Wall<D>& wall : arena_.walls) wall.shift(to_box_);
    if (!arena_.walls.empty()) return;
    arena_.facets = std::make_shared<FacetedWalls>(in_bed.task.domain, inside_, point_in_space<D>(to_box_));
  }

  StageEnd run() {
    const std::size_t wanted = in_bed_.target_count();
    if (in_bed_.bed().size() >= wanted) return StageEnd::converged;
    if (!fits_between_walls()) {
      complete(wanted);
      return in_bed_.bed().size() >= wanted ? StageEnd::converged : StageEnd::full;
    }
    Growing growing;
    bool again = false;
    const Resumable part(report_, "growth in container", [&](Archive& a) { a(again, growing); });
    if (!again) {
      growing = grow_as_many_as_fit(wanted, false);
      again = arena_.facets && growing.spheres.size() < wanted && is_short(growing);
    }
    if (again && !cancelled_) {
      Growing other = grow_as_many_as_fit(wanted, true);
      if (other.grown &&
          (!growing.grown || in_bed_.volume_of(other.spheres) > in_bed_.volume_of(growing.spheres)))
        growing = std::move(other);
    }
    const BedKeepsake before(in_bed_);
    const bool all_there = in_bed_.put_in_bed(growing.spheres);
    before.give_back_if_denser(in_bed_);
    if (cancelled_) return StageEnd::cancelled;
    if (in_bed_.bed().size() < wanted) complete(wanted);
    if (in_bed_.bed().size() >= wanted) return StageEnd::converged;
    return all_there ? StageEnd::full : StageEnd::hit_limit;
  }

 private:
  /// More and more of the drawn sequence, until they jam or all that are wanted have grown.
  Growing grow_as_many_as_fit(std::size_t wanted, bool keeps_room) {
    Growing growing{in_bed_.drawn(0)}, more;
    growing.keeps_room = keeps_room;
    std::size_t count = std::min(wanted, in_bed_.count_filling(most_of_attainable * in_bed_.task.attainable));
    bool first = true;
    const Resumable part(report_, "growth",
                         [&](Archive& a) { a(growing, count, first, more, trims_, random_); });
    for (bool goes_on = part.resumed();;
         first = false, count = std::min(wanted, count + std::max<std::size_t>(1, count / 10))) {
      if (!std::exchange(goes_on, false)) {
        more = growing;
        more.extend(count, *in_bed_.supply);
        insert(more);
        trims_ = 0;
      }
      const bool jammed = trims_ > 0 || !grow(more);
      if (jammed) trim_and_grow(more);
      if (first || (more.grown && more.spheres.size() > growing.spheres.size())) growing = std::move(more);
      if (jammed || growing.spheres.size() >= wanted) return growing;
    }
  }

  /// Whether so much less than is expected has grown that some must have jammed where they had no room.
  bool is_short(const Growing& growing) const {
    return !growing.grown ||
           in_bed_.volume_of(growing.spheres) < least_of_attainable * in_bed_.task.attainable * arena_.volume;
  }

  /// With those that the walls leave hardly any room, which are never as large as they have to be in flight.
  void complete(std::size_t wanted) {
    SnugPlaces(in_bed_, report_).complete(in_bed_.volume_of_drawn(wanted) / in_bed_.task.container->volume());
  }

  /// Of analytic containers that is known beforehand; the walls of a mesh may be a little inside of it.
  bool fits_between_walls() const {
    if (arena_.facets) return full_size_ * in_bed_.supply->largest() + inside_ <= in_bed_.roomiest().radius;
    if (!std::holds_alternative<Mesh>(in_bed_.task.domain)) return true;
    double room = 0;
    if constexpr (D == 3)  // of which meshes are
      room = largest_sphere_between(arena_.walls, {Vector<3>::Zero(), arena_.edges}).radius;
    if (in_bed_.supply->largest() <= room) return true;
    if (in_bed_.supply->largest() <= (1 + 1e-9) * in_bed_.roomiest().radius) return false;
    throw Error(
        ErrorCode::bad_scene,
        fmt::format(
            "the largest sphere does not fit into the container, which takes one only {:.6g} times as "
            "large: use smaller ones or check the units",
            room / in_bed_.supply->largest()));
  }

  /// Finds places for all spheres that have none, and the size at which they do.
  void insert(Growing& growing) {
    const EffectTimer timer(report_.effects["insertion"]);
    const double filled = in_bed_.volume_of(growing.spheres) / arena_.volume;
    do {
      double phi = options_.phi_init.value_or(0.2);
      do {
        growing.size = std::min(largest_start, root<D>(phi / filled));
        if (try_to_insert(growing)) return;
        phi /= 2;
      } while (phi > least_phi_init);
    } while (std::exchange(growing.keeps_room, false));
    throw Error(
        ErrorCode::bad_scene,
        "grow cannot start: random insertion found no place for one of the spheres even where they are "
        "small; use \"relax\"");
  }

  bool try_to_insert(Growing& growing) {
    const Container& container = in_bed_.bed().container();
    const bool all = insert_at_random<3>(
        growing.spheres, growing.placed, growing.size, container.bounds(), container.boundary(),
        most_trials_between_walls, [&](double) { return in_bed_.bed().places().draw(random_); },
        [&](const Vector<3>& c, double r) {
          const double needed = inside_ + (growing.keeps_room ? full_size_ / growing.size : 1) * r;
          return container.clearance_within(c, needed) >= needed;
        },
        report_.monitor);
    if (all) growing.placed.assign(growing.spheres.size(), true);
    return all;
  }

  /// Lets them fly and grow until they have their radii, or jam. Returns whether they have.
  bool grow(Growing& growing) {
    const EffectTimer timer(report_.effects["growth"]);
    Spheres<D> flying = along_axes<D>(growing.spheres);
    const Boundary<D> box{arena_.edges};
    for (std::size_t i = 0; i < flying.size(); ++i) {
      flying.r[i] *= growing.size;
      flying.set_center(i, box.wrap(Vector<D>(flying.center(i) + to_box_)));
    }
    if (flying.empty()) return growing.grown = true;
    const double largest = full_size_ / growing.size;
    arena_.room_at_walls = growing.keeps_room ? largest : 0;
    const auto [end, size] =
        grow_to<D>(largest, flying, arena_, report_, options_, [&](double size_now, double done) {
          const double volume = power<D>(size_now) * volume_of(flying);
          report_.milestone("grow", flying.size(), volume / in_bed_.task.container->volume(), 0, done);
        });
    cancelled_ = end == StageEnd::cancelled;
    for (std::size_t i = 0; i < flying.size(); ++i) flying.set_center(i, flying.center(i) - to_box_);
    std::ranges::copy(flying.x, growing.spheres.x.begin());
    growing.size *= size;
    return growing.grown = size == largest;
  }

  /// As often as it takes, or a few times: takes out what the jammed spheres had no room for, and a little
  /// more, and lets the others grow.
  void trim_and_grow(Growing& growing) {
    if (trims_ > 0) grow(growing);  // as it was at
    while (trims_ < most_trims && !growing.grown && !cancelled_) {
      const double volume = power<D>(growing.size) * in_bed_.volume_of(growing.spheres);
      const double spare = std::ldexp(caution, trims_++);
      const std::size_t fitting = in_bed_.supply->count_filling((1 - spare) * volume);
      growing.spheres.resize(std::min(fitting, growing.spheres.size()) - 1);
      growing.size *= 1 - shrinkage;
      grow(growing);
    }
  }

  SpheresInBed& in_bed_;

  Reporter& report_;
  const Grow options_;
  Random random_;
  const double full_size_;  // at which spheres have their radii and the skin
  Arena<D> arena_;
  const double inside_;  // of the container that the walls may be, at most
  Vector<D> to_box_;
  int trims_ = 0;  // of those that grow
  bool cancelled_ = false;
};

}  // namespace

StageEnd grow_in_container(const Grow& options, SpheresInBed& in_bed, Reporter& report) {
  StageEnd end = StageEnd::converged;
  bool is_grown = false;
  const Resumable part(report, "grow in container", [&](Archive& a) { a(is_grown, end); });
  const auto grown = [&] {
    // What fits only touching the walls is never as large as it has to be in flight.
    if (SnugPlaces(in_bed, report).only_some_touch()) return insert_largest_first(in_bed, report);
    const StageEnd growth = in_bed.bed().dimension() == 2 ? Growth<2>(in_bed, report, options).run()
                                                          : Growth<3>(in_bed, report, options).run();
    return in_bed.task.target.is_open() ? growth : insert_what_else_fits(in_bed, report, growth);
  };
  if (!is_grown) end = grown();
  is_grown = true;
  return finish_in_bed(end, options.polish, in_bed, report);
}

}  // namespace bernal
