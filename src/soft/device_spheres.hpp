#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "soft/soft_kernels.hpp"

namespace bernal {

/// Overlapping spheres on another processor than this, in its own memory, and their sweeps: what
/// `DevicePacking` asks for. Three dimensions, a periodic box. All that is asked for is a function of the
/// spheres alone.
class DeviceSpheres {
 public:
  virtual ~DeviceSpheres() = default;

  /// "NVIDIA H100 80GB HBM3"
  virtual std::string name() const = 0;
  /// In the order of their numbers.
  virtual void put(const std::vector<SoftSphere>& spheres) = 0;
  virtual std::vector<SoftSphere> get() const = 0;
  /// Where they were when lists were built.
  virtual std::vector<SoftSphere> built_at() const = 0;

  /// Sorts them into cells and finds their neighbours: those with gaps below twice the skin. Preconditions:
  /// that of `fewest_cells`; no radius is above `largest`.
  virtual void build(const std::array<double, 3>& edges, float largest, float skin) = 0;
  /// Takes those places instead of the present ones, builds lists of them, and then the present ones again.
  virtual void build_of(const std::vector<SoftSphere>& then, const std::array<double, 3>& edges,
                        float largest, float skin) = 0;
  /// Each sphere once, as `SoftKernels::Sweep` says, in another order.
  virtual void sweep(const std::array<float, 3>& scale, float omega) = 0;
  /// The same; the largest overlap ratio that was met.
  virtual float sweep_to_overlap(const std::array<float, 3>& scale, float omega) = 0;
  /// The squares of the farthest moves since lists were built, of each `part` spheres that follow each
  /// other in some order.
  virtual std::vector<float> squares_moved(const std::array<float, 3>& scale, std::uint32_t part) const = 0;
  /// What a sweep has to read from memory and to write to it at least, for a sphere, by the lists at hand.
  virtual double bytes_a_sweep() const = 0;
  /// Returns when all that was asked for is done.
  virtual void wait() const = 0;

  /// Cells along an axis, each as wide as neighbours may be apart, below which cells meet their own images.
  static constexpr int fewest_cells = 4;
};

/// Throws Error{bad_scene} where `spheres_on_gpu` would.
void require_gpu();
/// On the first NVIDIA GPU. Throws Error{bad_scene} where bernal was built without CUDA, or none is there.
std::unique_ptr<DeviceSpheres> spheres_on_gpu();

}  // namespace bernal
