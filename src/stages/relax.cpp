#include "stages/relax.hpp"

#include <algorithm>
#include <cmath>

#include "bernal/core/dimension.hpp"
#include "stages/free_of_overlap.hpp"
#include "stages/relax_fast.hpp"
#include "stages/relax_reference.hpp"
#include "stages/resize_box.hpp"

namespace bernal {
namespace {

/// 0.9 of random close packing of equal spheres, by dimension: up to here any spheres find places free of
/// overlap in a given box.
constexpr double loose[] = {0.89, 0.756, 0.576, 0.414, 0.279, 0.18, 0.107, 0.062};
/// How much smaller than the edges that are asked for those of such a start are: the box grows while it
/// relaxes.
constexpr double room_to_grow = 0.01;
/// Moves, in mean radii, that break the symmetry of spheres which come in a lattice or in line.
constexpr double jitter = 1e-6;

double volume_of_spheres(const PeriodicWork& work) {
  double sum = 0;
  for (const double r : work.spheres.r) sum += ball_volume(work.dimension(), r);
  return sum;
}

/// Those of phi0, or about those that are asked for; never so small that a sphere overlaps its own image.
Vector<dynamic> edges_to_start_from(const PeriodicWork& work, double phi0) {
  const double filled = volume_of_spheres(work);
  Vector<dynamic> edges = work.edges * std::pow(filled / phi0 / work.edges.prod(), 1.0 / work.dimension());
  if (work.target_edges) {
    const double asked = work.target_edges->prod();
    const bool is_loose = filled < loose[work.dimension() - 1] * asked;
    if (is_loose || edges.prod() > asked) edges = *work.target_edges * (1 - room_to_grow);
  }
  const double needed = 2 * std::ranges::max(work.spheres.r) / edges.minCoeff();
  return needed > 1 ? Vector<dynamic>(edges * (needed * (1 + 4 * tolerance::roundoff))) : edges;
}

template <int D>
void place_at_random(Spheres<D>& spheres, const Vector<D>& edges, Random random) {
  const Bounds<D> bounds{Vector<D>::Zero(), edges};
  for (std::size_t i = 0; i < spheres.size(); ++i) spheres.set_center(i, uniform_point(random, bounds));
}

template <int D>
void shake(Spheres<D>& spheres, const Vector<D>& edges, double length, Random random) {
  const Boundary<D> boundary{edges};
  for (std::size_t i = 0; i < spheres.size(); ++i)
    spheres.set_center(i, boundary.wrap(spheres.center(i) + length * uniform_direction<D>(random)));
}

/// Spheres and box as the methods want them: overlapping.
template <int D>
void prepare(Spheres<D>& spheres, Vector<D>& edges, PeriodicWork& work, const RelaxOptions& options) {
  const Vector<D> start = edges_to_start_from(work, options.phi0);
  if (work.placed) {
    resize_box<D>(spheres, edges, start);
    shake<D>(spheres, edges, jitter * std::ranges::max(spheres.r), work.random(Stream::relax));
  } else {
    edges = start;
    place_at_random<D>(spheres, edges, work.random(Stream::relax));
  }
}

/// Grows the box until nothing overlaps more than is allowed, and further to the edges that are asked for.
template <int D>
void finish(Spheres<D>& spheres, Vector<D>& edges, PeriodicWork& work) {
  Vector<D> free = edges_free_of_overlap<D>(spheres, edges, work.allowed_overlap);
  while (!free.allFinite()) {  // cancelled while centres coincide
    shake<D>(spheres, edges, 1e-3 * std::ranges::max(spheres.r), work.random(Stream::relax));
    free = edges_free_of_overlap<D>(spheres, edges, work.allowed_overlap);
  }
  resize_box<D>(spheres, edges, free);
  work.needed_volume = edges.prod();
  if (!work.target_edges) return;
  const Vector<D> target = *work.target_edges;
  const double rounding = tolerance::growth(target.maxCoeff() / std::ranges::min(spheres.r));
  if ((target.array() >= edges.array() * (1 + rounding)).all()) resize_box<D>(spheres, edges, target);
}

template <int D>
StageEnd push_apart(Spheres<D>& spheres, Vector<D>& edges, PeriodicWork& work, const RelaxOptions& options) {
  if constexpr (D <= 3) {
    if (!options.reference && fast_path_exists<D>(spheres, edges))
      return relax_fast<D>(spheres, edges, work, options);
  }
  return relax_by_the_book<D>(spheres, edges, work, options);
}

template <int D>
StageEnd relax_in(PeriodicWork& work, const RelaxOptions& options) {
  Spheres<D> spheres = work.spheres.in<D>();
  Vector<D> edges = work.edges;
  prepare<D>(spheres, edges, work, options);
  const StageEnd end = push_apart<D>(spheres, edges, work, options);
  finish<D>(spheres, edges, work);
  work.spheres = std::move(spheres);
  work.edges = edges;
  work.placed = true;
  return end;
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
