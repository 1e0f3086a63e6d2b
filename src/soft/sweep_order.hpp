#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "near/counting_sort.hpp"
#include "soft/soft_kernels.hpp"

namespace bernal {

inline constexpr std::uint32_t nobody = 0xFFFFFFFF;

/// What the order of sweeps and the lists need to know of the radii.
struct SoftSizes {
  float largest = 0;           ///< radius
  float large = 0;             ///< at most one per cent of the spheres are larger; they are swept apart
  bool equal = true;           ///< whether all radii are equal
  std::size_t levels = 1;      ///< of the background grid; each holds radii half as large as the one before
  double volume_a_sphere = 0;  ///< mean volume of a sphere

  SoftSizes() = default;
  /// Cost: O(levels · N).
  explicit SoftSizes(const std::vector<float>& radii);
};

/// Groups [first, last) that are swept one after the other. Other chains of the same phase may be swept at
/// the same time.
struct Chain {
  std::size_t first, last;
};

/// The order in which the spheres of a region are swept.
///
/// The region is cut into pencils along the first axis. A pencil is at least as wide as two neighbours can be
/// apart; every second pencil along each of the other axes has the same colour. So spheres in different
/// pencils of one colour are never neighbours, in any image: an axis that is shorter than two pencils has
/// one. A group takes its spheres from different pencils of a colour, a chain is a sequence of groups from
/// the same pencils, and the chains of a colour are independent of each other. If there are too few pencils
/// for threads, they are cut, and colours alternate along the first axis as well. In a pencil spheres of
/// similar radii come together, so that the lists in a group have similar lengths; among these the order is
/// along the axis. The few largest spheres, which would make all pencils too wide, come last, in wider
/// pencils.
///
/// The order depends on the places and radii only, and not on the number of threads.
class SweepOrder {
 public:
  /// Finds the order of these spheres, whose centres are in the region. Those with a radius of NaN are gaps
  /// and are left out. With `by_octaves` each octave of radii is swept by itself, in pencils as wide as it
  /// needs, the largest octave last. Cost: some 50 ns a sphere.
  void find(std::span<const SoftSphere> spheres, const SoftRegion& region, const std::array<double, 3>& edges,
            const SoftSizes& sizes, float skin, bool by_octaves, bool in_threads = false);

  /// The index of the sphere at every place, or `nobody`. The places are a whole number of groups.
  const std::vector<std::uint32_t>& sphere_at() const { return sphere_at_; }
  /// The chains of each phase. Phases follow each other.
  const std::vector<std::vector<Chain>>& phases() const { return phases_; }

 private:
  /// The spheres of one pencil, in sorted_.
  struct Pencil {
    std::uint32_t first, count;
  };
  struct Turn {
    std::uint32_t sphere, pencil;
  };
  /// A chain while it is put together, which threads do at the same time.
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
