#pragma once
#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <cstdint>
#include <vector>

#include "core/made.hpp"
#include "core/precedence.hpp"
#include "soft/group_lists.hpp"
#include "soft/row_arena.hpp"
#include "soft/soft_kernels.hpp"
#include "soft/sweep_order.hpp"

namespace bernal {

/// Sweeps over more spheres than the cache holds, block by block.
///
/// The box is cut into blocks of some thousand spheres, an even number of them along each axis, or one. A
/// visit copies the spheres of a block and its halo, the spheres of other blocks that may touch them, into a
/// few hundred kilobytes. It sweeps the block's own spheres in their own `SweepOrder`, while the halo rests,
/// and copies them back. Blocks of one colour, every second one along each axis, are independent of each
/// other, and a block is visited once its neighbours of earlier colours have been. So a sweep reads and
/// writes memory once and in order, and not once a neighbour, and numbers of 16 bits name neighbours.
///
/// The method is that of `SoftLists`; the order of the spheres is another. Several sweeps in one visit would
/// read less memory, but they push overlaps about within blocks: with two or four sweeps a visit 10^6 spheres
/// end at a packing fraction of 0.638 or 0.631 instead of 0.642.
///
/// The result depends on the places and radii only, and not on the number of threads.
class SoftBlocks {
 public:
  /// The number of spheres in a full block. With halo and lists twice as many take most of a second-level
  /// cache of 1 MiB, and gave eight threads something to do among 10^6 spheres; these give it to 27, and take
  /// as long on one thread, to within 3 %.
  static constexpr double usual_size = 7000;
  /// With fewer blocks a colour has too few of them for several threads. Fewer spheres fit into the last
  /// levels of the cache.
  static constexpr double fewest_spheres = 378000;
  static constexpr int fewest_blocks = 48;

  explicit SoftBlocks(const SoftKernels& kernels, double size = usual_size)
      : kernels_(kernels), size_(size) {}

  /// Whether a box is worth blocks, and wide enough for them.
  static bool suit(std::size_t spheres, const std::array<double, 3>& edges, const SoftSizes& sizes,
                   float skin);

  /// As `SoftLists::build`, for `count` spheres that `suit`. `spare` is scratch memory. Returns whether each
  /// block has at most 65,535 spheres with its halo; if not, there are no lists, and the order of the spheres
  /// is arbitrary.
  bool build(std::vector<SoftSphere>& spheres, std::vector<std::uint32_t>& ids,
             std::vector<SoftSphere>& spare, std::size_t count, const std::array<double, 3>& edges,
             const SoftSizes& sizes, float skin, std::uint32_t movers = nobody);

  /// Moves every sphere once, in threads. Returns what `SoftKernels::sweep` returns.
  float sweep(const SweepTask& task) const;

  /// The bytes that a sweep reads from memory and writes to it, if no cache keeps anything from one visit to
  /// the next: places twice, those of halos and their numbers once, and the lists.
  std::size_t bytes_a_sweep() const;
  /// In what order blocks are visited.
  const Precedence& order() const { return visits_; }
  /// The places of a block and of its halo: what a visit copies.
  std::size_t places_of_visit(std::size_t block) const {
    return blocks_[block].places + blocks_[block].halo_size;
  }

 private:
  static constexpr std::size_t most_places = 65535;  // of a visit
  /// Stands for no sphere.
  static constexpr std::uint16_t gap = 65535;

  struct Block {
    std::size_t first_place = 0, places = 0;  // its own places: whole groups of the sweep order of all
    std::size_t swept = 0;                    // the first so many of its places are swept; the others rest
    const NeighborRows<std::uint16_t>* groups = nullptr;  // places count from the first of the block
    const std::uint32_t* halo = nullptr;                  // places in the sweep order of all
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
  /// Used while lists are built: the order of a block, and those of its places that other blocks see.
  struct Draft {
    std::vector<std::uint16_t> from;     // by place: the number of the sphere in the block, or gap
    std::vector<std::uint16_t> exports;  // places that may be in the halo of another block, by direction
    std::array<std::uint32_t, 28> export_start{};
  };

  void cut(std::size_t spheres, const std::array<double, 3>& edges, const SoftSizes& sizes, float skin);
  void order_visits();
  std::size_t neighbor_of(std::size_t block, std::size_t direction) const;
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
  Precedence visits_;
  std::vector<std::uint32_t> spare_ids_;
  std::vector<std::uint32_t> order_, start_;  // spheres by block, and where each block begins
  tbb::enumerable_thread_specific<Scratch> scratch_;
  RowArena<std::uint16_t> rows_;
  RowArena<std::uint32_t> halos_;
  RowArena<NeighborRows<std::uint16_t>> groups_;
};

}  // namespace bernal
