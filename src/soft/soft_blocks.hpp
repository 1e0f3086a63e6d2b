#pragma once
#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <cstdint>
#include <vector>

#include "core/made.hpp"
#include "soft/group_lists.hpp"
#include "soft/row_arena.hpp"
#include "soft/soft_kernels.hpp"
#include "soft/sweep_order.hpp"

namespace bernal {

/// Sweeps over more spheres than the cache holds, block by block.
///
/// The box is cut into blocks of some thousand spheres, an even number along each axis or one. A visit copies
/// the spheres of a block, and those of others that may touch them, its halo, side by side into a few hundred
/// kilobytes, sweeps its own in a `SweepOrder` of their own, while the halo rests, and copies them back.
/// Blocks of one colour, every second one along each axis, have nothing to do with each other. So memory is
/// read and written once a sweep, along it, and not once a neighbour, and neighbours are numbers of 16 bits.
///
/// It is the same method with another order of the spheres. Several sweeps in one visit would read less
/// memory, but are not the same: overlaps are then pushed about within blocks, and with two or four sweeps a
/// visit 10^6 spheres end at a packing fraction of 0.638 and 0.631 instead of 0.642.
///
/// All this is a function of the places and radii alone, the same for any number of threads.
class SoftBlocks {
 public:
  /// Spheres in a block that is full: with their halo and their lists they take most of a second-level cache
  /// of 1 MiB. Half as many have a third more of a halo, and take 5 to 15 % longer.
  static constexpr double usual_size = 14000;
  /// With fewer blocks there are too few of a colour for several threads; of fewer spheres the last levels of
  /// cache hold all.
  static constexpr double fewest_spheres = 27 * usual_size;
  static constexpr int fewest_blocks = 48;

  explicit SoftBlocks(const SoftKernels& kernels, double size = usual_size)
      : kernels_(kernels), size_(size) {}

  /// Whether a box is worth blocks, and wide enough for them.
  static bool suit(std::size_t spheres, const std::array<double, 3>& edges, const SoftSizes& sizes,
                   float skin);

  /// As `SoftLists::build`, for `count` spheres that `suit`; what is in `spare` is lost. Returns whether each
  /// block has at most 65,535 spheres with its halo: else there are no lists, and the spheres are in some
  /// order.
  bool build(std::vector<SoftSphere>& spheres, std::vector<std::uint32_t>& ids,
             std::vector<SoftSphere>& spare, std::size_t count, const std::array<double, 3>& edges,
             const SoftSizes& sizes, float skin, std::uint32_t movers = nobody);

  /// Every sphere once, in threads. Returns what `SoftKernels::sweep` does.
  float sweep(const SweepTask& task) const;

  /// What a sweep reads from memory and writes to it, where no cache keeps anything from one visit to the
  /// next: places twice, those of halos and their numbers once, and the lists.
  std::size_t bytes_a_sweep() const;

 private:
  /// Of a visit.
  static constexpr std::size_t most_places = 65535;
  /// In place of the number of a sphere.
  static constexpr std::uint16_t gap = 65535;

  struct Block {
    std::size_t first_place = 0, places = 0;              // in all; its own, a whole number of groups
    std::size_t swept = 0;                                // of these, the first groups; others rest
    const NeighborRows<std::uint16_t>* groups = nullptr;  // whose places count from the first of the block
    const std::uint32_t* halo = nullptr;                  // places in all
    std::uint32_t halo_size = 0;
  };
  struct Scratch {
    std::vector<SoftSphere> spheres;
    std::vector<std::uint16_t> moving, resting;  // numbers of a block's spheres
    SweepOrder order;
    RegionCells cells;
    CandidateRoom room;
    FoundNeighbors found;
    std::vector<NeighborList> lists;
    std::vector<std::uint32_t> halo;
    std::vector<std::uint16_t> rows, name_of;
    std::vector<NeighborRows<std::uint16_t>> groups;
    std::array<std::vector<std::uint16_t>, 27> exports;
  };
  /// While lists are built: the order of a block, and which of its places others see.
  struct Draft {
    std::vector<std::uint16_t> from;     // of each place, which of the block's spheres, or gap
    std::vector<std::uint16_t> exports;  // places that may be in the halo of another, by direction
    std::array<std::uint32_t, 28> export_start{};
  };

  void cut(std::size_t spheres, const std::array<double, 3>& edges, const SoftSizes& sizes, float skin);
  SoftRegion region_of(std::size_t block) const;
  void sort_into_blocks(const std::vector<SoftSphere>& spheres);
  bool find_orders(const std::vector<SoftSphere>& spheres, const std::vector<std::uint32_t>& ids,
                   std::uint32_t movers);
  void find_exports(std::size_t block, const std::vector<SoftSphere>& spheres, Scratch& scratch);
  bool find_neighbors(std::size_t block, const std::vector<SoftSphere>& spheres, Scratch& scratch);
  static void name_neighbors(std::size_t own, Scratch& scratch);
  float visit(const Block& block, const SweepTask& task) const;

  Made made_{"relaxation"}, lists_made_{"neighbour lists"};
  const SoftKernels& kernels_;
  const double size_;
  std::array<double, 3> edges_{};
  SoftSizes sizes_;
  float skin_ = 0;
  std::array<int, 3> across_{1, 1, 1};
  std::array<std::uint64_t, 3> halo_width_{};  // in units of the coordinates
  std::vector<Block> blocks_;
  std::vector<Draft> drafts_;
  std::array<std::vector<std::uint32_t>, 8> colours_;
  std::vector<std::uint32_t> spare_ids_;
  std::vector<std::uint32_t> order_, start_;  // of the spheres, by block; of each block in it, one more
  tbb::enumerable_thread_specific<Scratch> scratch_;
  RowArena<std::uint16_t> rows_;
  RowArena<std::uint32_t> halos_;
  RowArena<NeighborRows<std::uint16_t>> groups_;
};

}  // namespace bernal
