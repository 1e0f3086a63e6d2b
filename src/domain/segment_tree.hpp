#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "bernal/core/vector.hpp"
#include "near/box_tree.hpp"

namespace bernal {

/// An edge in a plane, with its number among all.
struct Segment {
  Vector<2> a, b;
  std::uint32_t id;

  /// p minus the nearest point of the segment, as in kernels/closest_point.hpp.
  Vector<2> offset(const Vector<2>& p) const {
    const Vector<2> base = b - a, w = p - a;
    const double along = w.dot(base), squared_length = base.squaredNorm();
    if (!(along > 0)) return w;
    if (along >= squared_length) return p - b;
    return w - (along / squared_length) * base;
  }
};

/// The edges of closed lines in the plane, in a tree. Cost: O(log n) a question, beside the edges that are
/// about as near.
class SegmentTree {
 public:
  explicit SegmentTree(std::vector<Segment> edges) : edges_(std::move(edges)), tree_(boxes_of(edges_), 4) {
    std::vector<Segment> in_order;
    for (const std::uint32_t k : tree_.order()) in_order.push_back(edges_[k]);
    edges_.swap(in_order);
  }

  /// Calls see(edge) for those in boxes that enter(box) is true of.
  template <class Enter, class See>
  void for_each(const Enter& enter, const See& see) const {
    tree_.for_each_leaf([&](const BoxTree<2>::Node& node) { return enter(node.bounds); },
                        [&](const BoxTree<2>::Node& leaf) {
                          for (std::uint32_t k = leaf.first; k < leaf.last; ++k) see(edges_[k]);
                        });
  }

  /// Calls see(edge) for those that may be as near to p as `reach`.
  template <class See>
  void for_each_within(const Vector<2>& p, double reach, const See& see) const {
    for_each([&](const Bounds<2>& box) { return squared_distance<2>(box, p) <= reach * reach; }, see);
  }

  /// Calls see(edge) for those that the ray from p along the first axis may cross, and that are not farther
  /// behind it or beside it than `margin`.
  template <class See>
  void for_each_ahead(const Vector<2>& p, double margin, const See& see) const {
    for_each(
        [&](const Bounds<2>& box) {
          return box.lower[1] <= p[1] + margin && p[1] - margin <= box.upper[1] &&
                 p[0] - margin <= box.upper[0];
        },
        see);
  }

  /// The distance of p from the nearest edge; any value of at least `reach` where none is nearer.
  double distance_within(const Vector<2>& p, double reach) const {
    double squared = reach * reach;
    for_each([&](const Bounds<2>& box) { return squared_distance(box, p) < squared; },
             [&](const Segment& s) { squared = std::min(squared, s.offset(p).squaredNorm()); });
    return std::sqrt(squared);
  }

  /// Whether the ray from p along the first axis crosses an odd number of edges.
  bool encloses(const Vector<2>& p) const {
    bool odd = false;
    for_each_ahead(p, 0, [&](const Segment& s) {
      if ((s.a[1] > p[1]) == (s.b[1] > p[1])) return;
      const Vector<2> u = s.b - s.a, w = p - s.a;
      const double side = u[0] * w[1] - u[1] * w[0];
      odd ^= s.b[1] > s.a[1] ? side > 0 : side < 0;
    });
    return odd;
  }

  /// Positive where the lines enclose p.
  double signed_distance_within(const Vector<2>& p, double reach) const {
    // Outside the distance is asked whatever the reach.
    const bool inside = encloses(p);
    const double distance =
        distance_within(p, inside ? std::max(0.0, reach) : std::numeric_limits<double>::infinity());
    return std::min(inside ? distance : -distance, reach);
  }

 private:
  static std::vector<Bounds<2>> boxes_of(const std::vector<Segment>& edges) {
    std::vector<Bounds<2>> boxes;
    for (const Segment& s : edges) boxes.push_back({s.a.cwiseMin(s.b), s.a.cwiseMax(s.b)});
    return boxes;
  }

  std::vector<Segment> edges_;  ///< in the order of the tree
  BoxTree<2> tree_;
};

}  // namespace bernal
