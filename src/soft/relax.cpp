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
#include "soft/size_exchange.hpp"
#include "soft/soft_engine.hpp"
#include "work/free_of_overlap.hpp"
#include "work/random_insertion.hpp"
#include "work/stage_entry.hpp"

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

bool is_loose(const Work& work) {
  return work.target_edges && work.volume_of_spheres() < loose * random_close_packing[work.dimension() - 1] *
                                                             work.target_edges->prod();
}

/// Whether the spheres of a start have places, and nothing asks for others.
bool begins_as_it_is(const Work& work, const Relax& options) {
  return work.begun > 0 && work.placed && !options.phi0;
}

/// Whether spheres are as dense where they begin as relaxation makes them: then they are relaxed from there,
/// and not from a denser state, which would make another packing of them.
bool begins_in_its_box(const Work& work, const Relax& options) {
  return begins_as_it_is(work, options) &&
         work.volume_of_spheres() >= loose * random_close_packing[work.dimension() - 1] * work.edges.prod();
}

/// Whether they begin in the box that is asked for, free of overlap.
template <int D>
bool is_done(const Spheres<D>& spheres, const Vector<D>& edges, const Work& work, const Relax& options) {
  return begins_as_it_is(work, options) && work.target_edges && work.edges == *work.target_edges &&
         is_free_of_overlap<D>(spheres, edges, work.walls);
}

/// Whether sizes are wide and spheres are to be as dense as they can.
bool begins_from_largest(const Work& work, const Relax& options) {
  const bool there = work.placed || work.begun > 0;
  return is_for_wide_sizes(work.fill_task, options) && !there && !is_loose(work) &&
         options.phi0.value_or(1) >= std::min(dense_start(work.dimension()), work.fill_task.attainable);
}

/// Those they begin in, or of phi0, or about those that are asked for; never so small that a sphere overlaps
/// its own image.
Vector<dynamic> edges_to_start_from(const Work& work, const Relax& options) {
  const int dimension = work.dimension();
  const double usual = dense_start(dimension);
  double phi0 = options.phi0.value_or(usual);
  if (phi0 == usual && begins_from_largest(work, options)) phi0 = wide_start(work.fill_task);
  const auto with_volume = [&](double volume) -> Vector<dynamic> {
    return work.edges * std::pow(volume / work.edges.prod(), 1.0 / dimension);
  };
  Vector<dynamic> edges = with_volume(work.volume_of_spheres() / phi0);
  if (begins_in_its_box(work, options)) {
    edges = work.edges;
  } else if (work.target_edges) {
    const double asked = work.target_edges->prod();
    if (is_loose(work) || edges.prod() > asked) edges = with_volume((1 - room_to_grow) * asked);
  }
  const double needed = 2 * std::ranges::max(work.spheres.r) / edges.minCoeff();
  return needed > 1 ? Vector<dynamic>(edges * (needed * (1 + 4 * tolerance::roundoff))) : edges;
}

/// Places for spheres that have none. Those of others are moved by nothing that matters, so that a lattice or
/// a line of spheres does not last for ever.
template <int D>
StageEnd place(Spheres<D>& spheres, Vector<D>& edges, const Vector<D>& start, Work& work,
               const Relax& options) {
  if constexpr (D == 2 || D == 3)
    if (begins_from_largest(work, options)) {
      work.edges = edges = start;
      return place_from_largest<D>(spheres, edges, work, options);
    }
  Random random = work.random(Stream::relax);
  const std::size_t there = work.placed ? spheres.size() : work.begun;
  if (there == 0) {
    edges = start;
  } else {
    resize_box<D>(spheres, edges, start);
    displace_at_random<D>(spheres, edges, work.walls, first_jitter * std::ranges::max(spheres.r), random);
  }
  place_at_random<D>(spheres, edges, random, there);
  return StageEnd::converged;
}

