#include "cad/triangle_tree.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bernal/core/tolerance.hpp"
#include "cad/bounding_disc.hpp"
#include "cad/certified_distance.hpp"
#include "core/parallel.hpp"
#include "domain/wall_contacts.hpp"
#include "kernels/closest_point.hpp"
#include "kernels/first_contact.hpp"

namespace bernal::cad {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// So many triangles are looked at one by one: that is cheaper than the boxes of the last levels of the tree.
constexpr std::size_t group = 4;

Kernel::Point_3 to_cgal(const Vector<3>& p) { return {p[0], p[1], p[2]}; }

/// The tree's leaves own their triangles, so that a query reads them in the order of the tree.
class Leaf {
 public:
  using Id = std::uint32_t;
  using Point = Kernel::Point_3;
  using Datum = Kernel::Triangle_3;

  explicit Leaf(std::vector<WallTriangle>::const_iterator triangle)
      : triangle_(*triangle),
        normal_((triangle->b - triangle->a).cross(triangle->c - triangle->a).normalized()) {}
  const WallTriangle& triangle() const { return triangle_; }
  const Vector<3>& normal() const { return normal_; }

  /// min u·(p - v) over the vertices v: a lower bound of the distance of p for every unit vector u.
  double depth_along(const Vector<3>& u, const Vector<3>& p,
                     const Vector<3>& step = Vector<3>::Zero()) const {
    return std::min(std::min(u.dot(p - triangle_.a), u.dot(p - triangle_.b)), u.dot(p - triangle_.c)) +
           std::min(u.dot(step), 0.0);
  }
  /// That bound for the better of both normals and all points between p and p + step. Where the triangle is a
  /// needle its normal is inaccurate, and the bound still is one.
  double depth_along_normal(const Vector<3>& p, const Vector<3>& step = Vector<3>::Zero()) const {
    const double a = normal_.dot(p - triangle_.a), b = normal_.dot(p - triangle_.b),
                 c = normal_.dot(p - triangle_.c), s = normal_.dot(step);
    const double above = std::min(std::min(a, b), c) + std::min(s, 0.0);
    const double below = -std::max(std::max(a, b), c) - std::max(s, 0.0);
    return std::max(above, below);
  }
  Id id() const { return triangle_.id; }
  Point reference_point() const { return to_cgal(triangle_.a); }
  Datum datum() const { return {to_cgal(triangle_.a), to_cgal(triangle_.b), to_cgal(triangle_.c)}; }

 private:
  WallTriangle triangle_;
  Vector<3> normal_;
};

using TreeTraits = CGAL::AABB_traits<Kernel, Leaf>;
using Tree = CGAL::AABB_tree<TreeTraits>;
using Node = CGAL::AABB_node<TreeTraits>;

/// Beside the box of each node a disc, where the node is larger than what is looked at one by one and small
/// enough to be flat.
class Discs {
 public:
  Discs() = default;
  Discs(const Tree& tree, double extent) {
    constexpr double in_single_precision = 1e30;
    if (tree.size() < 2) return;  // it has no nodes
    root_ = tree.root_node();
    discs_.resize(tree.size() - 1);
    if (!(extent < in_single_precision && extent > 1 / in_single_precision)) return;
    std::vector<std::pair<const Node*, std::size_t>> tops;
    collect(*root_, tree.size(), tops);
    parallel_for(tops.size(), [&](std::size_t k) { cover(*tops[k].first, tops[k].second, extent); });
  }

  const BoundingDisc& operator[](const Node& node) const {
    return discs_[static_cast<std::size_t>(&node - root_)];
  }

 private:
  static constexpr std::size_t most_leaves = 4096;

