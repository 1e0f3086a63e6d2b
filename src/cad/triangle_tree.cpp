#include "cad/triangle_tree.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bernal/core/tolerance.hpp"
#include "cad/certified_distance.hpp"
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
  explicit NearestTraversal(double bound, double slack = 0) : slack_(slack) { set_bound(bound); }

  bool go_further() const { return true; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    return squared_distance(p, node.bbox()) < squared_bound_;
  }
  std::pair<bool, Priority> do_intersect_with_priority(const Vector<3>& p, const Node& node) const {
    const double squared = squared_distance(p, node.bbox());
    return {squared < squared_bound_, -squared};
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

  double bound_, squared_bound_, slack_;
  Vector<3> towards_ = Vector<3>::Zero();  ///< from the nearest point so far to p
};

/// Ends at the first triangle for which `clears(triangle)` is false, among those whose boxes reach into the
/// ball of radius r; the radius is widened by the rounding of the boxes' distances.
template <typename Clears>
class ClearsTraversal {
 public:
  ClearsTraversal(double r, Clears clears_triangle)
      : squared_reach_(r * r * (1 + 32 * tolerance::roundoff)), clears_triangle_(clears_triangle) {}

  bool go_further() const { return clears_; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    return squared_distance(p, node.bbox()) <= squared_reach_;
  }
  void intersection(const Vector<3>&, const Leaf& leaf) { clears_ = clears_triangle_(leaf.triangle()); }
  bool clears() const { return clears_; }

 private:
  double squared_reach_;
  Clears clears_triangle_;
  bool clears_ = true;
};

class WithinTraversal {
 public:
  WithinTraversal(double reach, std::vector<NearFacet>& out) : reach_(reach), out_(out) {}

  bool go_further() const { return true; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    return squared_distance(p, node.bbox()) < reach_ * reach_;
  }
  void intersection(const Vector<3>& p, const Leaf& leaf) {
    const WallTriangle& t = leaf.triangle();
    const double d = distance(p, t);
    if (d < reach_) out_.push_back({d, {Facet::Kind::triangle, t.id, t.a, t.b, t.c, 0}});
  }

 private:
  double reach_;
  std::vector<NearFacet>& out_;
};

/// A sphere on its way. A box is entered if the sphere, widened by its skin, may reach it before the first
/// contact so far. Rounding of that test is far below the half skin by which a triangle may be ignored.
class MoveTraversal {
 public:
  using Priority = double;
  MoveTraversal(double r, const Vector<3>& direction, double limit, double skin)
      : r_(r), skin_(skin), reach_(r + skin), limit_(limit), direction_(direction) {}

  bool go_further() const { return limit_ > 0; }
  bool do_intersect(const Vector<3>& c, const Node& node) const { return entry(c, node.bbox()) <= limit_; }
  std::pair<bool, Priority> do_intersect_with_priority(const Vector<3>& c, const Node& node) const {
    const double t = entry(c, node.bbox());
    return {t <= limit_, -t};
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
}

TriangleTree::~TriangleTree() = default;
TriangleTree::TriangleTree(TriangleTree&&) noexcept = default;

double TriangleTree::distance(const Vector<3>& p, double bound) const {
  NearestTraversal traversal(bound);
  impl_->tree.traversal_with_priority_and_group_traversal(p, traversal, group);
  return traversal.bound();
}

double TriangleTree::rough_distance(const Vector<3>& p, double bound, double slack) const {
  NearestTraversal traversal(bound, slack);
  impl_->tree.traversal_with_priority_and_group_traversal(p, traversal, group);
  return traversal.bound();
}

bool TriangleTree::clears(const Vector<3>& c, double r, WallArithmetic arithmetic) const {
  const auto search = [&](auto clears_triangle) {
    ClearsTraversal traversal(r, clears_triangle);
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

void TriangleTree::within(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const {
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  WithinTraversal traversal(reach, out);
  impl_->tree.traversal(c, traversal);
  std::sort(out.begin() + first, out.end(), [](const NearFacet& m, const NearFacet& n) {
    return std::pair(m.distance, m.facet.id) < std::pair(n.distance, n.facet.id);
  });
}

double TriangleTree::first_contact(const Vector<3>& c, double r, const Vector<3>& direction, double limit,
                                   double skin) const {
  MoveTraversal traversal(r, direction, limit, skin);
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
