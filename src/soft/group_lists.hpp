#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "soft/soft_kernels.hpp"
#include "soft/sweep_order.hpp"

namespace bernal {

/// The spheres of a region by the cells of a background grid, one level of it for every octave of radii, for
/// the search for neighbours.
class RegionCells {
 public:
  /// Sorts the spheres of the region, each named by its index here; those with a radius of NaN are left out.
  /// Cost: some 10 ns a sphere.
  void sort(std::span<const SoftSphere> spheres, const SoftRegion& region, const std::array<double, 3>& edges,
            const SoftSizes& sizes, float skin);

  /// Good until they are sorted anew.
  SearchTask task() const;
  std::size_t size() const { return places_.size(); }

 private:
  void choose_levels(std::span<const SoftSphere> spheres, const SoftSizes& sizes);

  SoftRegion region_;
  std::array<double, 3> edges_{};
  float skin_ = 0;
  std::vector<SoftLevel> levels_;
  std::vector<std::uint32_t> cell_;   // of each sphere
  std::vector<std::uint32_t> start_;  // of each cell of all levels
  std::vector<std::int32_t> x_, y_, z_;
  std::vector<float> r_;
  std::vector<std::uint32_t> places_;
};

/// The neighbours of the spheres of a group, with room for as many as there may be: memory that is never
/// touched costs nothing.
class FoundNeighbors {
 public:
  /// Room for so many a sphere.
  explicit FoundNeighbors(std::size_t most) {
    for (auto& lane : found_) lane.reset(new std::uint32_t[most + lanes]);
  }

  /// Appends the rows of the group that begins at place `first`; `filler` is the place of a gap. Returns how
  /// many these are. Cost: about 0.1 µs a sphere.
  template <class Index>
  std::uint32_t append(const SoftKernels& kernels, const SearchTask& task, const SoftSphere* group,
                       std::uint32_t first, Index filler, std::vector<Index>& rows);

 private:
  std::array<std::unique_ptr<std::uint32_t[]>, lanes> found_;
};

}  // namespace bernal
