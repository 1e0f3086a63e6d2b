#include "soft/relax.hpp"

#include <algorithm>
#include <cmath>

#include "bernal/core/dimension.hpp"
#include "bernal/core/tolerance.hpp"
#include "core/close_packing.hpp"
#include "jam/finish_in_periodic_box.hpp"
#include "soft/relax_fast.hpp"
#include "soft/relax_reference.hpp"
#include "work/resize_box.hpp"

namespace bernal {
namespace {

/// Up to this share of random close packing spheres of any sizes find places free of overlap in a given box; they start in one
/// that is smaller by volume, as it may grow while they relax, and again from where they ended if it grew too
/// far.
constexpr double loose = 0.9;
constexpr double room_to_grow = 0.03;
constexpr int most_starts_in_a_loose_box = 20;
/// Moves, in mean radii, that break the symmetry of spheres which come in a lattice or in line.
constexpr double jitter = 1e-6;

bool is_loose(const PeriodicWork& work) {
  return work.target_edges &&
         work.volume_of_spheres() < loose * random_close_packing[work.dimension() - 1] * work.target_edges->prod();
}

/// Those of phi0, or about those that are asked for; never so small that a sphere overlaps its own image.
Vector<dynamic> edges_to_start_from(const PeriodicWork& work, double phi0) {
  const int dimension = work.dimension();
  const auto with_volume = [&](double volume) -> Vector<dynamic> {
    return work.edges * std::pow(volume / work.edges.prod(), 1.0 / dimension);
  };
  Vector<dynamic> edges = with_volume(work.volume_of_spheres() / phi0);
  if (work.target_edges) {
    const double asked = work.target_edges->prod();
    if (is_loose(work) || edges.prod() > asked) edges = with_volume((1 - room_to_grow) * asked);
  }
  const double needed = 2 * std::ranges::max(work.spheres.r) / edges.minCoeff();
  return needed > 1 ? Vector<dynamic>(edges * (needed * (1 + 4 * tolerance::roundoff))) : edges;
}

template <int D>
void place_at_random(Spheres<D>& spheres, const Vector<D>& edges, Random random) {
  const Bounds<D> bounds{Vector<D>::Zero(), edges};
  for (std::size_t i = 0; i < spheres.size(); ++i) spheres.set_center(i, uniform_point(random, bounds));
}

/// Places for spheres that have none. Those of others are moved by nothing that matters, so that a lattice or
/// a line of spheres does not last for ever.
template <int D>
void place(Spheres<D>& spheres, Vector<D>& edges, const Vector<D>& start, PeriodicWork& work) {
  if (work.placed) {
    resize_box<D>(spheres, edges, start);
    shake<D>(spheres, edges, jitter * std::ranges::max(spheres.r), work.random(Stream::relax));
  } else {
    edges = start;
    place_at_random<D>(spheres, edges, work.random(Stream::relax));
  }
}

template <int D>
StageEnd push_apart(Spheres<D>& spheres, Vector<D>& edges, PeriodicWork& work, const RelaxOptions& options) {
  if (!options.reference && fast_path_exists<D>(spheres, edges))
    return relax_fast<D>(spheres, edges, work, options);
  return relax_by_the_book<D>(spheres, edges, work, options);
}

template <int D>
StageEnd relax_in(PeriodicWork& work, const RelaxOptions& options) {
  Spheres<D> spheres = work.spheres.in<D>();
  Vector<D> edges = work.edges;
  const Vector<D> start = edges_to_start_from(work, options.phi0);
  place<D>(spheres, edges, start, work);

  const int most_starts = is_loose(work) ? most_starts_in_a_loose_box : 1;
  StageEnd end = StageEnd::converged;
  for (int starts = 1;; ++starts) {
    work.edges = edges;
    end = push_apart<D>(spheres, edges, work, options);
    free_of_overlap<D>(spheres, edges, work);
    if (end != StageEnd::converged || starts == most_starts || fits<D>(spheres, edges, *work.target_edges))
      break;
    resize_box<D>(spheres, edges, start);
  }

  const double polish_to = is_loose(work) ? 0 : options.polish;
  return finish_in_periodic_box<D>(std::move(spheres), edges, end, polish_to, work);
}

}  // namespace

int sweeps_a_cycle(double alpha, std::size_t spheres) {
  const double decades = std::log10(static_cast<double>(spheres));
  return std::max(1, static_cast<int>(std::lround(alpha * decades * decades)));
}

StageEnd relax(PeriodicWork& work, const RelaxOptions& options) {
  EffectTimer timer(work.effects["relaxation"]);
  return with_dimension(work.dimension(), EveryDimension{},
                        [&](auto dimension) { return relax_in<decltype(dimension)::value>(work, options); });
}

}  // namespace bernal
