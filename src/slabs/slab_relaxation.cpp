#include "slabs/slab_relaxation.hpp"

#include <algorithm>
#include <utility>

#include "soft/soft_packing.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace {

/// So many at most in one visit.
constexpr int sweeps_a_visit = 64;
/// Of radii: so far a sphere may move in a visit and still meet whom it comes to.
constexpr double room_to_move = 1;

}  // namespace

SlabPacking::SlabPacking(SlabStore& store, const Vector<3>& edges, double largest, double mean,
                         std::function<void()> look)
    : store_(store),
      edges_(edges),
      width_(SoftPacking::farthest_neighbor(largest, mean) + room_to_move * largest),
      look_(std::move(look)) {}

void SlabPacking::sweep(float omega) {
  omega_ = omega;
  if (++due_ == sweeps_a_visit) visit_all(false);
}

double SlabPacking::sweep_to_overlap(float omega) {
  omega_ = omega;
  ++due_;
  return visit_all(true);
}

double SlabPacking::visit_all(bool measure) {
  const int sweeps = std::exchange(due_, 0);
  double largest = 0;
  for (int first = 0; first < 2; ++first)
    for (int s = first; s < store_.size(); s += 2) {
      look_();
      largest = std::max(largest, visit(s, sweeps, measure));
    }
  return largest;
}

double SlabPacking::visit(int slab, int sweeps, bool measure) {
  if (store_.spheres(slab) == 0) return 0;
  SlabSurroundings here = surroundings(store_, slab, edges_, width_);
  Spheres<3>& spheres = here.spheres;
  SoftPacking packing(spheres, here.edges, soft_kernels().front(), false, spheres.size() - here.own);
  for (std::vector<double>& column : spheres.x) std::vector<double>().swap(column);  // the engine has them
  packing.wear_lists(wear_);
  for (int k = 0; k + 1 < sweeps; ++k) packing.sweep(omega_);
  double largest = 0;
  if (measure)
    largest = packing.sweep_to_overlap(omega_);
  else
    packing.sweep(omega_);
  lists_built_.calls += packing.lists_built().calls;
  lists_built_.seconds += packing.lists_built().seconds;
  spheres.resize(spheres.r.size());
  packing.write_to(spheres);
  const int axis = store_.axis();
  store_.rewrite(slab, [&](std::uint64_t i, SlabSphere& sphere) {
    for (int k = 0; k < 3; ++k) {
      const auto column = static_cast<std::size_t>(k);
      sphere.at[column] = spheres.x[column][i] / edges_[k] + (k == axis ? here.origin : 0);
    }
  });
  return largest;
}

double contact_factor_of(const SlabStore& store, const Vector<3>& edges, double largest,
                         const std::function<void()>& look) {
  // Pairs farther apart than this are 0.8 of their distance at most.
  constexpr double least_factor = 0.8;
  const double width = 2 / least_factor * largest;
  double factor = std::max(least_factor, 2 * largest / edges.minCoeff());
  for (int s = 0; s < store.size(); ++s) {
    if (store.spheres(s) == 0) continue;
    look();
    const SlabSurroundings here = surroundings(store, s, edges, width, width);
    factor = std::max(factor, contact_factor<3>(here.spheres, here.edges));
  }
  return factor;
}

}  // namespace bernal
