#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "bernal/core/random.hpp"
#include "core/archive.hpp"
#include "core/made.hpp"
#include "soft/linked_cells.hpp"

namespace bernal {

/// The sweeps of Zhao, Li & Liu (2007) over a periodic box, in double, with the spheres in the order of their
/// numbers. `Cells<D>` keeps and finds the spheres; it does not change the packing.
template <int D, template <int> class Cells = LinkedCells>
class PublishedLoop {
 public:
  /// Preconditions: centres in [0, edges), every edge at least twice the largest radius. `settle` as of
  /// `Relax`.
  PublishedLoop(const Spheres<D>& spheres, const Vector<D>& edges, bool settle, Random random)
      : settle_(settle),
        random_(random),
        r_max_(std::ranges::max(spheres.r)),
        cells_({edges}, spheres, std::ranges::min(spheres.r), r_max_),
        near_(spheres.size() + 1) {}

  /// Moves every sphere once. Returns the largest overlap ratio that it met.
  double sweep() {
    double largest = 0;
    cells_.begin_sweep();
    for (std::uint32_t number = 0; number < cells_.size(); ++number) {
      const Slot slot = cells_.slot_of(number);
      const double overlap = push(slot);
      largest = std::max(largest, overlap);
      if (settle_ && overlap == 0) settle(slot);
    }
    return largest;
  }

  void grow(double factor) { cells_.grow(edges() * factor); }

  const Vector<D>& edges() const { return cells_.box().edges; }
  void write_to(Spheres<D>& spheres) const { cells_.write_to(spheres); }
  /// The number of distances that were computed so far.
  std::uint64_t pairs_tested() const { return tested_; }

  /// Writes or reads the state. What reads it was made of the same number of spheres in the same box.
  void archive(Archive& a) { a(random_, cells_, tested_); }

 private:
  using Slot = typename Cells<D>::Slot;

  /// Relative, of a squared distance: so rounding leaves no pair out.
  static constexpr double rounding = 1e-9;

  /// All other spheres with an image across a gap below `gap`, up to rounding, in the order of the lists.
  /// Most spheres that the cells give are farther away; the nearest image alone tells them, without a branch.
  std::span<const Slot> near(Slot me, double gap) {
    const PlacedSphere<D> sphere = cells_[me];
    const Vector<D> edges = this->edges();
    const double own_reach = sphere.r + gap;
    Slot* const found = near_.data();
    std::size_t count = 0, tested = 0;
    cells_.for_each_near(sphere.center, own_reach, [&](Slot other) {
      const PlacedSphere<D>& there = cells_[other];
      double squared = 0;
      for (int k = 0; k < D; ++k) {
        const double d = std::abs(sphere.center[k] - there.center[k]);
        const double shortest = std::min(d, edges[k] - d);
        squared += shortest * shortest;
      }
      const double reach = own_reach + there.r;
      found[count] = other;
      count += squared < reach * reach * (1 + rounding);
      ++tested;
    });
    tested_ += tested;
    const std::span<Slot> all(found, std::remove(found, found + count, me));  // its own images are no nearer
    cells_.arrange(all, sphere.center, own_reach);
    return all;
  }

  /// Moves a sphere to the mean of the places at which it would touch one of those that it overlaps. Returns
  /// the largest overlap ratio that it had.
  double push(Slot me) {
    const auto [c, r] = cells_[me];
    Vector<D> sum = Vector<D>::Zero();
    int overlapping = 0;
    double largest = 0;
    for (const Slot other : near(me, 0)) {
      const double reach = r + cells_[other].r;
      for_each_image(c - cells_[other].center, reach, [&](const Vector<D>& away) {
        const double squared = away.squaredNorm();
        if (!(squared < reach * reach)) return;
        const double d = std::sqrt(squared);
        sum += d > 0 ? Vector<D>(away * (reach / d - 1)) : Vector<D>(reach * uniform_direction<D>(random_));
        ++overlapping;
        largest = std::max(largest, 1 - d / reach);
      });
    }
    if (overlapping > 0) cells_.move(me, c + sum / overlapping);
    return largest;
  }

  /// Moves a sphere that overlaps nothing towards the nearest one until they touch. All other gaps are wider,
  /// so it then overlaps nothing either.
  void settle(Slot me) {
    const auto [c, r] = cells_[me];
    const double farthest = edges().norm();
    double gap = std::numeric_limits<double>::infinity();
    Vector<D> towards = Vector<D>::Zero();
    for (double within = r_max_; !std::isfinite(gap) && within < 2 * farthest; within *= 2) {
      for (const Slot other : near(me, within)) {
        const Vector<D> way = cells_.box().minimum_image(cells_[other].center - c);
        const double d = way.norm(), between = d - r - cells_[other].r;
        if (!(between < gap && between <= within)) continue;
        gap = between;
        towards = way / d;
      }
    }
    if (std::isfinite(gap)) cells_.move(me, c + gap * towards);
  }

  /// Visits the images of a displacement that may be shorter than `reach`; in a wide box that is the shortest
  /// only.
  template <class Visit>
  void for_each_image(const Vector<D>& displacement, double reach, Visit&& visit) const {
    if (2 * reach <= edges().minCoeff()) {
      visit(cells_.box().minimum_image(displacement));
    } else {
      cells_.box().for_each_image(displacement, reach, visit);
    }
  }

  const Made made_{"relaxation"};
  bool settle_;
  Random random_;
  double r_max_;
  Cells<D> cells_;
  std::vector<Slot> near_;  // what the last search found
  std::uint64_t tested_ = 0;
};

}  // namespace bernal