  /// Calls visit(child, its number of leaves) for those children that are nodes.
  template <class Visit>
  static void for_each_child(const Node& node, std::size_t leaves, const Visit& visit) {
    if (leaves > 3) visit(node.left_child(), leaves / 2);
    if (leaves > 2) visit(node.right_child(), leaves - (leaves > 3 ? leaves / 2 : 1));
  }
  static void collect(const Node& node, std::size_t leaves,
                      std::vector<std::pair<const Node*, std::size_t>>& tops) {
    if (leaves <= most_leaves) {
      tops.emplace_back(&node, leaves);
      return;
    }
    for_each_child(node, leaves, [&](const Node& child, std::size_t n) { collect(child, n, tops); });
  }
  /// The leaves of a node stand one after the other.
  static const Leaf* first_leaf(const Node* node, std::size_t leaves) {
    for (; leaves > 3; leaves /= 2) node = &node->left_child();
    return &node->left_data();
  }
  void cover(const Node& node, std::size_t leaves, double extent) {
    if (leaves <= group) return;
    discs_[static_cast<std::size_t>(&node - root_)] =
        BoundingDisc(std::span(first_leaf(&node, leaves), leaves), extent);
    for_each_child(node, leaves, [&](const Node& child, std::size_t n) { cover(child, n, extent); });
  }

  const Node* root_ = nullptr;
  std::vector<BoundingDisc> discs_;
};

/// p minus the point of the box nearest to it.
Vector<3> offset(const Vector<3>& p, const CGAL::Bbox_3& box) {
  const Vector<3> lower(box.xmin(), box.ymin(), box.zmin());
  const Vector<3> upper(box.xmax(), box.ymax(), box.zmax());
  return (p - upper).cwiseMax(0.0) - (lower - p).cwiseMax(0.0);
}

double squared_distance(const Vector<3>& p, const CGAL::Bbox_3& box) {
  const Vector<3> lower(box.xmin(), box.ymin(), box.zmin());
  const Vector<3> upper(box.xmax(), box.ymax(), box.zmax());
  return (lower - p).cwiseMax(p - upper).cwiseMax(0.0).squaredNorm();
}

double distance(const Vector<3>& p, const WallTriangle& t) {
  return PreparedTriangle(t.a, t.b, t.c).offset(p).norm();
}

// The traversals below follow CGAL's concept of traversal traits: `do_intersect` says whether to enter a
// node, `intersection` visits a leaf, `go_further` whether to go on; with priorities, the higher is entered
// first.

class NearestTraversal {
 public:
  using Priority = double;
  explicit NearestTraversal(const Discs& discs, double bound, double slack = 0)
      : discs_(discs), slack_(slack) {
    set_bound(bound);
  }

  bool go_further() const { return true; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    return do_intersect_with_priority(p, node).first;
  }
  std::pair<bool, Priority> do_intersect_with_priority(const Vector<3>& p, const Node& node) const {
    const double squared = squared_distance(p, node.bbox());
    return {squared < squared_bound_ && !discs_[node].is_beyond(p, bound_), -squared};
  }
  template <typename Iterator>
  void traverse_group(const Vector<3>& p, Iterator first, Iterator last) {
    for (; first != last; ++first) intersection(p, *first);
  }
  void intersection(const Vector<3>& p, const Leaf& leaf) {
    // Triangles that cannot be nearer, but for a rounding, cost no more than these bounds: on a smooth wall
    // that is nearly all of those whose boxes reach into the ball.
    const double enough = bound_ * (1 - 4 * tolerance::roundoff);
    if (leaf.depth_along(towards_, p) >= enough || leaf.depth_along_normal(p) >= enough) return;
    const WallTriangle& t = leaf.triangle();
    const Vector<3> offset = PreparedTriangle(t.a, t.b, t.c).offset(p);
    const double d = offset.norm();
    if (d >= bound_) return;
    set_bound(d);
    if (d > 0) towards_ = offset / d;
  }
  double bound() const { return bound_; }

 private:
  void set_bound(double bound) {
    bound_ = bound;
    const double of_boxes = std::max(0.0, bound - slack_);
    squared_bound_ = of_boxes * of_boxes;
  }

  const Discs& discs_;
  double bound_, squared_bound_, slack_;
  Vector<3> towards_ = Vector<3>::Zero();  ///< from the nearest point so far to p
};

/// Ends at the first triangle for which `clears(triangle)` is false, among those whose boxes reach into the
/// ball of radius r; the radius is widened by the rounding of the boxes' distances.
template <typename Clears>
class ClearsTraversal {
 public:
  ClearsTraversal(const Discs& discs, double r, Clears clears_triangle)
      : discs_(discs),
        r_(r),
        squared_reach_(r * r * (1 + 32 * tolerance::roundoff)),
        clears_triangle_(clears_triangle) {}

