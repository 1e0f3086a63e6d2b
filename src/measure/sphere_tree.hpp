#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/boundary.hpp"
#include "core/parallel.hpp"

namespace bernal {

/// The spheres in a tree of boxes, each halved at the median of its centres across its longest edge, for
/// questions that depend on radii: which sphere has the least power at a point, which surface is nearest.
/// Open and periodic axes together. Cost: building O(N log N), in threads, about 0.5 µs a sphere; memory
/// about 30 bytes more a sphere.
template <int D>
class SphereTree {
 public:
  /// The squared distance of a point from a centre, and the radius, as a number: the less, the nearer.
  struct Power {
    static double of(double squared_distance, double r) { return squared_distance - r * r; }
  };
  struct Gap {
    static double of(double squared_distance, double r) { return std::sqrt(squared_distance) - r; }
  };

  struct Node {
    Bounds<D> bounds;  ///< of the centres
    double largest;    ///< radius
    std::uint32_t first, last;
    std::uint32_t children = 0;  ///< the first of two, next to each other; 0: none
    std::size_t size() const { return last - first; }
  };

  /// A sphere, and where its image lies that is meant.
  struct Found {
    std::uint32_t place = 0;  ///< in the order of the tree
    Vector<D> center = Vector<D>::Zero();
    double value = std::numeric_limits<double>::infinity();
  };

  SphereTree(const Spheres<D>& spheres, const Boundary<D>& boundary)
      : boundary_(boundary), shifts_(shifts_of(boundary)) {
    const auto n = static_cast<std::uint32_t>(spheres.size());
    std::vector<Vector<D>> wrapped;
    wrapped.reserve(n);
    for (std::uint32_t i = 0; i < n; ++i) wrapped.push_back(boundary.wrap(spheres.center(i)));
    ids_.resize(n);
    std::iota(ids_.begin(), ids_.end(), 0u);
    if (n > 0) nodes_.push_back(node(wrapped, spheres.r, 0, n));
    // Those of a depth at once, one after the other in the array.
    for (std::size_t first = 0, last = nodes_.size(); first < last; first = last, last = nodes_.size()) {
      std::size_t count = last;
      for (std::size_t k = first; k < last; ++k)
        if (nodes_[k].size() > leaf) nodes_[k].children = static_cast<std::uint32_t>((count += 2) - 2);
      nodes_.resize(count);
      parallel_for(first, last, [&](std::size_t k) { halve(nodes_[k], wrapped, spheres.r); });
    }
    for (const std::uint32_t id : ids_) {
      centers_.push_back(wrapped[id]);
      radii_.push_back(spheres.r[id]);
    }
  }

  std::size_t size() const { return ids_.size(); }
  const std::vector<Node>& nodes() const { return nodes_; }
  // By place in the order of the tree; those of a node stand together.
  std::uint32_t id(std::uint32_t place) const { return ids_[place]; }
  const Vector<D>& center(std::uint32_t place) const { return centers_[place]; }
  double radius(std::uint32_t place) const { return radii_[place]; }

  /// The sphere with the least Measure at p, if that is below `limit`; else Found::value is `limit`. Of an
  /// axis with a period the images next to the one that p is in are enough. Precondition: p anywhere.
  template <class Measure>
  Found nearest(const Vector<D>& p, double limit = std::numeric_limits<double>::infinity()) const {
    Found found;
    found.value = limit;
    if (nodes_.empty()) return found;
    const Vector<D> in_period = boundary_.wrap(p);
    for (const Vector<D>& shift : shifts_) search<Measure>(in_period - shift, found, shift);
    found.center += p - in_period;
    return found;
  }

  /// Calls visit(leaf, shift, squared) for the leaves and their images, moved by `shift`, whose bounds are
  /// about as near as may(squared, largest radius) says for the squared distance of p from them: what it says
  /// of a leaf it has to say of all that the leaf is a part of. Of an axis with a period the images next to
  /// the one that p is in are looked at. Precondition: p in the period.
  template <class May, class Visit>
  void for_each_leaf(const Vector<D>& p, const May& may, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 80> stack;  // one a level
    for (const Vector<D>& shift : shifts_) {
      const Vector<D> moved = p - shift;
      std::size_t waiting = 0;
      stack[waiting++] = 0;
      while (waiting > 0) {
        const Node& node = nodes_[stack[--waiting]];
        const double squared = squared_distance(node.bounds, moved);
        if (!may(squared, node.largest)) continue;
        if (node.children == 0) {
          visit(node, shift, squared);
        } else {
          stack[waiting++] = node.children + 1;
          stack[waiting++] = node.children;
        }
      }
    }
  }

  /// Calls visit(place, center) at least for every image of a sphere that a ball of radius r overlaps on its
  /// way from p along the unit vector u, 0 <= t <= limit; roughly the first it meets come first. What `visit`
  /// returns is the limit from then on. Of an axis with a period the images next to the one that p is in are
  /// looked at.
  template <class Visit>
  void for_each_on_way(const Vector<D>& p, double r, const Vector<D>& u, double limit, Visit&& visit) const {
    if (nodes_.empty()) return;
    const Vector<D> in_period = boundary_.wrap(p), back = p - in_period;
    for (const Vector<D>& shift : shifts_)
      follow(Way{in_period - shift, u, r}, limit,
             [&](std::uint32_t k) { limit = visit(k, Vector<D>(centers_[k] + shift + back)); });
  }

 private:
  static constexpr std::size_t leaf = 8;

