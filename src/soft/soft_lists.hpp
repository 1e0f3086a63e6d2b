#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/made.hpp"
#include "soft/soft_kernels.hpp"

namespace bernal {

/// Groups [first, last) that have to be swept one after the other, while other chains may be swept at the
/// same time.
struct Chain {
  std::size_t first, last;
};

/// In what order spheres are swept, and what each may meet until it has moved by the skin.
///
/// The box is cut into pencils along the first axis, at least as wide as two neighbours can be apart, and
/// every second pencil on each of the other axes is given the same colour. Spheres of different pencils of
/// one colour are never neighbours. So a group takes its spheres from as many pencils of a colour, a chain is
/// a sequence of groups from the same pencils, and the chains of a colour are independent of each other.
/// Within a pencil spheres of similar radii come together, so that the lists in a group are of similar
/// length; among these the order is along the axis. The few largest spheres, for whose sake pencils would
/// have to be too wide, are swept alone, after the others.
///
/// All this is a function of the places and radii alone, the same for any number of threads.
class SoftLists {
 public:
  /// `radii` are all that there will be; `skin` is in the same unit. `by_octaves`: spheres whose radii differ
  /// by more than an octave are swept one kind after the other, each in pencils as wide as it needs, the
  /// largest last.
  SoftLists(const std::vector<float>& radii, float skin, const SoftKernels& kernels, bool by_octaves = false);

  /// Sorts the spheres anew and finds their neighbours. `spheres` and `ids` are in sweep order, with gaps
  /// where the radius is NaN, before and after; the sphere behind the last group is such a gap. Of several
  /// images of a sphere that are neighbours of one, as there may be where an edge is less than 4 (largest
  /// radius + skin), the nearest counts. Parallel. Cost: about 0.2 µs a sphere on one core.
  void build(std::vector<SoftSphere>& spheres, std::vector<std::uint32_t>& ids,
             const std::array<double, 3>& edges);

  /// By colour.
  const std::vector<std::vector<Chain>>& phases() const { return phases_; }
  const NeighborRows* groups() const { return groups_.data(); }
  float skin() const { return skin_; }
  /// For the lists to come.
  void set_skin(float skin) { skin_ = skin; }

 private:
  using Place = std::uint32_t;

  void sort_into_cells(const std::vector<SoftSphere>& compact, const std::array<double, 3>& edges);
  std::vector<Place> sweep_order(const std::vector<SoftSphere>& compact, const std::array<double, 3>& edges);
  void add_pencils(std::vector<std::uint32_t> order, float largest, const std::vector<SoftSphere>& compact,
                   const std::array<double, 3>& edges, std::vector<Place>& sphere_at);
  void find_neighbors(const std::vector<SoftSphere>& spheres, const std::array<double, 3>& edges);

  Made made_{"relaxation"}, lists_made_{"neighbour lists"};
  const SoftKernels& kernels_;
  float skin_;
  float largest_;  // radius
  float large_;    // spheres with larger radii are swept alone
  bool equal_;     // radii
  bool by_octaves_;
  std::size_t level_count_;

  std::vector<SoftLevel> levels_;
  std::vector<std::uint32_t> start_;  // of each cell of all levels
  std::vector<std::uint32_t> slot_;   // of each sphere in sorted_
  std::vector<SoftSphere> sorted_;
  std::vector<Place> places_;  // of sorted_ in the sweep order
  std::vector<std::vector<Chain>> phases_;
  std::vector<NeighborRows> groups_;
  std::vector<std::vector<std::uint32_t>> rows_;  // a block for some hundred groups
};

}  // namespace bernal
