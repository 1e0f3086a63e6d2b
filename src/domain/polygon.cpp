#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/core/tolerance.hpp"
#include "domain/analytic.hpp"
#include "domain/exact_analytic.hpp"
#include "domain/inset_container.hpp"
#include "near/box_tree.hpp"

namespace bernal {
namespace {

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

std::vector<Segment> edges_of(const Polygon& shape) {
  std::vector<Segment> edges;
  for (const auto& loop : shape.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector<2>&a = loop[k], &b = loop[(k + 1) % loop.size()];
      if (a != b) edges.push_back({a, b, static_cast<std::uint32_t>(edges.size())});
    }
  }
  return edges;
}

BoxTree<2> tree_of(const std::vector<Segment>& edges) {
  std::vector<Bounds<2>> boxes;
  for (const Segment& s : edges) boxes.push_back({s.a.cwiseMin(s.b), s.a.cwiseMax(s.b)});
  return {boxes, 4};
}

/// Upright walls on the edges of a polygon in the plane z = 0.
class PolygonContainer final : public Container {
 public:
  PolygonContainer(const Polygon& shape, WallArithmetic arithmetic, double resolution)
      : Container(arithmetic, resolution, {}, 2),
        shape_(shape),
        bounds_(bounds_of(shape)),
        volume_(volume_of(Polygon{shape.loops})),
        edges_(edges_of(shape)),
        tree_(tree_of(edges_)) {
    std::vector<Segment> in_order;
    for (const std::uint32_t k : tree_.order()) in_order.push_back(edges_[k]);
    edges_.swap(in_order);
  }

  std::string_view kind() const override { return "polygon"; }
  Bounds<3> bounds() const override { return bounds_; }
  double volume() const override { return volume_; }

  double clearance(const Vector<3>& p) const override {
    return clearance_within(p, std::numeric_limits<double>::infinity());
  }

  double clearance_within(const Vector<3>& p, double reach) const override {
    // Outside the distance is asked whatever the reach.
    const bool inside = encloses(p.head<2>());
    const double distance =
        distance_within(p.head<2>(), inside ? std::max(0.0, reach) : std::numeric_limits<double>::infinity());
    return std::min(inside ? distance : -distance, reach);
  }

  bool contains(const Vector<3>& c, double r) const override {
    // The offset from an edge is a difference of differences, each no longer than the polygon is wide where c
    // is inside: seven operations, each off by a roundoff of that at most.
    const double error = 16 * tolerance::roundoff * bounds_.diagonal();
    return decide_contains(arithmetic(), clearance_within(c, r + 2 * error), r, error,
                           [&] { return contains_exactly(shape_, c, r); });
  }

  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    const auto may_be_near = [&](const Bounds<2>& box) {
      return squared_distance<2>(box, c.head<2>()) <= reach * reach;
    };
    for_each_edge(may_be_near, [&](const Segment& edge) {
      const double d = edge.offset(c.head<2>()).norm();
      if (!(d < reach)) return;
      Facet facet;
      facet.kind = Facet::Kind::triangle;
      facet.id = edge.id;
      facet.a.head<2>() = edge.a;
      facet.b.head<2>() = edge.b;
      facet.c = facet.b;
      out.push_back({d, facet});
    });
    std::sort(out.begin() + first, out.end(), [](const NearFacet& x, const NearFacet& y) {
      return x.distance != y.distance ? x.distance < y.distance : x.facet.id < y.facet.id;
    });
  }

 private:
  /// Calls see(edge) for those in boxes that enter(box) is true of.
  template <class Enter, class See>
  void for_each_edge(const Enter& enter, const See& see) const {
    tree_.for_each_leaf([&](const BoxTree<2>::Node& node) { return enter(node.bounds); },
                        [&](const BoxTree<2>::Node& leaf) {
                          for (std::uint32_t k = leaf.first; k < leaf.last; ++k) see(edges_[k]);
                        });
  }

  /// The distance of p from the nearest edge; any value of at least `reach` where none is nearer.
  double distance_within(const Vector<2>& p, double reach) const {
    double squared = reach * reach;
    for_each_edge([&](const Bounds<2>& box) { return squared_distance(box, p) < squared; },
                  [&](const Segment& s) { squared = std::min(squared, s.offset(p).squaredNorm()); });
    return std::sqrt(squared);
  }

  /// Whether the ray from p along the first axis crosses an odd number of edges.
  bool encloses(const Vector<2>& p) const {
    bool odd = false;
    for_each_edge(
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

  Polygon shape_;
  Bounds<3> bounds_;
  double volume_;
  std::vector<Segment> edges_;  ///< in the order of the tree
  BoxTree<2> tree_;
};

}  // namespace

std::unique_ptr<Container> make_polygon(const Polygon& shape, WallArithmetic arithmetic, double resolution) {
  auto facets = std::make_unique<PolygonContainer>(shape, arithmetic, resolution);
  if (shape.inset == 0) return facets;
  return make_inset_container(std::move(facets), shape.inset, volume_of(shape));
}

}  // namespace bernal