  bool go_further() const { return clears_; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    return squared_distance(p, node.bbox()) <= squared_reach_ && !discs_[node].is_beyond(p, r_);
  }
  void intersection(const Vector<3>&, const Leaf& leaf) { clears_ = clears_triangle_(leaf.triangle()); }
  bool clears() const { return clears_; }

 private:
  const Discs& discs_;
  double r_, squared_reach_;
  Clears clears_triangle_;
  bool clears_ = true;
};

/// Ends where more than `most` are found.
class WithinTraversal {
 public:
  WithinTraversal(const Discs& discs, double reach, std::size_t most, std::vector<NearFacet>& out)
      : discs_(discs), reach_(reach), most_(most), before_(out.size()), out_(out) {}

  bool go_further() const { return out_.size() - before_ <= most_; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    return squared_distance(p, node.bbox()) < reach_ * reach_ && !discs_[node].is_beyond(p, reach_);
  }
  void intersection(const Vector<3>& p, const Leaf& leaf) {
    const WallTriangle& t = leaf.triangle();
    const double d = distance(p, t);
    if (d < reach_) out_.push_back({d, {Facet::Kind::triangle, t.id, t.a, t.b, t.c, 0}});
  }

 private:
  const Discs& discs_;
  double reach_;
  std::size_t most_, before_;
  std::vector<NearFacet>& out_;
};

/// Looks for the contacts of a ball. What a nearer contact that is known already speaks for is not entered,
/// and so a fine wall costs hardly more than its nearest triangle.
class ContactTraversal {
 public:
  using Priority = double;
  ContactTraversal(const Discs& discs, double r, DistinctContacts& contacts)
      : discs_(discs), r_(r), contacts_(contacts) {}

  bool go_further() const { return true; }
  bool do_intersect(const Vector<3>& c, const Node& node) const {
    return do_intersect_with_priority(c, node).first;
  }
  std::pair<bool, Priority> do_intersect_with_priority(const Vector<3>& c, const Node& node) const {
    const CGAL::Bbox_3& box = node.bbox();
    const BoundingDisc& disc = discs_[node];
    const double squared = squared_distance(c, box);
    if (squared >= r_ * r_ || disc.is_beyond(c, r_)) return {false, -squared};
    const Bounds<3> bounds{{box.xmin(), box.ymin(), box.zmin()}, {box.xmax(), box.ymax(), box.zmax()}};
    const bool is_spoken_for = contacts_.any([&](const WallContact& known) {
      const double nearer = (1 - in_line) * known.distance;
      if (squared < nearer * nearer && !disc.is_beyond(c, nearer)) return false;
      return disc.depth_along(known.normal, c) > known.distance - in_plane * r_ ||
             speaks_for_all(known, bounds, c, r_);
    });
    return {!is_spoken_for, -squared};
  }
  template <typename Iterator>
  void traverse_group(const Vector<3>& c, Iterator first, Iterator last) {
    for (; first != last; ++first) intersection(c, *first);
  }
  void intersection(const Vector<3>& c, const Leaf& leaf) {
    if (leaf.depth_along_normal(c) >= r_) return;
    const WallTriangle& t = leaf.triangle();
    const Vector<3> offset = PreparedTriangle(t.a, t.b, t.c).offset(c);
    const double d = offset.norm();
    if (d < r_ && d > 0) contacts_.add({offset / d, d});
  }

 private:
  /// Of a distance, by which what lies in one plane may seem nearer.
  static constexpr double in_line = 1e-9;

  const Discs& discs_;
  double r_;
  DistinctContacts& contacts_;
};

/// A sphere on its way. A box is entered if the sphere, widened by its skin, may reach it before the first
/// contact so far. Rounding of that test is far below the half skin by which a triangle may be ignored.
class MoveTraversal {
 public:
  using Priority = double;
  MoveTraversal(const Discs& discs, double r, const Vector<3>& direction, double limit, double skin)
      : discs_(discs), r_(r), skin_(skin), reach_(r + skin), limit_(limit), direction_(direction) {}

