#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "bernal/core/tolerance.hpp"
#include "bernal/domain/container.hpp"
#include "cad/wall_tree.hpp"
#include "domain/free_path.hpp"
#include "domain/wall_contacts.hpp"
#include "kernels/closest_point.hpp"
#include "kernels/first_contact.hpp"

namespace bernal::cad {

/// p minus the point of the box nearest to it.
inline Vector<3> offset(const Vector<3>& p, const CGAL::Bbox_3& box) {
  const Vector<3> lower(box.xmin(), box.ymin(), box.zmin());
  const Vector<3> upper(box.xmax(), box.ymax(), box.zmax());
  return (p - upper).cwiseMax(0.0) - (lower - p).cwiseMax(0.0);
}

inline double squared_distance(const Vector<3>& p, const CGAL::Bbox_3& box) {
  const Vector<3> lower(box.xmin(), box.ymin(), box.zmin());
  const Vector<3> upper(box.xmax(), box.ymax(), box.zmax());
  return (lower - p).cwiseMax(p - upper).cwiseMax(0.0).squaredNorm();
}

inline double distance(const Vector<3>& p, const WallTriangle& t) {
  return PreparedTriangle(t.a, t.b, t.c).offset(p).norm();
}

// The traversals below follow CGAL's traversal traits: `do_intersect` decides whether to enter a node,
// `intersection` visits a leaf, `go_further` decides whether to continue; with priorities, the higher is
// entered first.

/// Skips no triangle.
struct NoFilter {
  static bool skips(const Vector<3>&, const Node&, const OrientedBox&) { return false; }
  static bool skips(const Vector<3>&, const Leaf&) { return false; }
  static bool skips(const WallContact&) { return false; }
};

/// Skips what the known contacts of a ball of radius r cover, nearly everything on a fine wall. The known
/// contacts are nearer than all that is not skipped, to rounding.
struct Uncovered {
  std::span<const WallContact> known;
  double r;

  bool skips(const Vector<3>& c, const Node& node, const OrientedBox& oriented) const {
    if (known.empty()) return false;
    const CGAL::Bbox_3& box = node.bbox();
    const Bounds<3> bounds{{box.xmin(), box.ymin(), box.zmin()}, {box.xmax(), box.ymax(), box.zmax()}};
    return std::ranges::any_of(known, [&](const WallContact& contact) {
      return oriented.depth_along(contact.normal, c) > spoken_depth(contact, r) ||
             speaks_for_all(contact, bounds, c, r);
    });
  }
  bool skips(const Vector<3>& c, const Leaf& leaf) const {
    return std::ranges::any_of(known, [&](const WallContact& contact) {
      return leaf.depth_along(contact.normal, c) > spoken_depth(contact, r);
    });
  }
  bool skips(const WallContact& found) const {
    return !(found.distance > 0) || is_spoken_for(known, found, r);
  }
};

/// Finds the triangle nearest to p and nearer than the bound, among those that `Among` does not skip.
template <class Among = NoFilter>
class NearestTraversal {
 public:
  using Priority = double;
  NearestTraversal(const WallTree& tree, double bound, double slack = 0, Among among = {})
      : tree_(tree), slack_(slack), among_(among) {
    set_bound(bound);
  }

