#include "soft/box_ground.hpp"

#include <algorithm>

#include "core/every_dimension.hpp"
#include "soft/fixed_point.hpp"
#include "work/periodic_holes.hpp"
#include "work/resize_box.hpp"

namespace bernal {
template <int D>
BoxGround<D>::BoxGround(const Vector<D>& edges, double allowed, std::vector<bool> walls)
    : edges_(edges), allowed_(allowed), walls_(std::move(walls)) {}

template <int D>
void BoxGround<D>::place(const Spheres<D>& spheres) {
  if (engine_) list_builds_ = list_builds();
  if (margin_ == 0) {
    const double resolution = 0x1p-32 * edges_.maxCoeff() / std::ranges::min(spheres.r);
    margin_ = std::clamp(resolutions_a_margin * resolution, least_margin, largest_margin);
  }
  Spheres<D> shrunk = spheres;
  for (double& r : shrunk.r) r *= 1 - allowed_;
  Vector<D> edges = edges_;
  resize_box<D>(shrunk, edges, edges_ / (1 + margin_));
  engine_.emplace(shrunk, edges, burst_swelling, walls_, 1 / (1 - allowed_));
}

template <int D>
void BoxGround<D>::read_places(Spheres<D>& spheres) const {
  Vector<D> edges;
  engine_->write_to(spheres, edges);
  resize_box<D>(spheres, edges, edges_);
}

template <int D>
void BoxGround<D>::swell(double factor) {
  engine_->grow(factor == 1 ? burst_swelling : 1 / factor);
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
