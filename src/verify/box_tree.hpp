#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "bernal/core/vector.hpp"
#include "core/parallel.hpp"

namespace bernal::verify {

/// A closed axis-aligned box; initially empty.
template <int D>
struct Box {
  std::array<double, D> lower = filled_with(infinity);
  std::array<double, D> upper = filled_with(-infinity);

  static constexpr double infinity = std::numeric_limits<double>::infinity();

  void include(const Box& other) {
    for (int k = 0; k < D; ++k) {
      lower[k] = std::min(lower[k], other.lower[k]);
      upper[k] = std::max(upper[k], other.upper[k]);
    }
  }

 private:
  static constexpr std::array<double, D> filled_with(double value) {
    std::array<double, D> all{};
    all.fill(value);
    return all;
  }
};

/// Whether two boxes have a point in common.
template <int D>
bool touch(const Box<D>& a, const Box<D>& b) {
  bool all = true;
  for (int k = 0; k < D; ++k) all &= (a.lower[k] <= b.upper[k]) & (b.lower[k] <= a.upper[k]);
  return all;
}

/// Bounds on a sum or difference of two doubles, given the nearest double: its error is at most half a
/// spacing of doubles, and |sum| 2^-52 is at least one spacing. (Below 2^-969, where that may underflow, sums
/// of doubles are exact or the spacing is still representable.)
inline double rounded_down(double sum) { return sum - 0x1p-52 * std::abs(sum); }
inline double rounded_up(double sum) { return sum + 0x1p-52 * std::abs(sum); }

/// A box that contains the ball of radius r around c, rounded outwards.
template <int D>
Box<D> box_of_ball(const Vector<D>& c, double r) {
  Box<D> box;
  for (int k = 0; k < D; ++k) {
    box.lower[k] = rounded_down(c[k] - r);
    box.upper[k] = rounded_up(c[k] + r);
  }
  return box;
}

/// The box widened by `by` >= 0 on every side, rounded outwards.
template <int D>
Box<D> widened(Box<D> box, double by) {
  for (int k = 0; k < D && by > 0; ++k) {
    box.lower[k] = rounded_down(box.lower[k] - by);
    box.upper[k] = rounded_up(box.upper[k] + by);
  }
  return box;
}

/// A bounding-volume hierarchy over items with `Box<D> box() const` and `double center(int axis) const`
/// (finite): a complete binary tree, each node split at the median along the longest extent of its centres.
/// So its depth is log2(N / 8) for any input: clustered, coincident, any ratio of sizes.
///
/// A search visits what satisfies `touch(const Box<D>&, const Query&)`, which must be monotonic: true for a
/// box if it is true for a box inside it. Then the search is complete. The tree does not depend on the number
/// of threads. Cost: building O(N log N), 4 D to 8 D bytes an item besides the item itself; a search O(log N)
/// plus its results, in few dimensions.
template <class Item, int D>
class BoxTree {
 public:
  explicit BoxTree(std::vector<Item> items) : items_(std::move(items)) {
    first_leaf_ = std::bit_ceil(std::max<std::size_t>(1, (items_.size() + leaf_size - 1) / leaf_size));
    boxes_.resize(2 * first_leaf_);
    build(root, 0, items_.size());
  }

  /// The items in the tree's order, which mostly keeps neighbours together.
  std::span<const Item> items() const { return items_; }

  /// Leaves are numbered from 0; together they contain every item once.
  std::size_t leaves() const { return first_leaf_; }
  std::span<const Item> leaf(std::size_t l) const {
    return std::span(items_).subspan(begin_of_leaf(l), begin_of_leaf(l + 1) - begin_of_leaf(l));
  }
  /// The box of all items.
  const Box<D>& box() const { return boxes_[root]; }
  const Box<D>& box_of_leaf(std::size_t l) const { return boxes_[first_leaf_ + l]; }

  /// Calls visit(item) for every item whose box touches `query`.
  template <class Query, class Visit>
  void for_each_touching(const Query& query, Visit visit) const {
    for_each_leaf_touching(query, root, [&](std::size_t l) {
      for (const Item& item : leaf(l))
        if (touch(item.box(), query)) visit(item);
    });
  }

