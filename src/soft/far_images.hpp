#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "soft/soft_kernels.hpp"

namespace bernal {

/// The pairs of a box narrower than two of its largest spheres that may overlap not only with their nearest
/// images, which is all that `SoftKernels` know, but with others on the far side of the box, too. Only so
/// large a sphere has such an image: a box that is narrow all ways holds some thirty of those, a thin one may
/// hold nothing else.
///
/// Precondition of all: every edge is at least the largest diameter. So only the images one edge to the other
/// side, along some of the axes, can be that near, and none of a sphere itself.
class FarImages {
 public:
  /// Finds the pairs that may come to overlap in a far image before a sphere has moved by `skin`. Spheres
  /// with a radius of NaN are none. Cost: for each sphere larger than a quarter of the narrowest edge, what
  /// lies around it along the edges that are not narrow.
  void build(const std::vector<SoftSphere>& spheres, const std::array<double, 3>& edges, int dimension,
             double skin);

  bool empty() const { return spheres_.empty(); }

  /// Moves each of them, one after the other, as `SoftKernels::sweep` does, for its far images alone. Where
  /// there is a `squeeze` to fill, adds to that and to `force`. Returns the largest overlap ratio that was
  /// met.
  float push(std::vector<SoftSphere>& spheres, const std::array<double, 3>& edges, float omega,
             float* squeeze, float* force) const;

 private:
  /// A sphere and those whose far images it may overlap, by their places in the order of sweeps.
  struct Large {
    std::uint32_t place;
    std::vector<std::uint32_t> others;
  };
  std::vector<Large> spheres_;
  int dimension_ = 3;
};

}  // namespace bernal
