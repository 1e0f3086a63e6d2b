#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "near/counting_sort.hpp"
#include "soft/soft_kernels.hpp"
#include "soft/sweep_order.hpp"

namespace bernal {

/// The spheres of a region, sorted by the cells of a background grid with a level for every octave of radii:
/// the search for neighbours reads them.
///
/// What it buys: the kernels read places and radii in the number format and the width that they work with.
/// Lists of 2·10^5 spheres take 0.2 µs a sphere, the order of sweeps included; a `CellGrid` with 10^5 spheres
/// takes 1.1 for about as many neighbours.
class RegionCells {
 public:
  /// Sorts the spheres of the region by cell. Later calls name a sphere by its index here. Spheres with a
  /// radius of NaN are left out.
  /// Cost: some 10 ns a sphere.
  void sort(std::span<const SoftSphere> spheres, const SoftRegion& region, const std::array<double, 3>& edges,
            const SoftSizes& sizes, float skin, bool in_threads = false);

  /// Valid until the next `sort`.
  SearchTask task() const;
  /// The number of spheres that were sorted.
  std::size_t size() const { return start_.back(); }

 private:
  std::size_t choose_levels(std::span<const SoftSphere> spheres, const SoftSizes& sizes);

  SoftRegion region_;
  std::array<double, 3> edges_{};
  float skin_ = 0;
  std::vector<SoftLevel> levels_;
  std::vector<std::uint32_t> start_;  // of each cell of all levels
  BucketRoom room_;
  std::vector<std::int32_t> x_, y_, z_;
  std::vector<float> r_;
  std::vector<std::uint32_t> places_;  // these columns have `lanes` unused entries more
};

/// Memory for the candidates of searches. Pages that are never touched cost nothing.
class CandidateRoom {
 public:
  /// For searches among at least this number of spheres.
  void reserve(std::size_t spheres) {
    if (size_ >= spheres + 2 * lanes) return;
    size_ = spheres + 2 * lanes;
    columns_.reset(new float[4 * size_]);
    places_.reset(new std::uint32_t[size_]);
  }

  Candidates candidates() {
    float* const x = columns_.get();
    return {x, x + size_, x + 2 * size_, x + 3 * size_, places_.get()};
  }

 private:
  std::size_t size_ = 0;
  std::unique_ptr<float[]> columns_;
  std::unique_ptr<std::uint32_t[]> places_;
};

/// The neighbours of one sphere.
struct NeighborList {
  const std::uint32_t* first = nullptr;
  std::uint32_t size = 0;
};

/// The neighbours of the spheres in some slots of the cells. The search goes through the slots in order,
/// because spheres in successive slots lie close together; in the order of sweeps they do not.
class FoundNeighbors {
 public:
  /// Finds the neighbours of the spheres in the slots [first, last) whose place is below `own`, and writes
  /// their lists to `of_place`. These are valid until the next call. Cost: some 50 ns a sphere.
  void find(const SoftKernels& kernels, const SearchTask& task, std::size_t first, std::size_t last,
            std::size_t own, CandidateRoom& room, std::vector<NeighborList>& of_place);

  /// The entries of all lists.
  std::span<const std::uint32_t> all() const { return {all_.data(), used_}; }

 private:
  std::vector<std::uint32_t> all_;  // the first `used_` count
  std::size_t used_ = 0;
  std::vector<std::size_t> ends_;  // where the lists end, by slot
};

/// Appends the rows of a group that has these lists, and returns the number of rows. A place p is written as
/// name_of(p). Lists that are shorter than the longest are filled up with the sphere's own place, which is
/// `first` for the first of them; a sphere does not touch itself. Cost: about 1 ns a neighbour.
template <class Index, class NameOf>
std::uint32_t append_rows(const NeighborList* lists, std::size_t first, const NameOf& name_of,
                          std::vector<Index>& rows) {
  std::uint32_t most = 0;
  for (std::size_t l = 0; l < lanes; ++l) most = std::max(most, lists[l].size);
  const std::size_t begin = rows.size();
  rows.resize(begin + most * lanes);
  Index* const row = rows.data() + begin;
  for (std::size_t l = 0; l < lanes; ++l) {
    for (std::size_t k = 0; k < lists[l].size; ++k) row[k * lanes + l] = name_of(lists[l].first[k]);
    for (std::size_t k = lists[l].size; k < most; ++k) row[k * lanes + l] = static_cast<Index>(first + l);
  }
  return most;
}

}  // namespace bernal