/// Whether growing the box by the overlap that counts as none is all that there is to do.
template <int D>
bool hardly_overlaps(const Spheres<D>& spheres, const Vector<D>& edges, const Work& work,
                     const Relax& options) {
  const Vector<D> free = edges_free_of_overlap<D>(spheres, edges, 0, work.walls);
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
/// In four dimensions and more, and between walls, `NeighborRelaxation` sweeps one sphere after the other, on
/// lists for one size.
///
/// `overlap` is the largest overlap ratio at the start; 1 where it is not known. Preconditions and results
/// are those of `relax_by_the_book`. Cost: about 13 ns a sphere and sweep, lists included; 0.07 µs in four
/// dimensions and 0.13 µs in eight, lists not included.
template <int D>
StageEnd relax_fast(Spheres<D>& spheres, Vector<D>& edges, Work& work, const Relax& options, double overlap) {
  const GrowingBox box{.stop = least_overlap(options, work.allowed_overlap),
                       .sweeps = sweeps_a_cycle(options, std::min(spheres.size(), enough_for_sweeps)),
                       .beta = options.beta};
  const auto grow = [&](auto& packing) {
    return let_box_grow<D>(packing, spheres, edges, work, box, {.molr = overlap}, 0,
                           [](int, double molr) { return molr; });
  };
  if constexpr (D == 3)
    if (options.device == RelaxDevice::gpu) {
      DevicePacking packing(spheres, edges, spheres_on_gpu());
      const StageEnd end = grow(packing);
      work.account = "on " + packing.device_name();
      return end;
    }
  SoftEngine<D> packing(spheres, edges, work.walls);
  return grow(packing);
}

/// `overlap` is the largest overlap ratio at the start, where it is known.
template <int D>
StageEnd push_apart(Spheres<D>& spheres, Vector<D>& edges, Work& work, const Relax& options,
                    std::optional<double> overlap = {}) {
  have_places(spheres);
  if constexpr (D == 2 || D == 3)
    if (is_for_wide_sizes(work.fill_task, options))
      return relax_wide<D>(spheres, edges, work, options, overlap.value_or(1),
                           !overlap && begins_from_largest(work, options) ? share_of_placing : 0);
  return options.method == RelaxMethod::fast
             ? relax_fast<D>(spheres, edges, work, options, overlap.value_or(1))
             : relax_by_the_book<D>(spheres, edges, work, options);
}

/// Takes spheres that just do not overlap to a denser packing of the same sizes, if that is found.
template <int D>
StageEnd exchange_sizes(Spheres<D>& spheres, Vector<D>& edges, Work& work, const Relax& options) {
  EffectTimer timer(work.effects["exchange"]);
  Spheres<D> ordinary = spheres;
  Vector<D> ordinary_edges = edges;
  const bool wide = is_for_wide_sizes(work.fill_task, options);
  bool exchanged = false;
  std::optional<double> overlap;
  const Resumable part(work, "exchange", [&](Archive& a) {
    a(exchanged, overlap);
    if (exchanged) a(ordinary, ordinary_edges, spheres, edges);
  });
  if (!exchanged) overlap = exchange_in_box<D>(spheres, edges, wide, work);
  exchanged = true;
  if (!overlap) {
    work.account = "without an exchange of sizes: they are equal or too far apart";
    return StageEnd::converged;
  }
  const StageEnd end = push_apart<D>(spheres, edges, work, options, overlap);
  free_of_overlap<D>(spheres, edges, work);
  const double saved = 1 - edges.prod() / ordinary_edges.prod();
  if (saved > least_saved) {
    work.account = fmt::format("after an exchange of sizes that took {:.1f} % off the {} that they need",
                               100 * saved, D == 2 ? "area" : "volume");
  } else {
    work.account = end == StageEnd::cancelled ? "without the exchange of sizes, which was not finished"
                                              : "without an exchange of sizes, which found nothing denser";
    spheres = ordinary;
    edges = ordinary_edges;
  }
  return end;
}

template <int D>
StageEnd relax_in(Work& work, const Relax& options) {
  const bool by_the_book = options.method != RelaxMethod::fast;
  if (!work.walls.empty() && by_the_book)
    throw Error(ErrorCode::bad_scene, "the reference method of relax knows no walls; leave \"method\" out");
  Spheres<D> spheres = work.spheres.in<D>();
  have_places(spheres);
  if (!work.placed && work.begun == 0) forget_places(work.spheres.x);  // for there are none yet
  Vector<D> edges = work.edges;
  enum class Step { place, push, exchange, finish } step = Step::place;
  StageEnd end = StageEnd::converged;
  int starts = 1;
  const bool loose_box = is_loose(work);
  const auto finish = [&] {
    step = Step::finish;
    const double polish_to = loose_box ? 0 : options.polish;
    // While it is polished, a checkpoint has what that began with.
    end =
        finish_in_periodic_box<D>(polish_to > 0 ? spheres : std::move(spheres), edges, end, polish_to, work);
    return loose_box ? end_in_larger_box(end, options.polish, work) : end;
  };
  Vector<D> start = edges;
  const Resumable part(work, "relax", [&](Archive& a) {
    a(step, end, starts, start, edges, work.edges);
    if (step >= Step::exchange) a(spheres);  // before that, engines have their places
  });
  if (!part.resumed() && is_done<D>(spheres, edges, work, options)) return finish();
  if (!part.resumed()) start = edges_to_start_from(work, options);
  if (!part.resumed() && begins_in_its_box(work, options) &&
      hardly_overlaps<D>(spheres, edges, work, options)) {
    free_of_overlap<D>(spheres, edges, work);
    step = Step::exchange;
  }
  if (step == Step::place) {
    end = place<D>(spheres, edges, start, work, options);
    step = Step::push;
  }
  for (const int most_starts = loose_box ? most_starts_in_a_loose_box : 1; step == Step::push; ++starts) {
    work.edges = edges;
    if (end == StageEnd::converged) end = push_apart<D>(spheres, edges, work, options);
    free_of_overlap<D>(spheres, edges, work);
    if (end != StageEnd::converged || starts == most_starts ||
        lies_within<D>(spheres, edges, *work.target_edges))
      step = Step::exchange;
    else
      resize_box<D>(spheres, edges, start);
  }
  if (step == Step::exchange && options.exchange && end == StageEnd::converged && !loose_box)
    end = exchange_sizes<D>(spheres, edges, work, options);
  return finish();
}

}  // namespace

int sweeps_a_cycle(const Relax& options, std::size_t spheres) {
  if (options.period) return *options.period;
  const double decades = std::log10(static_cast<double>(spheres));
  return std::max(1, static_cast<int>(std::lround(options.alpha * decades * decades)));
}

StageEnd relax(Work& work, const Relax& options) {
  EffectTimer timer(work.effects["relaxation"]);
  return with_dimension(work.dimension(), EveryDimension{},
                        [&](auto dimension) { return relax_in<decltype(dimension)::value>(work, options); });
}

}  // namespace bernal
