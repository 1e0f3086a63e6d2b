#include "soft/relax.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "core/close_packing.hpp"
#include "jam/polish.hpp"
#include "soft/device_packing.hpp"
#include "soft/exchange_in_box.hpp"
#include "soft/ground.hpp"
#include "soft/growing_box.hpp"
#include "soft/relax_wide.hpp"
#include "soft/soft_engine.hpp"
#include "work/free_of_overlap.hpp"
#include "work/random_insertion.hpp"

namespace bernal {
namespace {

/// Up to this share of random close packing spheres of any sizes find places free of overlap in a given box;
/// they start in one that is smaller by volume, as it may grow while they relax, and again from where they
/// ended if it grew too far.
constexpr double loose = 0.9;
constexpr double room_to_grow = 0.03;
constexpr int most_starts_in_a_loose_box = 20;
/// Share of the volume that an exchange of sizes has to save to be worth its name.
constexpr double least_saved = 5e-4;
/// Moves, in mean radii, that break the symmetry of spheres which come in a lattice or in line.
constexpr double first_jitter = 1e-6;

bool is_loose(const SpheresInBox& in_box) {
  const std::optional<Vector<dynamic>>& target = in_box.task.target_edges;
  return target &&
         in_box.volume_of_spheres() < loose * random_close_packing[in_box.dimension() - 1] * target->prod();
}

/// Whether the spheres of a start have places, and nothing asks for others.
bool begins_as_it_is(const SpheresInBox& in_box, const Relax& options) {
  return in_box.begun > 0 && in_box.placed && !options.phi0;
}

/// Whether spheres are as dense where they begin as relaxation makes them: then they are relaxed from there,
/// and not from a denser state, which would make another packing of them.
bool begins_in_its_box(const SpheresInBox& in_box, const Relax& options) {
  return begins_as_it_is(in_box, options) &&
         in_box.volume_of_spheres() >=
             loose * random_close_packing[in_box.dimension() - 1] * in_box.edges.prod();
}

/// Whether they begin in the box that is asked for, free of overlap.
template <int D>
bool is_done(const Spheres<D>& spheres, const Vector<D>& edges, const SpheresInBox& in_box,
             const Relax& options) {
  const std::optional<Vector<dynamic>>& target = in_box.task.target_edges;
  if (!begins_as_it_is(in_box, options) || !target || in_box.edges != *target) return false;
  if (const Tilt tilt = in_box.task.tilt(in_box.edges); tilt != Tilt{})
    return edges_free_of_overlap<D>(spheres, edges, 0, {}, tilt)[0] <= edges[0];
  return is_free_of_overlap<D>(spheres, edges, in_box.task.walls);
}

/// Whether sizes are wide and spheres are to be as dense as they can.
bool begins_from_largest(const SpheresInBox& in_box, const Relax& options) {
  const bool there = in_box.placed || in_box.begun > 0;
  const FillTask& task = in_box.task.fill_task;
  return is_for_wide_sizes(task, options) && !there && !is_loose(in_box) &&
         options.phi0.value_or(1) >= std::min(dense_start(in_box.dimension()), task.attainable);
}

/// Those they begin in, or of phi0, or about those that are asked for; never so small that a sphere overlaps
/// its own image.
Vector<dynamic> edges_to_start_from(const SpheresInBox& in_box, const Relax& options) {
  const int dimension = in_box.dimension();
  const double usual = dense_start(dimension);
  double phi0 = options.phi0.value_or(usual);
  if (phi0 == usual && begins_from_largest(in_box, options)) phi0 = wide_start(in_box.task.fill_task);
  const auto with_volume = [&](double volume) -> Vector<dynamic> {
    return in_box.edges * std::pow(volume / in_box.edges.prod(), 1.0 / dimension);
  };
  Vector<dynamic> edges = with_volume(in_box.volume_of_spheres() / phi0);
  if (begins_in_its_box(in_box, options)) {
    edges = in_box.edges;
  } else if (in_box.task.target_edges) {
    const double asked = in_box.task.target_edges->prod();
    if (is_loose(in_box) || edges.prod() > asked) edges = with_volume((1 - room_to_grow) * asked);
  }
  const double needed = 2 * std::ranges::max(in_box.spheres.r) / in_box.shortest_period(edges);
  return needed > 1 ? Vector<dynamic>(edges * (needed * (1 + 4 * tolerance::roundoff))) : edges;
}

/// Places for spheres that have none. Those of others are moved by nothing that matters, so that a lattice or
/// a line of spheres does not last for ever.
template <int D>
StageEnd place(Spheres<D>& spheres, Vector<D>& edges, const Vector<D>& start, SpheresInBox& in_box,
               Reporter& report, const Relax& options) {
  if constexpr (D == 2 || D == 3)
    if (begins_from_largest(in_box, options)) {
      in_box.edges = edges = start;
      return place_from_largest<D>(spheres, edges, in_box, report, options);
    }
  Random random = report.random(Stream::relax);
  const std::size_t there = in_box.placed ? spheres.size() : in_box.begun;
  if (there == 0) {
    edges = start;
  } else {
    resize_box<D>(spheres, edges, start, is_tilted(in_box.task.domain));
    displace_at_random<D>(spheres, edges, in_box.task.walls, first_jitter * std::ranges::max(spheres.r),
                          random, in_box.task.tilt(edges));
  }
  place_at_random<D>(spheres, edges, random, there);
  return StageEnd::converged;
}

/// Whether growing the box by the overlap that counts as none is all that there is to do.
template <int D>
bool hardly_overlaps(const Spheres<D>& spheres, const Vector<D>& edges, const SpheresInBox& in_box,
                     const Relax& options) {
  const Vector<D> free =
      edges_free_of_overlap<D>(spheres, edges, 0, in_box.task.walls, in_box.task.tilt(edges));
  return free[0] <= edges[0] / (1 - options.stop);
}

/// The published relaxation on sorted arrays, with neighbour lists and over-relaxed steps. It is about a
/// hundred times as fast as the loop of the paper, and its packings are a little denser. It differs from that
/// loop in six ways.
///  - A sphere moves by min(omega / n, 1) times the sum of its n overlaps, with omega about 5. The paper's
///    1 / n is a third of a Newton step at the five or six contacts of a packed sphere.
///  - The larger sphere of a pair gives way less, in proportion to the radii (SoftKernels::sweep). By the
///    plain mean over its contacts a large sphere would stay where its many small neighbours hold it.
///  - The order of the spheres in a sweep lets many of them move at once.
///  - The last growths of the box are predicted (`grow_apart`).
///  - With more than 10,000 spheres the number of sweeps between two growths no longer increases, and the box
///    grows by the least value that the largest overlap ratio has had. Up to 10^7 spheres the packing
///    fraction stays within 0.002 of that of 10,000.
///  - It ends with overlaps far below `options.stop`.
/// In four dimensions and more `NeighborRelaxation` sweeps one sphere after the other, on lists for one size.
///
/// `overlap` is the largest overlap ratio at the start; 1 where it is not known. Preconditions and results
/// are those of `relax_by_the_book`. Cost: about 13 ns a sphere and sweep, lists included; 0.07 µs in four
/// dimensions and 0.13 µs in eight, lists not included.
template <int D>
StageEnd relax_fast(Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box, Reporter& report,
                    const Relax& options, double overlap) {
  const GrowingBox box{.stop = least_overlap(options, in_box.task.allowed_overlap),
                       .sweeps = sweeps_a_cycle(options, std::min(spheres.size(), enough_for_sweeps)),
                       .beta = options.beta};
  const auto grow = [&](auto& packing) {
    return let_box_grow<D>(packing, spheres, edges, in_box, report, box, {.molr = overlap}, 0,
                           [](int, double molr) { return molr; });
  };
  if constexpr (D == 3)
    if (options.device == RelaxDevice::gpu) {
      DevicePacking packing(spheres, edges, spheres_on_gpu());
      const StageEnd end = grow(packing);
      report.account = "on " + packing.device_name();
      return end;
    }
  SoftEngine<D> packing(spheres, edges, in_box.task.walls, 1, false, in_box.task.tilt(edges));
  return grow(packing);
}

/// `overlap` is the largest overlap ratio at the start, where it is known.
template <int D>
StageEnd push_apart(Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box, Reporter& report,
                    const Relax& options, std::optional<double> overlap = {}) {
  have_places(spheres);
  if constexpr (D == 2 || D == 3)
    if (is_for_wide_sizes(in_box.task.fill_task, options))
      return relax_wide<D>(spheres, edges, in_box, report, options, overlap.value_or(1),
                           !overlap && begins_from_largest(in_box, options) ? share_of_placing : 0);
  return options.method == RelaxMethod::fast
             ? relax_fast<D>(spheres, edges, in_box, report, options, overlap.value_or(1))
             : relax_by_the_book<D>(spheres, edges, in_box, report, options);
}

/// Takes spheres that just do not overlap to a denser packing of the same sizes, if that is found.
template <int D>
StageEnd exchange_sizes(Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box, Reporter& report,
                        const Relax& options) {
  EffectTimer timer(report.effects["exchange"]);
  Spheres<D> ordinary = spheres;
  Vector<D> ordinary_edges = edges;
  const bool wide = is_for_wide_sizes(in_box.task.fill_task, options);
  bool exchanged = false;
  std::optional<double> overlap;
  const Resumable part(report, "exchange", [&](Archive& a) {
    a(exchanged, overlap);
    if (exchanged) a(ordinary, ordinary_edges, spheres, edges);
  });
  if (!exchanged) overlap = exchange_in_box<D>(spheres, edges, wide, in_box, report);
  exchanged = true;
  if (!overlap) {
    report.account = "without an exchange of sizes: they are equal, too far apart or too few of a size";
    return StageEnd::converged;
  }
  const StageEnd end = push_apart<D>(spheres, edges, in_box, report, options, overlap);
  free_of_overlap<D>(spheres, edges, in_box.task, report);
  const double saved = 1 - edges.prod() / ordinary_edges.prod();
  if (saved > least_saved) {
    report.account = fmt::format("after an exchange of sizes that took {:.1f} % off the {} that they need",
                                 100 * saved, D == 2 ? "area" : "volume");
  } else {
    report.account = end == StageEnd::cancelled ? "without the exchange of sizes, which was not finished"
                                                : "without an exchange of sizes, which found nothing denser";
    spheres = ordinary;
    edges = ordinary_edges;
  }
  return end;
}

template <int D>
StageEnd relax_in(SpheresInBox& in_box, Reporter& report, const Relax& options) {
  const bool by_the_book = options.method != RelaxMethod::fast;
  if (!in_box.task.walls.empty() && by_the_book)
    throw Error(ErrorCode::bad_scene, "the reference method of relax knows no walls; leave \"method\" out");
  Spheres<D> spheres = in_box.spheres.in<D>();
  have_places(spheres);
  if (!in_box.placed && in_box.begun == 0) forget_places(in_box.spheres.x);  // for there are none yet
  Vector<D> edges = in_box.edges;
  enum class Step { place, push, exchange, finish } step = Step::place;
  StageEnd end = StageEnd::converged;
  int starts = 1;
  const bool loose_box = is_loose(in_box);
  const auto finish = [&] {
    step = Step::finish;
    const double polish_to = loose_box ? 0 : options.polish;
    // While it is polished, a checkpoint has what that began with.
    end = finish_in_periodic_box<D>(polish_to > 0 ? spheres : std::move(spheres), edges, end, polish_to,
                                    in_box, report);
    return loose_box ? end_in_larger_box(end, options.polish, report) : end;
  };
  Vector<D> start = edges;
  const Resumable part(report, "relax", [&](Archive& a) {
    a(step, end, starts, start, edges, in_box.edges);
    if (step >= Step::exchange) a(spheres);  // before that, engines have their places
  });
  if (!part.resumed() && is_done<D>(spheres, edges, in_box, options)) return finish();
  if (!part.resumed()) start = edges_to_start_from(in_box, options);
  if (!part.resumed() && begins_in_its_box(in_box, options) &&
      hardly_overlaps<D>(spheres, edges, in_box, options)) {
    free_of_overlap<D>(spheres, edges, in_box.task, report);
    step = Step::exchange;
  }
  if (step == Step::place) {
    end = place<D>(spheres, edges, start, in_box, report, options);
    step = Step::push;
  }
  for (const int most_starts = loose_box ? most_starts_in_a_loose_box : 1; step == Step::push; ++starts) {
    in_box.edges = edges;
    if (end == StageEnd::converged) end = push_apart<D>(spheres, edges, in_box, report, options);
    free_of_overlap<D>(spheres, edges, in_box.task, report);
    if (end != StageEnd::converged || starts == most_starts ||
        lies_within<D>(spheres, edges, *in_box.task.target_edges))
      step = Step::exchange;
    else
      resize_box<D>(spheres, edges, start, is_tilted(in_box.task.domain));
  }
  if (step == Step::exchange && options.exchange && end == StageEnd::converged && !loose_box)
    end = exchange_sizes<D>(spheres, edges, in_box, report, options);
  return finish();
}

}  // namespace

int sweeps_a_cycle(const Relax& options, std::size_t spheres) {
  if (options.period) return *options.period;
  const double decades = std::log10(static_cast<double>(spheres));
  return std::max(1, static_cast<int>(std::lround(options.alpha * decades * decades)));
}

StageEnd relax(const Relax& options, SpheresInBox& in_box, Reporter& report) {
  EffectTimer timer(report.effects["relaxation"]);
  return with_dimension(in_box.dimension(), EveryDimension{}, [&](auto dimension) {
    return relax_in<decltype(dimension)::value>(in_box, report, options);
  });
}

}  // namespace bernal