  Node node(const std::vector<Vector<D>>& centers, const std::vector<double>& radii, std::uint32_t first,
            std::uint32_t last) const {
    Node made{{centers[ids_[first]], centers[ids_[first]]}, 0, first, last};
    for (std::uint32_t k = first; k < last; ++k) {
      made.bounds.lower = made.bounds.lower.cwiseMin(centers[ids_[k]]);
      made.bounds.upper = made.bounds.upper.cwiseMax(centers[ids_[k]]);
      made.largest = std::max(made.largest, radii[ids_[k]]);
    }
    return made;
  }

  void halve(const Node& parent, const std::vector<Vector<D>>& centers, const std::vector<double>& radii) {
    if (parent.children == 0) return;
    int axis = 0;
    parent.bounds.size().maxCoeff(&axis);
    const auto begin = ids_.begin();
    const std::uint32_t middle = parent.first + (parent.last - parent.first) / 2;
    std::nth_element(begin + parent.first, begin + middle, begin + parent.last, [&](auto a, auto b) {
      return std::pair(centers[a][axis], a) < std::pair(centers[b][axis], b);
    });
    nodes_[parent.children] = node(centers, radii, parent.first, middle);
    nodes_[parent.children + 1] = node(centers, radii, middle, parent.last);
  }

  /// None first, as that is where most is found.
  static std::vector<Vector<D>> shifts_of(const Boundary<D>& boundary) {
    std::vector<Vector<D>> shifts = {Vector<D>::Zero()};
    std::array<int, D> at;
    for (int k = 0; k < D; ++k) at[k] = boundary.repeats(k) ? -1 : 0;
    const std::array<int, D> lowest = at;
    for (int k = 0; k < D;) {
      Vector<D> shift;
      for (int axis = 0; axis < D; ++axis) shift[axis] = at[axis] * boundary.edges[axis];
      if (!shift.isZero(0)) shifts.push_back(shift);
      for (k = 0; k < D && (!boundary.repeats(k) || ++at[k] > 1); ++k) at[k] = lowest[k];
    }
    return shifts;
  }

  static double squared_distance(const Bounds<D>& bounds, const Vector<D>& p) {
    return (p - p.cwiseMax(bounds.lower).cwiseMin(bounds.upper)).squaredNorm();
  }

  template <class Measure>
  double least(const Node& node, const Vector<D>& p) const {
    return Measure::of(squared_distance(node.bounds, p), node.largest);
  }

  template <class Measure>
  void search(const Vector<D>& p, Found& found, const Vector<D>& shift) const {
    struct Stacked {
      std::uint32_t node;
      double least;
    };
    std::array<Stacked, 80> stack;  // one a level
    std::size_t waiting = 0;
    stack[waiting++] = {0, least<Measure>(nodes_[0], p)};
    while (waiting > 0) {
      const Stacked next = stack[--waiting];
      if (!(next.least < found.value)) continue;
      const Node& node = nodes_[next.node];
      if (node.children == 0) {
        for (std::uint32_t k = node.first; k < node.last; ++k) {
          const double value = Measure::of((p - centers_[k]).squaredNorm(), radii_[k]);
          if (value < found.value) found = {k, centers_[k] + shift, value};
        }
        continue;
      }
      Stacked near{node.children, least<Measure>(nodes_[node.children], p)};
      Stacked far{node.children + 1, least<Measure>(nodes_[node.children + 1], p)};
      if (far.least < near.least) std::swap(near, far);
      stack[waiting++] = far;
      stack[waiting++] = near;
    }
  }

  struct Way {
    Vector<D> p, u;
    double r;
  };

  /// From which t on the moving ball may touch spheres of a node; infinite where it does not before `limit`.
  static double entry(const Node& node, const Way& way, double limit) {
    const double reach = way.r + node.largest;
    double first = 0, last = limit;
    for (int k = 0; k < D; ++k) {
      const double to_lower = node.bounds.lower[k] - reach - way.p[k],
                   to_upper = node.bounds.upper[k] + reach - way.p[k];
      if (way.u[k] == 0) {
        if (to_lower > 0 || to_upper < 0) return std::numeric_limits<double>::infinity();
        continue;
      }
      const auto [near, far] = std::minmax({to_lower / way.u[k], to_upper / way.u[k]});
      first = std::max(first, near);
      last = std::min(last, far);
    }
    return first <= last ? first : std::numeric_limits<double>::infinity();
  }

  template <class Visit>
  void follow(const Way& way, const double& limit, Visit&& visit) const {
    std::array<std::pair<std::uint32_t, double>, 80> stack;  // one a level
    std::size_t waiting = 0;
    stack[waiting++] = {0, entry(nodes_[0], way, limit)};
    while (waiting > 0) {
      const auto [at, first] = stack[--waiting];
      if (!(first <= limit) || std::isinf(first)) continue;
      const Node& node = nodes_[at];
      if (node.children == 0) {
        for (std::uint32_t k = node.first; k < node.last; ++k) visit(k);
        continue;
      }
      std::pair near(node.children, entry(nodes_[node.children], way, limit));
      std::pair far(node.children + 1, entry(nodes_[node.children + 1], way, limit));
      if (far.second < near.second) std::swap(near, far);
      stack[waiting++] = far;
      stack[waiting++] = near;
    }
  }

  Boundary<D> boundary_;
  std::vector<Vector<D>> shifts_;
  std::vector<std::uint32_t> ids_;
  std::vector<Node> nodes_;
  std::vector<Vector<D>> centers_;
  std::vector<double> radii_;
};

}  // namespace bernal
