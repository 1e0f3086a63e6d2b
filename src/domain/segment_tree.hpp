#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The edges of polygons in a tree of bounds, each node halved at the median along its longer extent.
class SegmentTree {
 public:
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

  explicit SegmentTree(std::vector<Segment> segments) : segments_(std::move(segments)) {
    build(0, segments_.size());
  }

  /// The distance of p from the nearest segment; any value of at least `reach` where none is nearer.
  double distance(const Vector<2>& p, double reach) const {
    double squared = reach * reach;
    visit([&](const Bounds<2>& box) { return squared_distance(box, p) < squared; },
          [&](const Segment& s) { squared = std::min(squared, s.offset(p).squaredNorm()); });
    return std::sqrt(squared);
  }

  /// Calls see(segment) at least for all that are nearer to p than `reach`.
  template <class See>
  void for_each_near(const Vector<2>& p, double reach, See&& see) const {
    visit([&](const Bounds<2>& box) { return squared_distance(box, p) <= reach * reach; }, see);
  }

  /// Whether the ray from p along the first axis crosses an odd number of segments.
  bool encloses(const Vector<2>& p) const {
    bool odd = false;
    visit(
        [&](const Bounds<2>& box) {
          return box.lower[1] <= p[1] && p[1] <= box.upper[1] && p[0] <= box.upper[0];
        },
        [&](const Segment& s) {
          if ((s.a[1] > p[1]) == (s.b[1] > p[1])) return;
          const Vector<2> u = s.b - s.a, w = p - s.a;
          const double side = u[0] * w[1] - u[1] * w[0];
          odd ^= s.b[1] > s.a[1] ? side > 0 : side < 0;
        });
    return odd;
  }

 private:
  static constexpr std::size_t leaf_size = 4;

  struct Node {
    Bounds<2> box;
    std::size_t begin, end;
    std::size_t next = 0;  ///< after it and all below it
  };

  static double squared_distance(const Bounds<2>& box, const Vector<2>& p) {
    return (box.lower - p).cwiseMax(p - box.upper).cwiseMax(0).squaredNorm();
  }

  /// In the order of the tree.
  template <class Enter, class See>
  void visit(Enter&& enter, See&& see) const {
    for (std::size_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      if (!enter(node.box)) {
        n = node.next;
        continue;
      }
      if (node.next == n + 1)
        for (std::size_t k = node.begin; k < node.end; ++k) see(segments_[k]);
      ++n;
    }
  }

  void build(std::size_t begin, std::size_t end) {
    if (begin == end) return;
    const std::size_t n = nodes_.size();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Bounds<2> box{Vector<2>::Constant(infinity), Vector<2>::Constant(-infinity)};
    for (std::size_t k = begin; k < end; ++k) {
      box.lower = box.lower.cwiseMin(segments_[k].a).cwiseMin(segments_[k].b);
      box.upper = box.upper.cwiseMax(segments_[k].a).cwiseMax(segments_[k].b);
    }
    nodes_.push_back({box, begin, end});
    if (end - begin > leaf_size) {
      const int axis = box.size()[0] >= box.size()[1] ? 0 : 1;
      const std::size_t middle = begin + (end - begin) / 2;
      const auto at = [&](std::size_t k) { return segments_.begin() + static_cast<std::ptrdiff_t>(k); };
      std::nth_element(at(begin), at(middle), at(end), [axis](const Segment& s, const Segment& t) {
        const double c = s.a[axis] + s.b[axis], d = t.a[axis] + t.b[axis];
        return c != d ? c < d : s.id < t.id;
      });
      build(begin, middle);
      build(middle, end);
    }
    nodes_[n].next = nodes_.size();
  }

  std::vector<Segment> segments_;
  std::vector<Node> nodes_;
};

}  // namespace bernal
