#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/core/tolerance.hpp"
#include "domain/analytic.hpp"
#include "domain/exact_analytic.hpp"
#include "domain/inset_container.hpp"
#include "domain/segment_tree.hpp"

namespace bernal {
namespace {

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

/// Upright walls on the edges of a polygon in the plane z = 0.
class PolygonContainer final : public Container {
 public:
  PolygonContainer(const Polygon& shape, WallArithmetic arithmetic, double resolution)
      : Container(arithmetic, resolution, {}, 2),
        shape_(shape),
        bounds_(bounds_of(shape)),
        volume_(volume_of(Polygon{shape.loops})),
        edges_(edges_of(shape)) {}

  std::string_view kind() const override { return "polygon"; }
  Bounds<3> bounds() const override { return bounds_; }
  double volume() const override { return volume_; }

  double clearance(const Vector<3>& p) const override {
    return clearance_within(p, std::numeric_limits<double>::infinity());
  }

  double clearance_within(const Vector<3>& p, double reach) const override {
    return edges_.signed_distance_within(p.head<2>(), reach);
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
    edges_.for_each_within(c.head<2>(), reach, [&](const Segment& edge) {
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
  Polygon shape_;
  Bounds<3> bounds_;
  double volume_;
  SegmentTree edges_;
};

}  // namespace

std::unique_ptr<Container> make_polygon(const Polygon& shape, WallArithmetic arithmetic, double resolution) {
  auto facets = std::make_unique<PolygonContainer>(shape, arithmetic, resolution);
  if (shape.inset == 0) return facets;
  return make_inset_container(std::move(facets), shape.inset, volume_of(shape));
}

}  // namespace bernal