  bool go_further() const { return limit_ > 0; }
  bool do_intersect(const Vector<3>& c, const Node& node) const {
    return do_intersect_with_priority(c, node).first;
  }
  std::pair<bool, Priority> do_intersect_with_priority(const Vector<3>& c, const Node& node) const {
    const double t = entry(c, node.bbox());
    return {t <= limit_ && !discs_[node].is_beyond(c, reach_ + limit_), -t};
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
  /// How far the centre can move, at least, before it comes within reach of the box; infinity if it never
  /// does. The plane through the box's nearest point, across the offset, has the box behind it: so far the
  /// plane allows.
  double entry(const Vector<3>& c, const CGAL::Bbox_3& box) const {
    const Vector<3> from_box = offset(c, box);
    const double squared = from_box.squaredNorm();
    if (squared <= reach_ * reach_) return 0;
    const double approach = -from_box.dot(direction_);
    if (approach <= 0) return std::numeric_limits<double>::infinity();
    return (squared - reach_ * std::sqrt(squared)) / approach;
  }

  const Discs& discs_;
  double r_, skin_, reach_, limit_;
  Vector<3> direction_;
  Vector<3> towards_ = Vector<3>::Zero();  ///< from the point of the first contact so far to the centre there
};

/// Counts the triangles that the way from p along an axis crosses, as seen along that axis: not from p itself
/// but from p' = p + (epsilon², epsilon) in the plane across, for an infinitesimal epsilon > 0, so that no
/// edge and no vertex is ever hit. Predicates are exact. Sees also whether p itself is on a triangle.
template <typename Ignored>
class CrossingTraversal {
 public:
  CrossingTraversal(const Vector<3>& p, int axis, double end, const Ignored& ignored)
      : ignored_(ignored),
        start_(to_cgal(p)),
        axis_(axis),
        u_((axis + 1) % 3),
        v_((axis + 2) % 3),
        low_(std::min(p[axis], end)),
        high_(std::max(p[axis], end)),
        upwards_(end > p[axis]) {
    Vector<3> far_end = p;
    far_end[axis] = end;
    end_ = to_cgal(far_end);
  }

  bool go_further() const { return !on_wall_; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    const CGAL::Bbox_3& box = node.bbox();
    return box.min(u_) <= p[u_] && p[u_] <= box.max(u_) && box.min(v_) <= p[v_] && p[v_] <= box.max(v_) &&
           box.min(axis_) <= high_ && low_ <= box.max(axis_);
  }
  void intersection(const Vector<3>& p, const Leaf& leaf) {
    const WallTriangle& t = leaf.triangle();
    if (ignored_(t.id)) return;
    const Kernel::Point_3 a = to_cgal(t.a), b = to_cgal(t.b), c = to_cgal(t.c);
    const int start_side = CGAL::orientation(a, b, c, start_);
    if (start_side == 0 && leaf.datum().has_on(start_)) {
      on_wall_ = true;
      return;
    }
    const int ab = turn(t.a, t.b, p);
    if (ab == 0 || turn(t.b, t.c, p) != ab || turn(t.c, t.a, p) != ab) return;
    // p' is in the triangle's shadow, which runs counterclockwise if ab > 0.
    const int end_side =
        std::isinf(low_) || std::isinf(high_) ? (upwards_ ? ab : -ab) : CGAL::orientation(a, b, c, end_);
    odd_ ^= start_side != end_side;
  }
  Crossing crossing() const {
    return on_wall_ ? Crossing::starts_on_wall : odd_ ? Crossing::odd : Crossing::even;
  }

 private:
  Kernel::Point_2 seen(const Vector<3>& p) const { return {p[u_], p[v_]}; }

  /// The turn a -> b -> p' seen along the axis: that of p, and where p is in line the terms of its first and
  /// second order in epsilon. 0 only for an edge that is seen as a point, and then its triangle as a line.
  int turn(const Vector<3>& a, const Vector<3>& b, const Vector<3>& p) const {
    if (const int s = CGAL::orientation(seen(a), seen(b), seen(p)); s != 0) return s;
    if (a[u_] != b[u_]) return a[u_] < b[u_] ? 1 : -1;
    if (a[v_] != b[v_]) return a[v_] < b[v_] ? -1 : 1;
    return 0;
  }

