#pragma once
#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <cstdint>
#include <vector>

#include "core/made.hpp"
#include "soft/group_lists.hpp"
#include "soft/soft_kernels.hpp"
#include "soft/sweep_order.hpp"

namespace bernal {

/// The neighbours that each sphere of a box may meet until it has moved by the skin, and sweeps over all
/// spheres in one `SweepOrder`.
class SoftLists {
 public:
  /// With fewer spheres a second thread does not pay.
  static constexpr std::size_t worth_threads = 20000;

  explicit SoftLists(const SoftKernels& kernels, bool by_octaves = false)
      : kernels_(kernels), by_octaves_(by_octaves) {}

  /// Sorts the spheres and finds their neighbours. Before and after, `spheres` and `ids` are in sweep order,
  /// with gaps where the radius is NaN. A sphere is listed once, even if several images of it are near, which
  /// happens if an edge is shorter than 4 (largest radius + skin). `skin` is in the unit of the radii.
  /// Parallel. Cost: about 0.2 µs a sphere on one core.
  ///
  /// Spheres whose id is `movers` or larger rest: they stand behind the last group, where others find them as
  /// neighbours and no sweep moves them. Precondition: at least one sphere moves.
  void build(std::vector<SoftSphere>& spheres, std::vector<std::uint32_t>& ids,
             const std::array<double, 3>& edges, const SoftSizes& sizes, float skin,
             std::uint32_t movers = nobody);

  /// Moves every sphere once; with `in_threads` chains of one colour at the same time. Returns what
  /// `SoftKernels::sweep` returns.
  float sweep(const SweepTask& task, bool in_threads) const;

  const NeighborRows<std::uint32_t>* groups() const { return groups_.data(); }

 private:
  void take_resting_out(std::uint32_t movers);
  void find_neighbors(std::size_t swept);

  Made made_{"relaxation"}, lists_made_{"neighbour lists"};
  const SoftKernels& kernels_;
  bool by_octaves_;
  SweepOrder order_;
  RegionCells cells_;
  std::vector<NeighborRows<std::uint32_t>> groups_;
  std::vector<std::vector<std::uint32_t>> rows_;  // a block for some groups
  // Only `build` uses these. They keep their memory: to get it from the system each time took 60 ns a sphere
  // with 10^5 spheres, and the rest of `build` 160.
  struct Part {
    std::vector<SoftSphere> spheres;
    std::vector<std::uint32_t> ids;
  };
  Part before_, resting_;
  std::vector<NeighborList> found_of_;  // of each place
  std::vector<FoundNeighbors> found_;
  tbb::enumerable_thread_specific<CandidateRoom> rooms_;
};

}  // namespace bernal
