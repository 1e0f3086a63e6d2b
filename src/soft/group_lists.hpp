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

/// The spheres of a region by the cells of a background grid, one level of it for every octave of radii, for
/// the search for neighbours.
///
/// What it buys: the kernels read places and radii in the number format and the width that they work with. With
/// the order of sweeps the lists of 2·10^5 spheres take 0.2 µs a sphere; to ask a `CellGrid` for about as many
/// neighbours takes 1.1 with 10^5.
class RegionCells {
 public:
  /// Sorts the spheres of the region, each named by its index here; those with a radius of NaN are left out.
  /// Cost: some 10 ns a sphere.
  void sort(std::span<const SoftSphere> spheres, const SoftRegion& region, const std::array<double, 3>& edges,
            const SoftSizes& sizes, float skin, bool in_threads = false);

  /// Good until they are sorted anew.
  SearchTask task() const;
  /// How many spheres there are, once they are sorted.
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
  std::vector<std::uint32_t> places_;  // these columns have `lanes` more entries that say nothing
};

/// For the candidates of searches. Memory that is never touched costs nothing.
class CandidateRoom {
 public:
  /// Among so many spheres, at least.
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

/// Of one sphere.
struct NeighborList {
  const std::uint32_t* first = nullptr;
  std::uint32_t size = 0;
};

/// The neighbours of the spheres in some slots of the cells. They are found in the order of the slots, as
/// those that follow each other lie close together: in the order of sweeping they are far from each other.
class FoundNeighbors {
 public:
  /// Of those in the slots [first, last) whose place is below `own`, which `of_place` then has until this is
  /// used again. Cost: some 50 ns a sphere.
  void find(const SoftKernels& kernels, const SearchTask& task, std::size_t first, std::size_t last,
            std::size_t own, CandidateRoom& room, std::vector<NeighborList>& of_place);

  /// What is in the lists.
  std::span<const std::uint32_t> all() const { return {all_.data(), used_}; }

 private:
  std::vector<std::uint32_t> all_;  // with room behind them
  std::size_t used_ = 0;
  std::vector<std::size_t> ends_;  // of the lists, by slot
};

/// Appends the rows of a group with these lists, every place p as name_of(p), and lists that are shorter than
/// others filled up with the own place of their sphere, from `first` on, which it does not touch. Returns how
/// many rows these are. Cost: about 1 ns a neighbour.
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
