#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "soft/soft_lists.hpp"

namespace bernal {

/// Overlapping spheres in a periodic box of one, two or three dimensions that push each other apart: the
/// state of the fast relaxation. In single precision and fixed point: overlap ratios are good to about 1e-6.
class SoftPacking {
 public:
  /// Centres in [0, edge). Precondition: every edge is at least `smallest_edge` of the radii, and will be.
  template <int D>
  SoftPacking(const Spheres<D>& spheres, const Vector<D>& edges, const SoftKernels& kernels);

  /// The least edge that this way of finding neighbours allows.
  static double smallest_edge(const std::vector<double>& radii);

  /// Every sphere is moved once, by min(omega / n, 1) times the sum of its n overlaps. Parallel where there
  /// are many spheres; the same bits for any number of threads.
  void sweep(float omega);
  /// The same; returns the largest overlap ratio that was met.
  double sweep_and_measure(float omega);

  /// The box and the distances grow; the radii do not.
  void grow(double factor);

  template <int D>
  void write_to(Spheres<D>& spheres, Vector<D>& edges) const;

  /// How often lists were built.
  std::uint64_t builds() const { return builds_; }

 private:
  template <class Sweep>
  void for_each_chain(const Sweep& sweep) const;
  SweepTask task(float omega);
  void keep_lists_valid();
  double largest_move() const;

  const SoftKernels& kernels_;
  std::size_t count_;
  int dimension_;
  std::array<double, 3> edges_;
  SoftLists lists_;
  std::vector<SoftSphere> spheres_;  // in sweep order
  std::vector<std::uint32_t> ids_;
  std::vector<SoftSphere> built_at_;  // where they were when the lists were built
  std::uint64_t builds_ = 0;
  double moved_ = 0;  // largest move since then, when it was last looked at
  int sweeps_ = 0;    // since it was last looked at
  int patience_ = 0;  // sweeps until it is looked at again
};

}  // namespace bernal
