#include "soft/device_packing.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"
#include "soft/fixed_point_grid.hpp"
#include "soft/soft_packing.hpp"

namespace bernal {
namespace {

constexpr std::size_t places_a_range = 1 << 14;

}  // namespace

DevicePacking::DevicePacking(const Spheres<3>& spheres, const Vector<3>& edges,
                             std::unique_ptr<DeviceSpheres> device)
    : device_(std::move(device)),
      count_(spheres.size()),
      edges_{edges[0], edges[1], edges[2]},
      life_(static_cast<float>(SoftPacking::usual_skin(spheres.r))) {
  const double largest = std::ranges::max(spheres.r);
  const double least = DeviceSpheres::fewest_cells * 2.001 * (largest + static_cast<double>(life_.skin()));
  if (edges.minCoeff() < least)
    throw Error(ErrorCode::bad_scene,
                fmt::format("the box is {:.3g} of its largest diameters wide as relaxation begins, and a GPU "
                            "needs {:.3g}; leave \"device\" out, and the processor packs",
                            edges.minCoeff() / (2 * largest), least / (2 * largest)));
  largest_ = static_cast<float>(largest);
  std::vector<SoftSphere> fixed(count_);
  parallel_ranges(count_, places_a_range, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        fixed[i].x[k] = static_cast<std::int32_t>(to_fixed(spheres.x[k][i], edges_[k]));
      fixed[i].r = static_cast<float>(spheres.r[i]);
    }
  });
  device_->put(fixed);
}

void DevicePacking::sweep(float omega) {
  keep_lists_valid(false);
  device_->sweep(scale_of(edges_), omega);
  life_.swept();
}

double DevicePacking::sweep_to_overlap(float omega) {
  life_.look_soon();  // what is measured is measured on lists that are known to be good
  keep_lists_valid(true);
  const float largest = device_->sweep_to_overlap(scale_of(edges_), omega);
  life_.swept();
  return static_cast<double>(largest);
}

void DevicePacking::grow(double factor) {
  for (double& edge : edges_) edge *= factor;
  if (factor < 1) life_.end();  // spheres that were not near each other may be now
}

void DevicePacking::keep_lists_valid(bool for_all) {
  life_.keep(
      for_all, lists_built_.calls > 0,
      [&] { return FarthestMoves::of_parts(device_->squares_moved(scale_of(edges_), FarthestMoves::part)); },
      [&] { build_lists(); });
}

void DevicePacking::build_lists() {
  device_->wait();  // for sweeps, whose time is not that of lists
  const EffectTimer timer(lists_built_);
  edges_then_ = edges_;
  device_->build(edges_, largest_, life_.skin());
  device_->wait();
}

void DevicePacking::write_to(Spheres<3>& spheres, Vector<3>& edges) const {
  const std::vector<SoftSphere> fixed = device_->get();
  for (int k = 0; k < 3; ++k) edges[k] = edges_[static_cast<std::size_t>(k)];
  parallel_ranges(count_, places_a_range, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        spheres.x[k][i] = static_cast<std::uint32_t>(fixed[i].x[k]) * (edges_[k] * 0x1p-32);
  });
}

void DevicePacking::archive(Archive& a) {
  std::vector<SoftSphere> now = a.reads() ? std::vector<SoftSphere>() : device_->get();
  a(edges_, life_, lists_built_, now);
  if (a.reads()) device_->put(now);
  if (lists_built_.calls == 0) return;
  std::vector<SoftSphere> then = a.reads() ? std::vector<SoftSphere>() : device_->built_at();
  a(edges_then_, then);
  if (a.reads()) device_->build_of(then, edges_then_, largest_, life_.skin());
}

}  // namespace bernal