  bool go_further() const { return true; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    return do_intersect_with_priority(p, node).first;
  }
  std::pair<bool, Priority> do_intersect_with_priority(const Vector<3>& p, const Node& node) const {
    double squared = squared_distance(p, node.bbox());
    if (squared >= squared_bound_) return {false, -squared};
    const OrientedBox& oriented = tree_.oriented(node);
    squared = std::max(squared, oriented.squared_distance(p));
    return {squared < bound_ * bound_ && !among_.skips(p, node, oriented), -squared};
  }
  template <typename Iterator>
  void traverse_group(const Vector<3>& p, Iterator first, Iterator last) {
    for (; first != last; ++first) intersection(p, *first);
  }
  void intersection(const Vector<3>& p, const Leaf& leaf) {
    // Rejects triangles that cannot be nearer, to rounding, by cheap bounds: nearly all in the ball on a
    // smooth wall.
    const double enough = bound_ * (1 - 4 * tolerance::roundoff);
    if (leaf.depth_along(nearest_.normal, p) >= enough || leaf.depth_along_normal(p) >= enough) return;
    if (among_.skips(p, leaf)) return;
    const WallTriangle& t = leaf.triangle();
    const Vector<3> offset = PreparedTriangle(t.a, t.b, t.c).offset(p);
    const double d = offset.norm();
    if (d >= bound_) return;
    const WallContact found{d > 0 ? Vector<3>(offset / d) : Vector<3>::Zero(), d};
    if (among_.skips(found)) return;
    nearest_ = found;
    set_bound(d);
  }
  double bound() const { return bound_; }
  /// Its normal is zero if there is none, or if p is on the wall.
  const WallContact& nearest() const { return nearest_; }

 private:
  void set_bound(double bound) {
    bound_ = bound;
    const double of_boxes = std::max(0.0, bound - slack_);
    squared_bound_ = of_boxes * of_boxes;
  }

  const WallTree& tree_;
  double bound_, squared_bound_, slack_;
  Among among_;
  WallContact nearest_{Vector<3>::Zero(), 0};
};

/// Ends at the first triangle for which `clears(triangle)` is false, among those whose boxes reach into the
/// ball of radius r, widened by the rounding of the boxes' distances.
template <typename Clears>
class ClearsTraversal {
 public:
  ClearsTraversal(const WallTree& tree, double r, Clears clears_triangle)
      : tree_(tree),
        r_(r),
        squared_reach_(r * r * (1 + 32 * tolerance::roundoff)),
        clears_triangle_(clears_triangle) {}

  bool go_further() const { return clears_; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    return squared_distance(p, node.bbox()) <= squared_reach_ && !tree_.oriented(node).is_beyond(p, r_);
  }
  void intersection(const Vector<3>&, const Leaf& leaf) { clears_ = clears_triangle_(leaf.triangle()); }
  bool clears() const { return clears_; }

 private:
  const WallTree& tree_;
  double r_, squared_reach_;
  Clears clears_triangle_;
  bool clears_ = true;
};

/// Ends once more than `most` are found.
class WithinTraversal {
 public:
  WithinTraversal(const WallTree& tree, double reach, std::size_t most, std::vector<NearFacet>& out)
      : tree_(tree), reach_(reach), most_(most), before_(out.size()), out_(out) {}

  bool go_further() const { return out_.size() - before_ <= most_; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    return squared_distance(p, node.bbox()) < reach_ * reach_ && !tree_.oriented(node).is_beyond(p, reach_);
  }
  void intersection(const Vector<3>& p, const Leaf& leaf) {
    const WallTriangle& t = leaf.triangle();
    const double d = distance(p, t);
    if (d < reach_) out_.push_back({d, {Facet::Kind::triangle, t.id, t.a, t.b, t.c, 0}});
  }

 private:
  const WallTree& tree_;
  double reach_;
  std::size_t most_, before_;
  std::vector<NearFacet>& out_;
};

/// A lower bound on how far a point at c can move along the direction before it comes within `reach` of the
/// box; infinity if it never does. The bound is that of the plane through the box's nearest point, normal to
/// the offset, with the box behind it.
inline double entry(const Vector<3>& c, const Vector<3>& direction, double reach, const CGAL::Bbox_3& box) {
  const Vector<3> from_box = offset(c, box);
  const double squared = from_box.squaredNorm();
  if (squared <= reach * reach) return 0;
  const double approach = -from_box.dot(direction);
  if (approach <= 0) return std::numeric_limits<double>::infinity();
  return (squared - reach * std::sqrt(squared)) / approach;
}

/// The same, iterated: when one plane allows no further movement the next is taken, until the point may come
/// within `reach` or has gone `way`. A ball that slides along a wide flat wall is close to much of it but
/// reaches little.
inline double entry(const Vector<3>& c, const Vector<3>& direction, double reach, double way,
                    const CGAL::Bbox_3& box) {
  constexpr int most_planes = 8;
  double t = 0;
  for (int k = 0; k < most_planes && t <= way; ++k) {
    const double further = entry(c + t * direction, direction, reach, box);
    if (further == 0) break;
    t += further;
  }
  return t;
}

/// A moving sphere. A box is entered if the sphere, widened by its skin, may reach it before the first
/// contact so far. Rounding of that test is far below the half skin within which a triangle may be ignored.
class MoveTraversal {
 public:
  using Priority = double;
  MoveTraversal(const WallTree& tree, double r, const Vector<3>& direction, double limit, double skin)
      : tree_(tree), r_(r), skin_(skin), reach_(r + skin), limit_(limit), direction_(direction) {}