  const Ignored& ignored_;
  Kernel::Point_3 start_, end_;
  int axis_, u_, v_;
  double low_, high_;
  bool upwards_;
  bool on_wall_ = false, odd_ = false;
};

}  // namespace

struct TriangleTree::Impl {
  Tree tree;
  Discs discs;
};

TriangleTree::TriangleTree(const Mesh& mesh) : impl_(std::make_unique<Impl>()) {
  std::vector<WallTriangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [i, j, k] : mesh.triangles) {
    const auto id = static_cast<std::uint32_t>(triangles.size());
    triangles.push_back({mesh.vertices[i], mesh.vertices[j], mesh.vertices[k], id});
  }
  impl_->tree.insert(triangles.cbegin(), triangles.cend());
  impl_->tree.do_not_accelerate_distance_queries();
  impl_->tree.build();  // now, because queries are const and concurrent
  double extent = 0;
  for (const Vector<3>& v : mesh.vertices) extent = std::max(extent, v.cwiseAbs().maxCoeff());
  impl_->discs = Discs(impl_->tree, extent);
}

TriangleTree::~TriangleTree() = default;
TriangleTree::TriangleTree(TriangleTree&&) noexcept = default;

double TriangleTree::distance(const Vector<3>& p, double bound) const {
  NearestTraversal traversal(impl_->discs, bound);
  impl_->tree.traversal_with_priority_and_group_traversal(p, traversal, group);
  return traversal.bound();
}

double TriangleTree::rough_distance(const Vector<3>& p, double bound, double slack) const {
  NearestTraversal traversal(impl_->discs, bound, slack);
  impl_->tree.traversal_with_priority_and_group_traversal(p, traversal, group);
  return traversal.bound();
}

bool TriangleTree::clears(const Vector<3>& c, double r, WallArithmetic arithmetic) const {
  const auto search = [&](auto clears_triangle) {
    ClearsTraversal traversal(impl_->discs, r, clears_triangle);
    impl_->tree.traversal(c, traversal);
    return traversal.clears();
  };
  switch (arithmetic) {
    case WallArithmetic::plain:
      return search([&](const WallTriangle& t) { return cad::distance(c, t) >= r; });
    case WallArithmetic::filtered:
      return search([&](const WallTriangle& t) { return certainly_clears(c, t, r); });
    case WallArithmetic::exact:
      break;
  }
  return search([&](const WallTriangle& t) { return exactly_clears(c, t, r); });
}

bool TriangleTree::within(const Vector<3>& c, double reach, std::vector<NearFacet>& out,
                          std::size_t most) const {
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  WithinTraversal traversal(impl_->discs, reach, most, out);
  impl_->tree.traversal(c, traversal);
  if (!traversal.go_further()) return false;
  std::sort(out.begin() + first, out.end(), [](const NearFacet& m, const NearFacet& n) {
    return std::pair(m.distance, m.facet.id) < std::pair(n.distance, n.facet.id);
  });
  return true;
}

void TriangleTree::contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const {
  DistinctContacts contacts(r, out);
  ContactTraversal traversal(impl_->discs, r, contacts);
  impl_->tree.traversal_with_priority_and_group_traversal(c, traversal, group);
  contacts.sort();
}

double TriangleTree::first_contact(const Vector<3>& c, double r, const Vector<3>& direction, double limit,
                                   double skin) const {
  MoveTraversal traversal(impl_->discs, r, direction, limit, skin);
  impl_->tree.traversal_with_priority_and_group_traversal(c, traversal, group);
  return traversal.limit();
}

namespace {

template <typename Ignored>
Crossing crossing_in(const Tree& tree, const Vector<3>& p, int axis, double end, const Ignored& ignored) {
  CrossingTraversal traversal(p, axis, end, ignored);
  tree.traversal(p, traversal);
  return traversal.crossing();
}

}  // namespace

Crossing TriangleTree::crossing(const Vector<3>& p, int axis, double end) const {
  return crossing_in(impl_->tree, p, axis, end, [](std::uint32_t) { return false; });
}

Crossing TriangleTree::crossing(const Vector<3>& p, int axis, double end,
                                const std::function<bool(std::uint32_t)>& ignored) const {
  return crossing_in(impl_->tree, p, axis, end, ignored);
}

}  // namespace bernal::cad
