#include "soft/ground.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/every_dimension.hpp"
#include "core/order.hpp"
#include "work/free_of_overlap.hpp"
#include "work/holes.hpp"

namespace bernal {
namespace {

constexpr double largest_margin = 0.01;
/// The share of the margin by which walls push less, if spheres are snug between them.
constexpr double relief_where_snug = 0.95;
/// The number of random places that are tried to find holes: for each sphere or for each hole, whichever is
/// less in total, and the least number.
constexpr double probes_a_sphere = 2, probes_a_hole = 1000, least_probes = 1000;

/// At least a hundred times the resolution, which is in smallest radii.
double margin_for(double resolution) { return std::max(1e-4, 100 * resolution); }

}  // namespace

void require_resolution(double resolution) {
  if (margin_for(resolution) <= largest_margin) return;
  throw Error(ErrorCode::bad_scene,
              fmt::format("spheres {:.0e} times smaller than the container cannot be relaxed in it; name "
                          "other stages, such as \"insert\" and \"compress\"",
                          std::exp2(32) * resolution));
}

void ContainerGround::place(const Spheres<3>& spheres) {
  if (packing_) {
    lists_built_ += packing_->lists_built();
  }
  packing_ = std::make_unique<SoftPacking>(spheres, *container_, soft_kernels().front(), by_octaves_);
  if (margin_ == 0) {
    const double resolution = packing_->resolution() / std::ranges::min(spheres.r);
    require_resolution(resolution);
    least_margin_ = margin_for(resolution);
    margin_ = std::max(least_margin_, first_margin_);
  }
  if (snug_) packing_->relieve_walls(relief_where_snug * margin_ * std::ranges::max(spheres.r));
  packing_->swell(1 + margin_);
}

bool ContainerGround::narrow_margin() {
  if (margin_ == least_margin_) return false;
  margin_ = std::max(least_margin_, 0.5 * margin_);
  swell(1);
  return true;
}

void ContainerGround::move_to_holes(Spheres<3>& spheres, std::vector<std::uint32_t> ids, Random& random) {
  sort_largest_first(ids, spheres.r);
  std::vector<double> radii;
  for (const std::uint32_t i : ids) radii.push_back(spheres.r[i]);
  const std::vector<Vector<3>> holes = holes_for(radii, spheres, random);
  std::vector<SoftPacking::Move> moves;
  for (std::size_t k = 0; k < holes.size(); ++k) {
    spheres.set_center(ids[k], holes[k]);
    moves.push_back({ids[k], holes[k]});
  }
  packing_->put(moves);
}

std::vector<Vector<3>> ContainerGround::holes_for(std::span<const double> radii, const Spheres<3>& spheres,
                                                  Random& random) const {
  const auto probes =
      static_cast<std::size_t>(least_probes + std::min(probes_a_sphere * static_cast<double>(spheres.size()),
                                                       probes_a_hole * static_cast<double>(radii.size())));
  std::vector<Vector<3>> places;
  for (const Hole& hole : bernal::holes_for(radii, *container_, *places_, spheres, probes, random))
    places.push_back(hole.place);
  return places;
}

template <int D>
void BoxGround<D>::place(const Spheres<D>& spheres) {
  if (engine_) lists_built_ += engine_->lists_built();
  if (margin_ == 0) {
    const double resolution = 0x1p-32 * edges_.maxCoeff() / std::ranges::min(spheres.r);
    margin_ = std::min(margin_for(resolution), largest_margin);
  }
  Spheres<D> shrunk = spheres;
  for (double& r : shrunk.r) r *= 1 - allowed_;
  Vector<D> edges = edges_;
  resize_box<D>(shrunk, edges, edges_ / (1 + margin_));
  engine_.emplace(shrunk, edges, walls_, 1 / (1 - allowed_));
}

template <int D>
void BoxGround<D>::read_places(Spheres<D>& spheres) const {
  Vector<D> edges;
  engine_->write_to(spheres, edges);
  resize_box<D>(spheres, edges, edges_);
}

template <int D>
void BoxGround<D>::move_to_holes(Spheres<D>& spheres, std::vector<std::uint32_t> ids, Random& random) {
  bernal::move_to_holes<D>(spheres, edges_, std::move(ids), random, walls_);
  place(spheres);
}

#define BERNAL_INSTANTIATE(D) template class BoxGround<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