  bool go_further() const { return limit_ > 0; }
  bool do_intersect(const Vector<3>& c, const Node& node) const {
    return do_intersect_with_priority(c, node).first;
  }
  std::pair<bool, Priority> do_intersect_with_priority(const Vector<3>& c, const Node& node) const {
    const double t = entry(c, direction_, reach_, limit_, node.bbox());
    return {t <= limit_ && !tree_.oriented(node).is_beyond(c, reach_ + limit_), -t};
  }
  template <typename Iterator>
  void traverse_group(const Vector<3>& c, Iterator first, Iterator last) {
    for (; first != last; ++first) intersection(c, *first);
  }
  void intersection(const Vector<3>& c, const Leaf& leaf) {
    const double least = r_ + 0.75 * skin_;
    const Vector<3> step = limit_ * direction_;
    if (leaf.depth_along_normal(c, step) >= least || leaf.depth_along(towards_, c, step) >= least) return;
    const WallTriangle& t = leaf.triangle();
    const double limit = first_contact_with_triangle(c, r_, direction_, limit_, t.a, t.b, t.c, skin_);
    if (limit == limit_) return;
    limit_ = limit;
    towards_ = PreparedTriangle(t.a, t.b, t.c).offset(c + limit * direction_).normalized();
  }
  double limit() const { return limit_; }

 private:
  const WallTree& tree_;
  double r_, skin_, reach_, limit_;
  Vector<3> direction_;
  /// From the contact point of the first contact so far to the centre at that time.
  Vector<3> towards_ = Vector<3>::Zero();
};

/// The same without a skin: a box is skipped only if the sphere, widened by the rounding of a distance,
/// certainly does not reach it; every triangle in an entered box is decided as the arithmetic promises.
class PathTraversal {
 public:
  using Priority = double;
  PathTraversal(const WallTree& tree, const Motion& motion, double bound, WallArithmetic arithmetic)
      : tree_(tree),
        motion_(motion),
        unit_(motion.direction.stableNormalized()),
        speed_(motion.direction.stableNorm()),
        reach_(motion.r + bound),
        arithmetic_(arithmetic) {}

  bool go_further() const { return motion_.limit > 0; }
  bool do_intersect(const Vector<3>& c, const Node& node) const {
    return do_intersect_with_priority(c, node).first;
  }
  std::pair<bool, Priority> do_intersect_with_priority(const Vector<3>& c, const Node& node) const {
    const double way = motion_.limit * speed_ + reach_ - motion_.r;
    const double t = entry(c, unit_, reach_, way, node.bbox());
    return {t <= way && !tree_.oriented(node).is_beyond(c, reach_ + way), -t};
  }
  template <typename Iterator>
  void traverse_group(const Vector<3>& c, Iterator first, Iterator last) {
    for (; first != last; ++first) intersection(c, *first);
  }
  void intersection(const Vector<3>&, const Leaf& leaf) {
    const WallTriangle& t = leaf.triangle();
    motion_.limit = bernal::free_path(Corners{t.a, t.b, t.c}, motion_, arithmetic_);
  }
  double limit() const { return motion_.limit; }

 private:
  const WallTree& tree_;
  Motion motion_;
  Vector<3> unit_;
  double speed_, reach_;
  WallArithmetic arithmetic_;
};

}  // namespace bernal::cad
