#include "cad/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cad/certified_distance.hpp"
#include "cad/tree_traversals.hpp"

namespace bernal::cad {
namespace {

/// Counts the triangles that the segment from p along an axis crosses, projected along that axis: not from p
/// itself but from p' = p + (epsilon², epsilon) in the normal plane, for an infinitesimal epsilon > 0, so
/// that no edge and no vertex is ever hit. Predicates are exact. Also detects whether p itself is on a
/// triangle.
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
    const WallKernel::Point_3 a = to_cgal(t.a), b = to_cgal(t.b), c = to_cgal(t.c);
    const int start_side = CGAL::orientation(a, b, c, start_);
    if (start_side == 0 && leaf.datum().has_on(start_)) {
      on_wall_ = true;
      return;
    }
    const int ab = turn(t.a, t.b, p);
    if (ab == 0 || turn(t.b, t.c, p) != ab || turn(t.c, t.a, p) != ab) return;
    // p' projects into the triangle, which runs counterclockwise if ab > 0.
    const int end_side =
        std::isinf(low_) || std::isinf(high_) ? (upwards_ ? ab : -ab) : CGAL::orientation(a, b, c, end_);
    if (start_side != end_side) outwards_ += upwards_ ? ab : -ab;
  }
  Crossing crossing() const {
    return on_wall_ ? Crossing::starts_on_wall : outwards_ % 2 != 0 ? Crossing::odd : Crossing::even;
  }
  /// Triangles crossed from back to front minus those crossed from front to back.
  int outwards() const { return outwards_; }

 private:
  WallKernel::Point_2 seen(const Vector<3>& p) const { return {p[u_], p[v_]}; }

  /// Orientation of a, b, p' in projection: that of p, and if p is collinear the terms of first and second
  /// order in epsilon. 0 only for an edge that projects to a point, so its triangle projects to a line.
  int turn(const Vector<3>& a, const Vector<3>& b, const Vector<3>& p) const {
    if (const int s = CGAL::orientation(seen(a), seen(b), seen(p)); s != 0) return s;
    if (a[u_] != b[u_]) return a[u_] < b[u_] ? 1 : -1;
    if (a[v_] != b[v_]) return a[v_] < b[v_] ? -1 : 1;
    return 0;
  }

  const Ignored& ignored_;
  WallKernel::Point_3 start_, end_;
  int axis_, u_, v_;
  double low_, high_;
  bool upwards_;
  bool on_wall_ = false;
  int outwards_ = 0;
};

}  // namespace

TriangleTree::TriangleTree(const Mesh& mesh) : tree_(std::make_unique<WallTree>(mesh)) {}
TriangleTree::~TriangleTree() = default;
TriangleTree::TriangleTree(TriangleTree&&) noexcept = default;

double TriangleTree::distance(const Vector<3>& p, double bound) const {
  NearestTraversal<> traversal(*tree_, bound);
  tree_->search_nearest_first(p, traversal);
  return traversal.bound();
}

double TriangleTree::rough_distance(const Vector<3>& p, double bound, double slack) const {
  NearestTraversal<> traversal(*tree_, bound, slack);
  tree_->search_nearest_first(p, traversal);
  return traversal.bound();
}

bool TriangleTree::clears(const Vector<3>& c, double r, WallArithmetic arithmetic) const {
  const auto search = [&](auto clears_triangle) {
    ClearsTraversal traversal(*tree_, r, clears_triangle);
    tree_->tree().traversal(c, traversal);
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
  WithinTraversal traversal(*tree_, reach, most, out);
  tree_->tree().traversal(c, traversal);
  if (!traversal.go_further()) return false;
  std::sort(out.begin() + first, out.end(), [](const NearFacet& m, const NearFacet& n) {
    return std::pair(m.distance, m.facet.id) < std::pair(n.distance, n.facet.id);
  });
  return true;
}

void TriangleTree::contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const {
  const std::size_t before = out.size();
  for (;;) {
    NearestTraversal traversal(*tree_, r, 0, Uncovered{std::span(out).subspan(before), r});
    tree_->search_nearest_first(c, traversal);
    if (!(traversal.nearest().distance > 0)) return;
    out.push_back(traversal.nearest());
  }
}

double TriangleTree::first_contact(const Vector<3>& c, double r, const Vector<3>& direction, double limit,
                                   double skin) const {
  MoveTraversal traversal(*tree_, r, direction, limit, skin);
  tree_->search_nearest_first(c, traversal);
  return traversal.limit();
}

double TriangleTree::free_path(const Motion& motion, double bound, WallArithmetic arithmetic) const {
  PathTraversal traversal(*tree_, motion, bound, arithmetic);
  tree_->search_nearest_first(motion.c, traversal);
  return traversal.limit();
}

namespace {

template <typename Ignored>
auto crossed(const Tree& tree, const Vector<3>& p, int axis, double end, const Ignored& ignored) {
  CrossingTraversal traversal(p, axis, end, ignored);
  tree.traversal(p, traversal);
  return traversal;
}

}  // namespace

Crossing TriangleTree::crossing(const Vector<3>& p, int axis, double end) const {
  return crossed(tree_->tree(), p, axis, end, [](std::uint32_t) { return false; }).crossing();
}

Crossing TriangleTree::crossing(const Vector<3>& p, int axis, double end,
                                const std::function<bool(std::uint32_t)>& ignored) const {
  return crossed(tree_->tree(), p, axis, end, ignored).crossing();
}

std::optional<int> TriangleTree::winding(const Vector<3>& p, int axis,
                                         const std::function<bool(std::uint32_t)>& ignored) const {
  const auto way = crossed(tree_->tree(), p, axis, std::numeric_limits<double>::infinity(), ignored);
  if (way.crossing() == Crossing::starts_on_wall) return {};
  return way.outwards();
}

}  // namespace bernal::cad
