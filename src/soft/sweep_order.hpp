#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "near/counting_sort.hpp"
#include "soft/soft_kernels.hpp"

namespace bernal {

inline constexpr std::uint32_t nobody = 0xFFFFFFFF;

/// Of the radii of all spheres that are swept, as far as it matters to their order and their lists.
struct SoftSizes {
  float largest = 0;           ///< radius
  float large = 0;             ///< spheres with larger radii are swept apart: one per cent at most
  bool equal = true;           ///< radii
  std::size_t levels = 1;      ///< of the background grid, each for radii half as large
  double volume_a_sphere = 0;  ///< mean

  SoftSizes() = default;
  /// Cost: O(levels · N).
  explicit SoftSizes(const std::vector<float>& radii);
};

/// Groups [first, last) that have to be swept one after the other, while other chains may be swept at the
/// same time.
struct Chain {
  std::size_t first, last;
};

/// In what order the spheres of a region are swept.
///
/// The region is cut into pencils along the first axis, at least as wide as two neighbours can be apart, and
/// every second pencil on each of the other axes is given the same colour. Spheres of different pencils of
/// one colour are never neighbours. So a group takes its spheres from as many pencils of a colour, a chain is
/// a sequence of groups from the same pencils, and the chains of a colour are independent of each other.
/// Where there are too few pencils for threads they are cut, and colours alternate along the first axis as
/// well. Within a pencil spheres of similar radii come together, so that the lists in a group are of similar
/// length; among these the order is along the axis. The few largest spheres, for whose sake pencils would
/// have to be too wide, come after the others, in wider pencils.
///
/// All this is a function of the places and radii alone, the same for any number of threads.
class SweepOrder {
 public:
  /// Finds the order of these spheres, all with centres in the region, but for gaps, those with a radius of
  /// NaN. `by_octaves`: spheres whose radii differ by more than an octave are swept one kind after the other,
  /// each in pencils as wide as it needs, the largest last. Cost: some 50 ns a sphere.
  void find(std::span<const SoftSphere> spheres, const SoftRegion& region, const std::array<double, 3>& edges,
            const SoftSizes& sizes, float skin, bool by_octaves, bool in_threads = false);

  /// For every place, a whole number of groups of them, which of the spheres has it, or `nobody`.
  const std::vector<std::uint32_t>& sphere_at() const { return sphere_at_; }
  /// By colour.
  const std::vector<std::vector<Chain>>& phases() const { return phases_; }

 private:
  /// The spheres of one pencil, in sorted_.
  struct Pencil {
    std::uint32_t first, count;
  };
  struct Turn {
    std::uint32_t sphere, pencil;
  };
  /// A chain to be, by itself: chains are put together at the same time.
  struct Draft {
    std::size_t phase = 0;
    std::vector<Pencil> pencils;
    std::vector<std::uint32_t> sphere_at;   // whole groups
    std::vector<std::uint32_t> place, due;  // of the sorting by group
    std::vector<Turn> turns;
  };

  void add_pencils(const std::vector<std::uint32_t>& order, float largest);
  void sort_into_pencils(const std::vector<std::uint32_t>& order, float largest,
                         const std::array<int, 3>& across);
  int parts_along(std::size_t spheres, std::size_t longest, double width) const;
  float radius_of_most(const std::vector<std::uint32_t>& order) const;
  void draft_phase(const std::vector<Pencil>& pencils);
  Draft& new_draft();
  void put_together(Draft& chain) const;
  void add_drafts();

  std::span<const SoftSphere> spheres_;
  SoftRegion region_;
  std::array<double, 3> edges_{};
  float skin_ = 0;
  bool in_threads_ = false;
  std::vector<std::uint32_t> sphere_at_;
  std::vector<std::vector<Chain>> phases_;
  // Of the sorting, kept for the next time.
  std::vector<std::uint32_t> order_, sorted_, start_;
  BucketRoom room_;
  std::vector<Draft> drafts_;  // the first so many:
  std::size_t drafted_ = 0;
};

}  // namespace bernal
