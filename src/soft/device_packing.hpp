#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "core/archive.hpp"
#include "soft/device_spheres.hpp"
#include "soft/list_life.hpp"
#include "work/effect_log.hpp"

namespace bernal {

/// The relaxation of `SoftPacking` on another processor, in a periodic box of three dimensions: the same
/// steps in another order of the spheres. So it makes another packing of the same kind; every device makes
/// the same packing. `SoftPacking` says what the calls do.
class DevicePacking {
 public:
  /// Centres in [0, edge). Throws Error{bad_scene} if the box is narrower than `fewest_cells` cells, some 12
  /// radii of equal spheres.
  DevicePacking(const Spheres<3>& spheres, const Vector<3>& edges, std::unique_ptr<DeviceSpheres> device);

  void wear_lists(double wear) { life_.wear(wear); }
  void sweep(float omega);
  double sweep_to_overlap(float omega);
  void grow(double factor);
  void write_to(Spheres<3>& spheres, Vector<3>& edges) const;
  const Effect& lists_built() const { return lists_built_; }
  std::string device_name() const { return device_->name(); }

  /// Builds the lists even if they are still valid. `sweep` builds them when necessary.
  void build_lists();
  /// Returns when all sweeps are done; `sweep` only starts them.
  void wait() const { device_->wait(); }
  /// Bytes a sphere, see `ColouredSpheres`.
  double bytes_a_sweep() const { return device_->bytes_a_sweep(); }

  void archive(Archive& a);

 private:
  void keep_lists_valid(bool for_all);

  std::unique_ptr<DeviceSpheres> device_;
  std::size_t count_;
  float largest_ = 0;
  std::array<double, 3> edges_, edges_then_{};  // when lists were built
  ListLife life_;
  Effect lists_built_{"neighbour lists", 0, 0};
};

}  // namespace bernal
