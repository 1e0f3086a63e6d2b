#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "near/box_tree.hpp"

namespace bernal {

/// The spheres in a tree of the boxes of their centres, for questions that depend on radii: which sphere has
/// the least power at a point, which surface is nearest. Open and periodic axes together. Cost: as of
/// `BoxTree`; memory about 30 bytes more a sphere.
template <int D>
class SphereTree {
 public:
  using Node = typename BoxTree<D>::Node;

  /// The squared distance of a point from a centre, and the radius, as a number: the less, the nearer.
  struct Power {
    static double of(double squared_distance, double r) { return squared_distance - r * r; }
  };
  struct Gap {
    static double of(double squared_distance, double r) { return std::sqrt(squared_distance) - r; }
  };

  /// A sphere, and where its image lies that is meant.
  struct Found {
    std::uint32_t place = 0;  ///< in the order of the tree
    Vector<D> center = Vector<D>::Zero();
    double value = std::numeric_limits<double>::infinity();
  };

  SphereTree(const Spheres<D>& spheres, const Boundary<D>& boundary)
      : boundary_(boundary), shifts_(shifts_of(boundary)) {
    std::vector<Vector<D>> wrapped;
    wrapped.reserve(spheres.size());
    for (std::size_t i = 0; i < spheres.size(); ++i) wrapped.push_back(boundary.wrap(spheres.center(i)));
    tree_ = BoxTree<D>(wrapped, spheres.r, leaf);
    for (const std::uint32_t id : tree_.order()) {
      centers_.push_back(wrapped[id]);
      radii_.push_back(spheres.r[id]);
    }
  }

  std::size_t size() const { return radii_.size(); }
  // By place in the order of the tree; those of a node stand together.
  std::uint32_t id(std::uint32_t place) const { return tree_.order()[place]; }
  const Vector<D>& center(std::uint32_t place) const { return centers_[place]; }
  double radius(std::uint32_t place) const { return radii_[place]; }

  /// The sphere with the least Measure at p, if that is below `limit`; else Found::value is `limit`. Of an
  /// axis with a period the images next to the one that p is in are enough. Precondition: p anywhere.
  template <class Measure>
  Found nearest(const Vector<D>& p, double limit = std::numeric_limits<double>::infinity()) const {
    Found found;
    found.value = limit;
    const Vector<D> in_period = boundary_.wrap(p);
    for (const Vector<D>& shift : shifts_) {
      const Vector<D> moved = in_period - shift;
      tree_.for_each_leaf_below(
          found.value,
          [&](const Node& node) { return Measure::of(squared_distance(node.bounds, moved), node.largest); },
          [&](const Node& node) {
            for (std::uint32_t k = node.first; k < node.last; ++k) {
              const double value = Measure::of((moved - centers_[k]).squaredNorm(), radii_[k]);
              if (value < found.value) found = {k, centers_[k] + shift, value};
            }
          });
    }
    found.center += p - in_period;
    return found;
  }

  /// Calls visit(leaf, shift, squared) for the leaves and their images, moved by `shift`, whose bounds are
  /// about as near as may(squared, largest radius) says for the squared distance of p from them: what it says
  /// of a leaf it has to say of all that the leaf is a part of. Of an axis with a period the images next to
  /// the one that p is in are looked at. Precondition: p in the period.
  template <class May, class Visit>
  void for_each_leaf(const Vector<D>& p, const May& may, const Visit& visit) const {
    for (const Vector<D>& shift : shifts_) {
      const Vector<D> moved = p - shift;
      double squared = 0;
      tree_.for_each_leaf(
          [&](const Node& node) {
            squared = squared_distance(node.bounds, moved);
            return may(squared, node.largest);
          },
          [&](const Node& node) { visit(node, shift, squared); });
    }
  }

  /// Calls visit(place, center) at least for every image of a sphere that a ball of radius r overlaps on its
  /// way from p along the unit vector u, 0 <= t <= limit; roughly the first it meets come first. What `visit`
  /// returns is the limit from then on. Of an axis with a period the images next to the one that p is in are
  /// looked at.
  template <class Visit>
  void for_each_on_way(const Vector<D>& p, double r, const Vector<D>& u, double limit, Visit&& visit) const {
    const Vector<D> in_period = boundary_.wrap(p), back = p - in_period;
    for (const Vector<D>& shift : shifts_) {
      const Vector<D> moved = in_period - shift;
      double beyond = std::nextafter(limit, infinity);
      tree_.for_each_leaf_below(
          beyond, [&](const Node& node) { return entry(node, moved, r, u, limit); },
          [&](const Node& node) {
            for (std::uint32_t k = node.first; k < node.last; ++k)
              limit = visit(k, Vector<D>(centers_[k] + shift + back));
            beyond = std::nextafter(limit, infinity);
          });
    }
  }

 private:
  static constexpr std::uint32_t leaf = 8;
  static constexpr double infinity = std::numeric_limits<double>::infinity();

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

  /// From which t on the moving ball may touch spheres of a node; infinite where it does not before `limit`.
  static double entry(const Node& node, const Vector<D>& p, double r, const Vector<D>& u, double limit) {
    const double reach = r + node.largest;
    double first = 0, last = limit;
    for (int k = 0; k < D; ++k) {
      const double to_lower = node.bounds.lower[k] - reach - p[k],
                   to_upper = node.bounds.upper[k] + reach - p[k];
      if (u[k] == 0) {
        if (to_lower > 0 || to_upper < 0) return infinity;
        continue;
      }
      const auto [near, far] = std::minmax({to_lower / u[k], to_upper / u[k]});
      first = std::max(first, near);
      last = std::min(last, far);
    }
    return first <= last ? first : infinity;
  }

  Boundary<D> boundary_;
  std::vector<Vector<D>> shifts_;
  BoxTree<D> tree_;
  std::vector<Vector<D>> centers_;
  std::vector<double> radii_;
};

}  // namespace bernal
