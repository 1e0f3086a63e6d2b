#include "settle/compress.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "settle/mover.hpp"
#include "settle/roll_to_rest.hpp"

namespace bernal {
namespace {

/// Sweeps along the global direction between two buildings of the lists, at most; fewer once a sweep gains
/// less than `little` of the first.
constexpr int global_sweeps = 8;
constexpr double little = 0.3;
/// In the end no sphere moves farther than this, in radii.
constexpr double at_rest_in_radii = 1e-7;
/// The bed is at rest when the spheres' mean way along the global direction in an iteration is less than
/// this, in mean radii. Until then local directions would only disturb the fall. (Potential energy does not
/// tell: it may be that of a few large spheres, at rest while the small ones still fall.)
constexpr double at_rest = 0.1;
/// Where there is little to meet and far to go, bounding boxes double: while the mean way is more than
/// `moving` of the box and a box holds fewer neighbours than `few_neighbors` on average.
constexpr double moving = 0.02;
constexpr double few_neighbors = 20;
/// Sweeps along local directions between two buildings of the lists.
constexpr int local_sweeps = 10;
/// A bed at rest is looked at in so many layers, or fewer, of so many spheres at least: while local
/// directions stir it, single spheres always fall, by up to the room in their boxes, and only the mean of
/// many tells whether the bed as a whole sinks.
constexpr std::size_t most_layers = 16, least_of_layer = 64;
/// A sphere that moves less than this, in radii, rests; one that moves more wakes its neighbours.
constexpr double resting = 1e-4;
constexpr double waking = 1e-3;

/// Sweeps along the global direction over the spheres that are awake: those that moved when last visited, or
/// next to which something moved. A sphere whose surroundings have not changed cannot move.
class GlobalSweeps {
 public:
  GlobalSweeps(Bed& bed, const Vector<3>& direction) : bed_(bed), mover_(bed), direction_(direction) {}

  /// To be called after every `Bed::enclose`.
  void wake_all() { awake_.assign(bed_.size(), 1); }

  /// Sweeps until one lowers the potential by little compared with the first. Returns the mean way.
  double settle() {
    ways_ = 0;
    double height = bed_.potential(direction_);
    double first_fall = 0;
    for (int k = 0; k < global_sweeps; ++k) {
      sweep();
      const double now = bed_.potential(direction_);
      const double fall = height - now;
      height = now;
      if (k == 0) first_fall = fall;
      if (k > 0 && fall < little * first_fall) break;
    }
    return ways_ / static_cast<double>(bed_.size());
  }

 private:
  void sweep() {
    for (Bed::Id i = 0; i < bed_.size(); ++i) {
      if (!awake_[i]) continue;
      const double way = mover_.slide(i, direction_, std::numeric_limits<double>::infinity());
      ways_ += way;
      awake_[i] = way > resting * bed_[i].r;
      if (way <= waking * bed_[i].r) continue;
      for (const Bed::Id j : bed_.neighbors(i)) awake_[j] = 1;
    }
  }

  const Made made_{"compression"};
  Bed& bed_;
  Mover mover_;
  Vector<3> direction_;
  std::vector<char> awake_;
  double ways_ = 0;  // summed over the spheres since settle began
};

/// How far spheres have moved since some moment at which they were enclosed, in their own radii.
class Moved {
 public:
  void start(const Bed& bed) {
    start_.resize(bed.size());
    for (Bed::Id i = 0; i < bed.size(); ++i) start_[i] = bed[i].center;
  }

  /// Along the direction, the mean of the layer that sank most. Layers are as many spheres each, in the order
  /// in which they are.
  double layer_farthest_along(const Vector<3>& direction, const Bed& bed) const {
    const std::size_t n = bed.size();
    const std::size_t layers = std::clamp<std::size_t>(n / least_of_layer, 1, most_layers);
    double most = 0;
    for (std::size_t k = 0; k < layers; ++k) {
      const auto first = static_cast<Bed::Id>(k * n / layers),
                 last = static_cast<Bed::Id>((k + 1) * n / layers);
      double sum = 0;
      for (Bed::Id i = first; i < last; ++i) sum += direction.dot(bed[i].center - start_[i]) / bed[i].r;
      most = std::max(most, sum / (last - first));
    }
    return most;
  }

 private:
  std::vector<Vector<3>> start_;
};

/// The lowest height against `direction` in the container's bounds: where potential energy counts from.
double floor_of(const Bounds<3>& bounds, const Vector<3>& direction) {
  double height = 0;
  for (int k = 0; k < 3; ++k) {
    height -= direction[k] * (direction[k] > 0 ? bounds.upper[k] : bounds.lower[k]);
  }
  return height;
}

}  // namespace

void sweep_at_random(Bed& bed, const Vector<3>& pull, double tilt, const Vector<3>& across, double limit,
                     Random& random) {
  Mover mover(bed);
  for (Bed::Id i = 0; i < bed.size(); ++i) {
    Vector<3> u = bed.random_direction(random);
    u -= u.dot(across) * across;
    u = pull + tilt * u;
    const double length = u.norm();
    if (length > 1e-6) mover.slide(i, u / length, limit);
  }
}

void require_support(const Boundary<3>& boundary, const Vector<3>& direction) {
  if (direction.cwiseProduct(boundary.edges).isZero(0)) return;
  for (int k = 2; k >= 0; --k) {
    if (boundary.repeats(k)) continue;
    const Vector<3> valid = -Vector<3>::Unit(k);
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("spheres pressed along an axis that repeats itself fall for ever; take a direction "
                    "across it, such as [{}, {}, {}]",
                    valid[0] + 0.0, valid[1] + 0.0, valid[2] + 0.0));
  }
  throw Error(ErrorCode::bad_scene,
              "there is no wall to press spheres against in a box that repeats itself along all axes; use "
              "\"relax\" or \"grow\"");
}

