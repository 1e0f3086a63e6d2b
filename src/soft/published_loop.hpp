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

/// A sweep of Zhao, Li & Liu (2007) over a periodic box, in double, the spheres in the order of their
/// numbers. `Cells<D>` keeps and finds them; whatever it is, the packing is the same to the bit.
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

  /// Every sphere once. Returns the largest overlap ratio that was met.
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
  /// So far.
  std::uint64_t pairs_tested() const { return tested_; }

  /// All of its state, in one that was made of as many spheres in the same box.
  void archive(Archive& a) { a(random_, cells_, tested_); }

 private:
  using Slot = typename Cells<D>::Slot;

  /// Of the distance squared: rounding leaves no pair out.
  static constexpr double rounding = 1e-9;

  /// All spheres, but this one, with an image across a gap of less than `gap`, to rounding and perhaps a
  /// little more, in the order of the lists. Most of what is near enough for the cells is not so near: these
  /// are told by the shortest image alone, without a branch.
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

  /// Moves a sphere to the mean of the places where it would touch one of those that it overlaps. Returns the
  /// largest of its overlap ratios, before.
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

  /// Moves a sphere, which overlaps nothing, towards the one across the smallest gap until they touch. As all
  /// other gaps are wider, it overlaps nothing then either.
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

  /// Of a displacement, the images that may be shorter than `reach`: the shortest alone where the box is
  /// wide.
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
