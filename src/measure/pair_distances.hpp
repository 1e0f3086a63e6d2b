#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "core/parallel.hpp"
#include "near/point_grid.hpp"

namespace bernal {

/// The centres within reach of each centre. The reach is at most half of every period, and of the shortest of
/// a tilted box, so that each is visited at most once.
template <int D>
class Surroundings {
 public:
  Surroundings(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary, double reach)
      : upright_{boundary.edges, boundary.origin},
        size_(size_of(spheres, boundary)),
        reach_(reach),
        grid_(spheres, boundary, cell_edge(spheres.size())) {
    auto in_cells = static_cast<double>(spheres.size());
    for (int k = 0; k < D; ++k) in_cells *= (2 * reach + 2 * cell_edge(spheres.size())) / size_[k];
    by_cells_ = in_cells < static_cast<double>(spheres.size()) || boundary.is_tilted();
    cost_ = std::min(in_cells, static_cast<double>(spheres.size()));
  }

  /// Approximate number of distances computed for one centre.
  double cost() const { return cost_; }

  /// Calls visit(id, id of the other, squared distance) for the centre at that position in the grid's order.
  template <class Visit>
  void for_each(std::size_t place, Visit&& visit) const {
    const double squared_reach = reach_ * reach_;
    const Vector<D> c = grid_.point(place);
    const std::uint32_t self = grid_.ids()[place];
    const auto meet = [&](std::uint32_t id, const Vector<D>& d) {
      const double squared = d.squaredNorm();
      if (squared < squared_reach && id != self) visit(self, id, squared);
    };
    if (by_cells_) {
      grid_.for_each_near(c, reach_, meet);
    } else {
      for (std::size_t p = 0; p < grid_.ids().size(); ++p)
        meet(grid_.ids()[p], upright_.minimum_image(grid_.point(p) - c));
    }
  }

 private:
  /// The periods; along open axes the extent of the spheres.
  static Vector<D> size_of(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary) {
    Vector<D> size = boundary.edges;
    for (int k = 0; k < D; ++k) {
      if (boundary.repeats(k)) continue;
      const auto [least, most] = std::ranges::minmax_element(spheres.x[static_cast<std::size_t>(k)]);
      size[k] = *most - *least + 2 * *std::ranges::max_element(spheres.r);
    }
    return size;
  }
  /// A quarter of the reach, but large enough that few cells are empty.
  double cell_edge(std::size_t n) const {
    return std::max(reach_ / 4, std::pow(size_.prod() / static_cast<double>(n), 1.0 / D));
  }

  Boundary<D> upright_;  // where images are not found by cells
  Vector<D> size_;
  double reach_;
  PointGrid<D> grid_;
  bool by_cells_ = false;
  double cost_ = 0;
};

/// Visits the pairs of as many centres as `work`, a number of distances, allows (at least a hundred), evenly
/// spread over the grid's order and so over the domain. Results are added to copies of `empty`, a `Tally`
/// with reach(), add(id, id of the other, squared distance) and add(another tally), which are summed in the
/// same order for any number of threads. `references` becomes the number of centres. Preconditions: there are
/// spheres; reach at most half of every period.
template <int D, class Tally>
Tally tally_of_pairs(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary, const Tally& empty,
                     double work, std::uint64_t& references) {
  constexpr std::size_t fewest_references = 100, references_a_part = 256;
  const std::size_t n = spheres.size();
  const Surroundings<D> surroundings(spheres, boundary, empty.reach());
  const double affordable = std::max(work / surroundings.cost(), 1.0 * fewest_references);
  const auto looked_from = static_cast<std::size_t>(std::min(affordable, static_cast<double>(n)));
  std::vector<Tally> parts((looked_from + references_a_part - 1) / references_a_part, empty);
  parallel_for(parts.size(), [&](std::size_t part) {
    for (std::size_t k = part * references_a_part; k < std::min(looked_from, (part + 1) * references_a_part);
         ++k)
      surroundings.for_each((2 * k + 1) * n / (2 * looked_from),
                            [&](auto i, auto j, double squared) { parts[part].add(i, j, squared); });
  });
  Tally sum = empty;
  for (const Tally& part : parts) sum.add(part);
  references = looked_from;
  return sum;
}

/// The share of the directed pairs whose other direction was not visited.
inline double share_of_distinct(std::uint64_t references, std::size_t spheres) {
  return 1 - 0.5 * static_cast<double>(references) / static_cast<double>(spheres);
}

}  // namespace bernal