Vector<3> direction_of(const Coordinates& direction) {
  Vector<3> in_space = Vector<3>::Zero();
  in_space.head(direction.size()) = direction;
  return in_space.normalized();
}

StageEnd compress(const Compress& options, SpheresInBed& in_bed, Reporter& report) {
  Bed& bed = in_bed.bed();
  const Vector<3> direction = direction_of(options.direction);
  require_support(bed.container().boundary(), direction);
  if (bed.size() == 0) return StageEnd::converged;
  const EffectTimer timer(report.effects["compression"]);
  const double floor = floor_of(bed.container().bounds(), direction);
  double radius = bed.mean_radius();
  Random random = report.random(Stream::compress);
  double box = options.buffer * radius;
  int iteration = 0;
  bool stirs = true;
  const Resumable part(report, "compress", [&](Archive& a) { a(radius, random, box, iteration, stirs); });
  if (!part.resumed()) bed.sort_by_height(direction);
  GlobalSweeps global(bed, direction);
  Moved moved;

  for (; iteration < options.max_iterations; ++iteration) {
    if (!stirs)
      return roll_to_rest(bed, report, direction,
                          {.still = at_rest_in_radii, .most_iterations = options.max_iterations});
    if (report.stop()) return StageEnd::cancelled;
    box = bed.enclose(box);
    global.wake_all();  // the ends of the old boxes held some
    moved.start(bed);
    const double before = bed.potential(direction);
    const double way = global.settle();
    const bool resting_bed = way < at_rest * radius;
    const double factor = bed.mean_neighbors() < few_neighbors ? 2 : 0.5;
    const double least_box = options.buffer * radius;
    box = way > moving * box ? std::max(least_box, factor * box) : least_box;
    if (resting_bed && options.tilt > 0) {
      for (int k = 0; k < local_sweeps; ++k) {
        sweep_at_random(bed, direction, options.tilt, Vector<3>::Zero(), 2 * radius, random);
      }
      global.wake_all();
      global.settle();
    }
    report.milestone("compress", bed);
    if (options.tolerance) {
      const double fall = before - bed.potential(direction);
      if (resting_bed && fall < *options.tolerance * (before - floor)) return StageEnd::converged;
    } else if (resting_bed && moved.layer_farthest_along(direction, bed) <= options.rest) {
      stirs = false;
    }
  }
  return StageEnd::hit_limit;
}

std::vector<schema::Key> compression_keys() {
  using namespace schema;
  return {
      key(Type::push, &Compress::direction, "direction",
          "where the spheres are pushed; its length is of no matter"),
      number(&Compress::tilt, "tilt", "how far a sphere's own direction leaves the common one; 0: not at all",
             {0, 100}),
      buys_accuracy({0.5, 0.2, 0.1, 0.03, 1e-2, 1e-3},
                    number(&Compress::rest, "rest",
                           "how far a bed at rest may still sink in an iteration, in radii", above(0, 1))),
      buys_accuracy({0.3, 0.1, 1e-2, 1e-3, 1e-4},
                    number(&Compress::tolerance, "tolerance",
                           "in place of it, as the paper: relative fall of the potential energy in an "
                           "iteration that counts as none",
                           between(0, 1))),
      integer(&Compress::max_iterations, "max_iterations", "after which it stops unconverged", {1, 1e9}),
      number(&Compress::buffer, "buffer", "room in a sphere's bounding box on each side, in mean radii",
             {0.01, 10})};
}

std::vector<schema::Choice> ends_of_compression() { return {{{"rest"}, {"tolerance"}}}; }

Pressing pressing_of_compression(const Compress& c) {
  return {direction_of(c.direction), c.tolerance.has_value(), 0,
          c.tolerance ? "leave \"tolerance\" out of the stages that settle, or make it smaller"
                      : "let the stages that settle do more, by \"max_iterations\""};
}

template <>
const StageEntry& entry_of<Compress>() {
  static const StageEntry entry = {
      .table = stage_table<Compress>({.name = "compress",
                                      .help = "move every sphere along a direction until it touches",
                                      .keys = compression_keys(),
                                      .choices = ends_of_compression()},
                                     {.in_bed = true,
                                      .in_plane = true,
                                      .in_repeated_mesh = true,
                                      .only_moves = true,
                                      .is_default_in_plane = true}),
      .act_in_bed = of_options(compress),
      .may_bring = {"neighbour lists", "compression"},
      .effects = of_options(effects_of_compression),
      .pressing = of_options(pressing_of_compression),
      .require = of_options(+[](const Compress& o, const Domain& domain, double, const FillTask&) {
        require_support(boundary_of<3>(domain), direction_of(o.direction));
      })};
  return entry;
}

}  // namespace bernal
