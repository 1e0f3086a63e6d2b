#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "soft/soft_kernels.hpp"

namespace bernal {

/// Overlapping spheres in the memory of another processor, and their sweeps, for `DevicePacking`: in three
/// dimensions and a periodic box. All results depend on the spheres only.
class DeviceSpheres {
 public:
  virtual ~DeviceSpheres() = default;

  /// "NVIDIA H100 80GB HBM3"
  virtual std::string name() const = 0;
  /// Spheres are in the order of their numbers in all calls.
  virtual void put(const std::vector<SoftSphere>& spheres) = 0;
  virtual std::vector<SoftSphere> get() const = 0;
  /// The spheres as they were when the lists were built.
  virtual std::vector<SoftSphere> built_at() const = 0;

  /// Sorts the spheres into cells and finds their neighbours: those across gaps below twice the skin.
  /// Preconditions: the box has `fewest_cells`; no radius is above `largest`.
  virtual void build(const std::array<double, 3>& edges, float largest, float skin) = 0;
  /// Builds the lists of the spheres `then`; the present ones stay.
  virtual void build_of(const std::vector<SoftSphere>& then, const std::array<double, 3>& edges,
                        float largest, float skin) = 0;
  /// Moves each sphere once, as `SoftKernels::Sweep` does, in another order.
  virtual void sweep(const std::array<float, 3>& scale, float omega) = 0;
  /// The same; returns the largest overlap ratio that it met.
  virtual float sweep_to_overlap(const std::array<float, 3>& scale, float omega) = 0;
  /// The squares of the farthest moves since the lists were built, one for each `part` spheres.
  virtual std::vector<float> squares_moved(const std::array<float, 3>& scale, std::uint32_t part) const = 0;
  /// The least number of bytes a sphere that a sweep with the present lists reads from memory and writes to
  /// it.
  virtual double bytes_a_sweep() const = 0;
  /// Returns when all calls are done.
  virtual void wait() const = 0;

  /// The least number of cells along an axis, each as wide as neighbours may be apart. With fewer, cells meet
  /// their own images.
  static constexpr int fewest_cells = 4;
};

/// Throws Error{bad_scene} if `spheres_on_gpu` would.
void require_gpu();
/// Spheres on the first NVIDIA GPU. Throws Error{bad_scene} if bernal was built without CUDA, or none is
/// there.
std::unique_ptr<DeviceSpheres> spheres_on_gpu();

}  // namespace bernal
