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

Kernel::Point_3 to_cgal(const Vector<3>& p) { return {p[0], p[1], p[2]}; }
Kernel::Point_2 seen_from_above(const Vector<3>& p) { return {p[0], p[1]}; }

/// The tree's leaves own their triangles, so that a query reads them in the order of the tree.
class Leaf {
 public:
  using Id = std::uint32_t;
  using Point = Kernel::Point_3;
  using Datum = Kernel::Triangle_3;

  explicit Leaf(std::vector<WallTriangle>::const_iterator triangle) : triangle_(*triangle) {}
  const WallTriangle& triangle() const { return triangle_; }
  Id id() const { return triangle_.id; }
  Point reference_point() const { return to_cgal(triangle_.a); }
  Datum datum() const { return {to_cgal(triangle_.a), to_cgal(triangle_.b), to_cgal(triangle_.c)}; }

 private:
  WallTriangle triangle_;
};

using TreeTraits = CGAL::AABB_traits<Kernel, Leaf>;
using Tree = CGAL::AABB_tree<TreeTraits>;
using Node = CGAL::AABB_node<TreeTraits>;

double squared_distance(const Vector<3>& p, const CGAL::Bbox_3& box) {
  const double x = std::max({box.xmin() - p[0], 0.0, p[0] - box.xmax()});
  const double y = std::max({box.ymin() - p[1], 0.0, p[1] - box.ymax()});
  const double z = std::max({box.zmin() - p[2], 0.0, p[2] - box.zmax()});
  return x * x + y * y + z * z;
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
  explicit NearestTraversal(double bound) : bound_(bound), squared_bound_(bound * bound) {}

  bool go_further() const { return true; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    return squared_distance(p, node.bbox()) < squared_bound_;
  }
  std::pair<bool, Priority> do_intersect_with_priority(const Vector<3>& p, const Node& node) const {
    const double squared = squared_distance(p, node.bbox());
    return {squared < squared_bound_, -squared};
  }
  void intersection(const Vector<3>& p, const Leaf& leaf) {
    const double d = distance(p, leaf.triangle());
    if (d >= bound_) return;
    bound_ = d;
    squared_bound_ = d * d;
  }
  double bound() const { return bound_; }

 private:
  double bound_, squared_bound_;
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

/// A sphere on its way. A box is entered if the way, up to the first contact so far, crosses the box widened
/// by the sphere's radius and skin. Rounding of that test is far below the half skin by which a triangle may
/// be ignored.
class MoveTraversal {
 public:
  using Priority = double;
  MoveTraversal(double r, const Vector<3>& direction, double limit, double skin)
      : r_(r), skin_(skin), reach_(r + skin), limit_(limit), direction_(direction) {
    // A component of zero never enters or leaves a slab: a tiny one instead spares the case 0·infinity.
    for (int k = 0; k < 3; ++k)
      per_direction_[k] =
          1 / (std::abs(direction[k]) < 1e-200 ? std::copysign(1e-200, direction[k]) : direction[k]);
  }

  bool go_further() const { return limit_ > 0; }
  bool do_intersect(const Vector<3>& c, const Node& node) const { return entry(c, node.bbox()) <= limit_; }
  std::pair<bool, Priority> do_intersect_with_priority(const Vector<3>& c, const Node& node) const {
    const double t = entry(c, node.bbox());
    return {t <= limit_, -t};
  }
  void intersection(const Vector<3>& c, const Leaf& leaf) {
    const WallTriangle& t = leaf.triangle();
    limit_ = first_contact_with_triangle(c, r_, direction_, limit_, t.a, t.b, t.c, skin_);
  }
  double limit() const { return limit_; }

 private:
  /// How far the centre moves until it enters the widened box; infinity if it never does.
  double entry(const Vector<3>& c, const CGAL::Bbox_3& box) const {
    double enter = 0, leave = limit_;
    for (int k = 0; k < 3; ++k) {
      const double t0 = (box.min(k) - reach_ - c[k]) * per_direction_[k];
      const double t1 = (box.max(k) + reach_ - c[k]) * per_direction_[k];
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
    }
    return enter <= leave ? enter : std::numeric_limits<double>::infinity();
  }

  double r_, skin_, reach_, limit_;
  Vector<3> direction_, per_direction_;
};

/// Counts the triangles straight above p' = p + (epsilon², epsilon, 0) for an infinitesimal epsilon > 0,
/// which no edge and no vertex lies above; sees whether p itself is on a triangle.
class AboveTraversal {
 public:
  bool go_further() const { return !on_wall_; }
  bool do_intersect(const Vector<3>& p, const Node& node) const {
    const CGAL::Bbox_3& box = node.bbox();
    return box.xmin() <= p[0] && p[0] <= box.xmax() && box.ymin() <= p[1] && p[1] <= box.ymax() &&
           p[2] <= box.zmax();
  }
  void intersection(const Vector<3>& p, const Leaf& leaf) {
    const WallTriangle& t = leaf.triangle();
    const int side = CGAL::orientation(to_cgal(t.a), to_cgal(t.b), to_cgal(t.c), to_cgal(p));
    if (side == 0 && leaf.datum().has_on(to_cgal(p))) {
      on_wall_ = true;
      return;
    }
    const int ab = turn(t.a, t.b, p);
    if (ab == 0 || turn(t.b, t.c, p) != ab || turn(t.c, t.a, p) != ab) return;
    // p' is in the triangle's shadow, which runs counterclockwise if ab > 0: then side < 0 means below.
    above_ += side * ab < 0;
  }
  Side side() const { return on_wall_ ? Side::wall : above_ % 2 == 1 ? Side::inside : Side::outside; }

 private:
  /// The turn a -> b -> p' seen from above: that of p, and where p is in line the terms of its first and
  /// second order in epsilon. 0 only for an edge that is seen as a point, and then its triangle as a line.
  static int turn(const Vector<3>& a, const Vector<3>& b, const Vector<3>& p) {
    if (const int s = CGAL::orientation(seen_from_above(a), seen_from_above(b), seen_from_above(p)); s != 0)
      return s;
    if (a[0] != b[0]) return a[0] < b[0] ? 1 : -1;
    if (a[1] != b[1]) return a[1] < b[1] ? -1 : 1;
    return 0;
  }

  bool on_wall_ = false;
  unsigned above_ = 0;
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
  impl_->tree.traversal_with_priority(p, traversal);
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
  impl_->tree.traversal_with_priority(c, traversal);
  return traversal.limit();
}

Side TriangleTree::side(const Vector<3>& p) const {
  AboveTraversal traversal;
  impl_->tree.traversal(p, traversal);
  return traversal.side();
}

}  // namespace bernal::cad
