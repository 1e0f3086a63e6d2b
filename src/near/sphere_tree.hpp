#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "near/box_tree.hpp"

namespace bernal {

/// The spheres in a tree of the boxes of their centres, for questions that depend on radii: which surface is
/// nearest, what a moving ball meets first. Open and periodic axes together. Cost: as of
/// `BoxTree`; memory about 30 bytes more a sphere.
template <int D>
class SphereTree {
 public:
  using Node = typename BoxTree<D>::Node;

  /// A sphere, and where its image lies that is meant.
  struct Found {
    std::uint32_t place = 0;  ///< in the order of the tree
    Vector<D> center = Vector<D>::Zero();
    double gap = std::numeric_limits<double>::infinity();  ///< the distance from its surface, negative inside
  };

  SphereTree(const Spheres<D>& spheres, const Boundary<D>& boundary);

  std::size_t size() const { return radii_.size(); }
  // By place in the order of the tree; those of a node stand together.
  std::uint32_t id(std::uint32_t place) const { return tree_.order()[place]; }
  const Vector<D>& center(std::uint32_t place) const { return centers_[place]; }
  double radius(std::uint32_t place) const { return radii_[place]; }

  /// The sphere whose surface is nearest to p. Of an axis with a period the images next to the one that p is
  /// in are enough. Precondition: p anywhere.
  Found nearest(const Vector<D>& p) const;

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
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// From which t on the moving ball may touch spheres of a node; infinite where it does not before `limit`.
  static double entry(const Node& node, const Vector<D>& p, double r, const Vector<D>& u, double limit);

  Boundary<D> boundary_;
  std::vector<Vector<D>> shifts_;  // none first, as that is where most is found
  BoxTree<D> tree_;
  std::vector<Vector<D>> centers_;
  std::vector<double> radii_;
};

}  // namespace bernal
