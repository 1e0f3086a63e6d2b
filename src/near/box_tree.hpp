#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The squared distance of a point from bounds, 0 within them.
template <int D>
double squared_distance(const Bounds<D>& bounds, const Vector<D>& p) {
  return (p - p.cwiseMax(bounds.lower).cwiseMin(bounds.upper)).squaredNorm();
}

/// Items, numbered from 0, in a binary tree of bounding boxes: each node is halved at the median of the
/// middles of its items' boxes, along its longest edge. So its depth is log2(items / leaf), however they lie.
///
/// The tree holds numbers and boxes; the items are their owner's. Searches enter a node by what its bounds
/// say and leave the items of leaves to the owner. The tree does not depend on the number of threads.
///
/// Cost: building O(N log N), in threads, about 0.5 µs an item; a search O(log N) and what it finds. Memory:
/// 4 bytes an item, and a node of 16 D + 24 bytes for each half of a leaf. Precondition: boxes are finite.
template <int D>
class BoxTree {
 public:
  using Id = std::uint32_t;

  struct Node {
    Bounds<D> bounds;
    double largest = 0;          ///< size of its items
    std::uint32_t first, last;   ///< its items in `order`
    std::uint32_t children = 0;  ///< the first of two, next to each other; 0: none
    std::uint32_t size() const { return last - first; }
  };

  BoxTree() = default;
  /// Leaves have at most `leaf` items.
  BoxTree(const std::vector<Bounds<D>>& boxes, std::uint32_t leaf);
  /// Points, each with a size, or all with none.
  BoxTree(const std::vector<Vector<D>>& points, std::span<const double> sizes, std::uint32_t leaf);

  /// The items; those of a node stand together.
  const std::vector<Id>& order() const { return order_; }
  /// A node comes before its children.
  const std::vector<Node>& nodes() const { return nodes_; }

  /// Calls visit(leaf) for every leaf that enter(node) is true of, and of all nodes above it, in the order of
  /// the items.
  template <class Enter, class Visit>
  void for_each_leaf(const Enter& enter, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, deepest> stack;
    std::size_t waiting = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
      const Node& node = nodes_[stack[--waiting]];
      if (!enter(node)) continue;
      if (node.children == 0) {
        visit(node);
      } else {
        stack[waiting++] = node.children + 1;
        stack[waiting++] = node.children;
      }
    }
  }

  /// Calls visit(id) at least for every item whose box is within `reach` of the centre.
  template <class Visit>
  void for_each_near(const Vector<D>& center, double reach, const Visit& visit) const {
    for_each_leaf([&](const Node& node) { return squared_distance(node.bounds, center) <= reach * reach; },
                  [&](const Node& leaf) {
                    for (std::uint32_t k = leaf.first; k < leaf.last; ++k) visit(order_[k]);
                  });
  }

  /// Calls visit(leaf) for the leaves of which least(node) is below `limit`, which `visit` may lower: at
  /// every node the child of which less is said comes first. What is said of a node must not be more than
  /// what is said of its children.
  template <class Least, class Visit>
  void for_each_leaf_below(const double& limit, const Least& least, const Visit& visit) const {
    struct Waiting {
      std::uint32_t node;
      double least;
    };
    if (nodes_.empty()) return;
    std::array<Waiting, deepest> stack;
    std::size_t waiting = 0;
    stack[waiting++] = {0, least(nodes_[0])};
    while (waiting > 0) {
      const Waiting next = stack[--waiting];
      if (!(next.least < limit)) continue;
      const Node& node = nodes_[next.node];
      if (node.children == 0) {
        visit(node);
        continue;
      }
      Waiting near{node.children, least(nodes_[node.children])};
      Waiting far{node.children + 1, least(nodes_[node.children + 1])};
      if (far.least < near.least) std::swap(near, far);
      stack[waiting++] = far;
      stack[waiting++] = near;
    }
  }

 private:
  static constexpr std::size_t deepest = 40;  // of 2^32 items, one on each level and one more

  void build(std::span<const Vector<D>> lower, std::span<const Vector<D>> upper,
             std::span<const double> sizes, std::uint32_t leaf);

  std::vector<Id> order_;
  std::vector<Node> nodes_;
};

}  // namespace bernal