  /// Calls visit(m) for every leaf m > l whose box touches the query.
  template <class Query, class Visit>
  void for_each_leaf_touching_after(std::size_t l, const Query& query, Visit visit) const {
    if (l + 1 < leaves()) for_each_leaf_touching(query, next(first_leaf_ + l), visit);
  }

  /// The smallest distance(item) over all items that is below `best`, else `best`, if no item is nearer to
  /// the query than distance_to_box(box) for any box that contains it. distance(item, best) may be any number
  /// that is not below `best` where the distance is not.
  template <class DistanceToBox, class Distance>
  double nearest(DistanceToBox distance_to_box, Distance distance, double best = Box<D>::infinity) const {
    nearest(root, distance_to_box, distance, best);
    return best;
  }

 private:
  static constexpr std::size_t leaf_size = 8;
  static constexpr std::size_t root = 1;

  // Node n has the children 2n and 2n + 1; the leaves are first_leaf_ and up, and split the items evenly.
  std::size_t begin_of_leaf(std::size_t l) const {
    return (items_.size() * l) >> std::countr_zero(first_leaf_);
  }

  /// The node that follows n and its descendants in depth-first order; the root after the last.
  static std::size_t next(std::size_t n) { return (n + 1) >> std::countr_zero(n + 1); }

  /// Visits the leaves that touch the query, from node n on in depth-first order.
  template <class Query, class Visit>
  void for_each_leaf_touching(const Query& query, std::size_t n, Visit visit) const {
    do {
      if (touch(boxes_[n], query)) {
        if (n < first_leaf_) {
          n = 2 * n;
          continue;
        }
        visit(n - first_leaf_);
      }
      n = next(n);
    } while (n != root);
  }

  template <class DistanceToBox, class Distance>
  void nearest(std::size_t n, DistanceToBox& distance_to_box, Distance& distance, double& best) const {
    if (!(distance_to_box(boxes_[n]) < best)) return;
    if (n >= first_leaf_) {
      for (const Item& item : leaf(n - first_leaf_)) best = std::min(best, distance(item, best));
      return;
    }
    const bool left_first = distance_to_box(boxes_[2 * n]) <= distance_to_box(boxes_[2 * n + 1]);
    nearest(2 * n + (left_first ? 0 : 1), distance_to_box, distance, best);
    nearest(2 * n + (left_first ? 1 : 0), distance_to_box, distance, best);
  }

  void build(std::size_t n, std::size_t begin, std::size_t end) {
    if (n >= first_leaf_) {
      for (std::size_t i = begin; i < end; ++i) boxes_[n].include(items_[i].box());
      return;
    }
    const int level_of_leaves = std::countr_zero(first_leaf_);
    const int level = std::bit_width(n) - 1;
    const std::size_t leaf_in_the_middle = (2 * n + 1 - (std::size_t{2} << level))
                                           << (level_of_leaves - level - 1);
    const std::size_t middle = begin_of_leaf(leaf_in_the_middle);
    const int axis = longest_axis(begin, end);
    const auto less = [axis](const Item& a, const Item& b) { return a.center(axis) < b.center(axis); };
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end, less);

    constexpr std::size_t worth_a_task = 4096;
    const auto left = [&] { build(2 * n, begin, middle); };
    const auto right = [&] { build(2 * n + 1, middle, end); };
    if (end - begin > worth_a_task) {
      parallel_both(left, right);
    } else {
      left();
      right();
    }
    boxes_[n].include(boxes_[2 * n]);
    boxes_[n].include(boxes_[2 * n + 1]);
  }

  int longest_axis(std::size_t begin, std::size_t end) const {
    Box<D> centers;
    for (std::size_t i = begin; i < end; ++i) {
      std::array<double, D> c;
      for (int k = 0; k < D; ++k) c[k] = items_[i].center(k);
      centers.include({c, c});
    }
    int axis = 0;
    for (int k = 1; k < D; ++k)
      if (centers.upper[k] - centers.lower[k] > centers.upper[axis] - centers.lower[axis]) axis = k;
    return axis;
  }

  std::vector<Item> items_;
  std::vector<Box<D>> boxes_;
  std::size_t first_leaf_ = 1;
};

}  // namespace bernal::verify
