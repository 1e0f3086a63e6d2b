#include "hard/grow.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "hard/hard_spheres.hpp"
#include "jam/polish.hpp"
#include "work/free_of_overlap.hpp"
#include "work/random_insertion.hpp"

namespace bernal {
namespace {

/// Random places tried for a sphere before the insertion counts as stuck.
constexpr int most_trials = 100000;
/// Spheres grow by this much beyond the size that was asked for, so that the box has room for rounding.
constexpr double room_for_rounding = 1e-12;
/// A milestone for each growth by this much of the volume, or of the logarithm of the compressibility factor.
constexpr double volume_a_milestone = 0.01, squeeze_a_milestone = 0.1;
/// Spheres below this compressibility factor, a dimension, are a fluid that forgets how fast it was
/// compressed.
constexpr double fluid = 4, haste_of_fluid = 10;
/// Fast growth locks spheres that slower growth frees again. So where the pressure is reached it goes on at a
/// third of its rate, until that adds less than this share to the volume of the spheres, or less than what
/// spheres at this pressure lack to their jamming: D over the compressibility factor (Salsburg & Wood, J.
/// Chem. Phys. 37, 798 (1962)).
constexpr double slower = 1.0 / 3, little_more = 1e-3;

/// The papers' phi_init; in other than three dimensions as far below where random insertion ends.
constexpr double loose_start[] = {0.28, 0.2, 0.135, 0.089, 0.057};

void complete_grow(Grow& grow, Scene& scene, const schema::Section&) {
  if (!grow.phi_init) grow.phi_init = loose_start[scene.dimension() - 2];
}

/// Random sequential insertion between the walls. Returns whether all have found places.
template <int D>
bool insert_at_random(Spheres<D>& spheres, const std::vector<bool>& placed, const Vector<D>& edges,
                      const std::vector<bool>& walls, Random random, const Monitor& monitor) {
  const Boundary<D> boundary{edges_around_walls(edges, walls)};
  const auto between_walls = [&](double r) {
    Bounds<D> bounds{Vector<D>::Zero(), edges};
    for (int k = 0; k < D; ++k)
      if (!walls.empty() && walls[static_cast<std::size_t>(k)]) bounds.lower[k] += r, bounds.upper[k] -= r;
    return uniform_point(random, bounds);
  };
  return bernal::insert_at_random<D>(
      spheres, placed, 1, {Vector<D>::Zero(), boundary.edges}, boundary, most_trials, between_walls,
      [](const Vector<D>&, double) { return true; }, monitor);
}

/// Those of the box, in its coordinates.
template <int D>
std::vector<Wall<D>> walls_of(const SpheresInBox& in_box, const Vector<D>& edges) {
  std::vector<Wall<D>> walls;
  for (int k = 0; k < D; ++k) {
    if (!in_box.task.has_wall(k)) continue;
    walls.push_back({.along = -Vector<D>::Unit(k), .extent = 0});
    walls.push_back({.along = Vector<D>::Unit(k), .extent = edges[k]});
  }
  return walls;
}

template <int D>
void require_room(const Spheres<D>& spheres, const Vector<D>& box, const std::vector<bool>& walls) {
  const Vector<D> edges = edges_around_walls(box, walls);
  const double diameters = edges.minCoeff() / (2 * std::ranges::max(spheres.r));
  if (diameters < HardSpheres<D>::smallest_edge)
    throw Error(ErrorCode::bad_scene,
                fmt::format("grow needs a box at least {} of the largest diameters wide; {} spheres of these "
                            "sizes make one of {:.2f}. Take more spheres, or relax instead",
                            HardSpheres<D>::smallest_edge, spheres.size(), diameters));
}

template <int D>
void start(Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box, Reporter& report, double phi_init) {
  if (in_box.begun > 0 || in_box.placed) {
    // Which other stages leave, and a start may have.
    if (in_box.task.allowed_overlap > 0 || in_box.may_overlap) {
      Spheres<D> there = spheres;
      if (!in_box.placed) there.resize(in_box.begun);
      const Vector<D> free = edges_free_of_overlap<D>(there, edges, 0, in_box.task.walls);
      if (!free.allFinite())
        throw Error(ErrorCode::bad_scene,
                    "two spheres of the start have the same place: begin with \"relax\", which parts them");
      if (free[0] > edges[0]) resize_box<D>(spheres, edges, free);
    }
    if (in_box.placed) return require_room<D>(spheres, edges, in_box.task.walls);
  }
  const EffectTimer timer(report.effects["insertion"]);
  double volume = in_box.volume_of_spheres() / phi_init;
  if (in_box.task.target_edges) volume = std::max(volume, in_box.task.target_edges->prod());
  const double wider = std::pow(volume / edges.prod(), 1.0 / D);
  if (in_box.begun == 0)
    edges *= wider;
  else if (wider > 1)
    resize_box<D>(spheres, edges, edges * wider);
  require_room<D>(spheres, edges, in_box.task.walls);
  std::vector<bool> placed(spheres.size(), false);
  std::fill_n(placed.begin(), in_box.begun, true);
  if (!insert_at_random<D>(spheres, placed, edges, in_box.task.walls, report.random(Stream::grow),
                           report.monitor))
    throw Error(ErrorCode::bad_scene,
                fmt::format("grow cannot start at phi_init = {}: random insertion found no place for one of "
                            "the spheres; take a smaller one",
                            phi_init));
}

/// Spheres as thick as what is between two walls touch both before they have their size, and jam. What little
/// they lack they may have room for elsewhere: then they stand in the box that was asked for, touching its
/// walls exactly.
template <int D>
bool stands_in_asked_box(const Spheres<D>& grown, const Vector<D>& edges, SpheresInBox& in_box) {
  constexpr double little = 1e-4;
  if (in_box.task.walls.empty() || !in_box.task.target_edges) return false;
  const Vector<D> asked = *in_box.task.target_edges;
  if (!(edges[0] > asked[0]) || edges[0] > (1 + little) * asked[0]) return false;
  Spheres<D> spheres = grown;
  Vector<D> now = edges;
  resize_box<D>(spheres, now, asked);
  for (int k = 0; k < D; ++k)
    for (std::size_t i = 0; i < spheres.size() && in_box.task.has_wall(k); ++i) {
      double& x = spheres.x[static_cast<std::size_t>(k)][i];
      if (2 * spheres.r[i] > asked[k]) return false;
      x = std::max(spheres.r[i], std::min(x, asked[k] - spheres.r[i]));
      if (asked[k] - x < spheres.r[i]) return false;
    }
  const Vector<D> apart = edges_around_walls(asked, in_box.task.walls);
  if (!overlapping<D>(spheres, apart, in_box.task.allowed_overlap).empty()) return false;
  in_box.spheres = spheres;
  in_box.edges = asked;
  in_box.needed_volume = asked.prod();
  in_box.placed = true;
  return true;
}

template <int D>
StageEnd grow_in(SpheresInBox& in_box, Reporter& report, const Grow& options) {
  Spheres<D> spheres = in_box.spheres.in<D>();
  Vector<D> edges = in_box.edges;
  bool grown = false;
  StageEnd end = StageEnd::converged;
  const Resumable part(report, "grow", [&](Archive& a) {
    a(grown, end, edges, in_box.edges);
    if (grown) a(spheres);  // before that, they fly
  });
  const auto finish = [&] {
    // While it is polished, a checkpoint has what that began with.
    return finish_in_periodic_box<D>(options.polish > 0 ? spheres : std::move(spheres), edges, end,
                                     options.polish, in_box, report);
  };
  if (grown) return finish();
  if (!part.resumed())
    start<D>(spheres, edges, in_box, report, options.phi_init.value_or(loose_start[D - 2]));
  const double volume = edges.prod();
  double largest = std::numeric_limits<double>::infinity();
  if (in_box.task.target_edges)
    largest =
        std::max(1.0, std::pow(volume / in_box.task.target_edges->prod(), 1.0 / D)) * (1 + room_for_rounding);
  const Arena<D> arena{edges_around_walls(edges, in_box.task.walls), walls_of(in_box, edges), volume};
  end = grow_to<D>(largest, spheres, arena, report, options, [&](double size_now, double done) {
          in_box.edges = edges / size_now;
          report.milestone("grow", in_box, 0, done);
        }).end;
  free_of_overlap<D>(spheres, edges, in_box.task, report);
  if (end == StageEnd::hit_limit)
    report.missed = fmt::format(
        "their box has become {} of the largest diameters wide, and grow knows no narrower one; take more "
        "spheres, or relax instead",
        HardSpheres<D>::smallest_edge);
  if (end != StageEnd::cancelled && stands_in_asked_box<D>(spheres, edges, in_box))
    return end_in_larger_box(StageEnd::converged, options.polish, report);
  grown = true;
  return finish();
}

}  // namespace

/// Of the mean diameter over the thermal speed: see `grow`.
template <int D>
double growth_rate(const Spheres<D>& spheres, double volume, const Grow& options) {
  double volumes = 0, by_number = 0, by_volume = 0;
  for (const double r : spheres.r) {
    const double v = ball_volume(D, r);
    volumes += v;
    by_number += 2 * r;
    by_volume += v * 2 * r;
  }
  by_number /= static_cast<double>(spheres.size());
  by_volume /= volumes;
  return options.delta ? *options.delta * by_number / std::pow(volume, 1.0 / D)
                       : options.rate * by_number / by_volume;
}

template <int D>
Grown grow_to(double largest, Spheres<D>& spheres, const Arena<D>& arena, Reporter& report,
              const Grow& options, const std::function<void(double size, double done)>& on_growth) {
  HardSpheres<D> flight(spheres, arena.edges, report.random(Stream::grow),
                        {.walls = arena.walls,
                         .facets = arena.facets.get(),
                         .room_at_walls = arena.room_at_walls,
                         .masses = options.masses});
  double rate = growth_rate<D>(spheres, arena.volume, options);
  StageEnd end = StageEnd::converged;
  double next_squeezed = 0, next_filled = 0, locked = 0;
  FlightPeriod period;
  const Resumable part(report, "flight",
                       [&](Archive& a) { a(flight, next_squeezed, next_filled, period, rate, locked); });
  while (flight.size() < largest) {
    if (period.compressibility_factor >= options.pressure) {
      if (D * std::log(flight.size() / locked) < std::max(little_more, D / options.pressure)) break;
      locked = flight.size();
      rate *= slower;
    }
    if (!flight.has_room()) {
      end = StageEnd::hit_limit;
      break;
    }
    if (report.stop()) {
      end = StageEnd::cancelled;
      break;
    }
    const bool in_haste = !options.delta && period.compressibility_factor < fluid * D;
    period = flight.fly(in_haste ? haste_of_fluid * rate : rate, largest, report.monitor);
    const auto count = [&](const char* effect, std::uint64_t calls) {
      if (calls > 0) report.effects[effect].calls += calls;
    };
    count("collisions", period.collisions);
    count("reflections", period.reflections);
    count("neighbour shells", period.departures + period.builds);
    if (period.stopped) {
      end = StageEnd::cancelled;
      break;
    }
    const double filled = std::pow(flight.size() / largest, D);
    const double squeezed = std::log(std::max(1.0, period.compressibility_factor));
    if (squeezed < next_squeezed && filled < next_filled) continue;
    next_squeezed = squeezed + squeeze_a_milestone;
    next_filled = filled + volume_a_milestone;
    on_growth(flight.size(), std::max(filled, squeezed / std::log(options.pressure)));
  }
  const FlightTimes& times = flight.times();
  const auto add_time = [&](const char* effect, double seconds) {
    if (seconds > 0) report.effects[effect].seconds += seconds;
  };
  add_time("collisions", times.collisions.seconds());
  add_time("reflections", times.reflections.seconds());
  add_time("neighbour shells", times.departures.seconds() + times.builds);
  flight.write_to(spheres);
  return {end, flight.size()};
}
template Grown grow_to<2>(double, Spheres<2>&, const Arena<2>&, Reporter&, const Grow&,
                          const std::function<void(double, double)>&);
template Grown grow_to<3>(double, Spheres<3>&, const Arena<3>&, Reporter&, const Grow&,
                          const std::function<void(double, double)>&);

StageEnd grow(const Grow& options, SpheresInBox& in_box, Reporter& report) {
  EffectTimer timer(report.effects["growth"]);
  return with_dimension(in_box.dimension(), std::integer_sequence<int, 2, 3, 4, 5, 6>{}, [&](auto dimension) {
    return grow_in<decltype(dimension)::value>(in_box, report, options);
  });
}

template <>
const StageEntry& entry_of<Grow>() {
  using namespace schema;
  static const StageEntry entry =
      {.table = stage_table<Grow>(
           {.name = "grow",
            .help = "hard spheres fly, collide and grow, in containers to their radii, in periodic boxes of "
                    "2 to 6 dimensions until they jam",
            .keys =
                {buys_accuracy(
                     {10, 1, 0.1, 0.01},
                     number(&Grow::delta, "delta",
                            "as published: growth of the radii, relative to those at the start, in the time "
                            "that a "
                            "sphere of thermal speed takes across the box, or for the cube root of the "
                            "container's volume; if absent see rate",
                            {1e-3, 100})),
                 number(
                     &Grow::phi_init, "phi_init",
                     "packing fraction of the random insertion at the start, in a container half of it "
                     "where spheres find no places; if absent 0.2, in other than three dimensions half of "
                     "what insertion reaches",
                     {least_packing_fraction, 0.5}),
                 buys_accuracy(
                     {0.3, 0.1, 0.03, 0.01, 0.003, 0.001},
                     number(&Grow::rate, "rate",
                            "growth of the mean diameter by volume over the thermal speed where the packing "
                            "forms; slower is denser; ten times that while the spheres are a fluid",
                            {1e-6, 1})),
                 buys_accuracy({1e2, 1e3, 1e4, 1e6, 1e9},
                               number(&Grow::pressure, "pressure",
                                      "compressibility factor P V / N k T at which the spheres count as "
                                      "jammed, once slower growth adds nothing",
                                      {10, 1e13})),
                 word(&Grow::masses, "masses",
                      "equal, as published; volume: as of one material, which packs denser where sizes "
                      "differ "
                      "several times, if the rate is low",
                      {"equal", "volume"}),
                 polish_key<Grow>()},
            .complete = completion(complete_grow)},
           {.in_bed = true,
            .in_box = true,
            .in_plane = true,
            .box_between_walls = true,
            .least_dimension = 2,
            .most_dimensions = 6,
            .keeps_sizes = true,
            .places_expected = true,
            .frees_box = true,
            .joins_start = true,
            .reaches = Reaches::close_packing}),
       .act_in_bed = of_options(grow_in_container),
       .act_in_box = of_options(grow),
       .may_bring = {"insertion", "neighbour shells", "collisions", "reflections", "growth", "polish"},
       .effects = of_options(effects_of_growth)};
  return entry;
}

}  // namespace bernal
