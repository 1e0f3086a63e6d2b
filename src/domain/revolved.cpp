#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "domain/analytic.hpp"
#include "domain/exact_analytic.hpp"
#include "domain/free_path.hpp"
#include "domain/frustum.hpp"
#include "domain/inset_container.hpp"
#include "domain/segment_tree.hpp"

namespace bernal {
namespace {

std::vector<Segment> walls_of_profile(const Revolved& shape) {
  std::vector<Segment> walls;
  shape.for_each_edge([&](const Vector<2>& a, const Vector<2>& b) {
    walls.push_back({a, b, static_cast<std::uint32_t>(walls.size())});
  });
  return walls;
}

/// The distance of a point from the wall is that of its r and z from the profile.
class RevolvedContainer final : public Container {
 public:
  RevolvedContainer(const Revolved& shape, WallArithmetic arithmetic, double resolution)
      : Container(arithmetic, resolution),
        shape_(shape),
        axis_(shape.axis.stableNormalized()),
        bounds_(bounds_of(shape)),
        walls_(walls_of_profile(shape)) {
    shape_.inset = 0;
    volume_ = volume_of(shape_);
    shape_.for_each_edge([&](const Vector<2>& a, const Vector<2>& b) {
      edges_.push_back({shape_.base, shape_.axis, a, b});
      facets_.push_back(facet_of(edges_.back(), static_cast<std::uint32_t>(facets_.size())));
      extent_ = std::max({extent_, a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()});
    });
  }

  std::string_view kind() const override { return "revolved"; }
  Bounds<3> bounds() const override { return bounds_; }
  double volume() const override { return volume_; }

  double clearance(const Vector<3>& p) const override {
    return clearance_within(p, std::numeric_limits<double>::infinity());
  }
  double clearance_within(const Vector<3>& p, double reach) const override {
    return walls_.signed_distance_within(in_half_plane(p, shape_.base, axis_), reach);
  }

  bool contains(const Vector<3>& c, double r) const override {
    const double error = error_at(c, r);
    return decide_contains(arithmetic(), clearance_within(c, r + 2 * error), r, error,
                           [&] { return clears_all_exactly(c, r, error); });
  }

  double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const override {
    if (arithmetic() == WallArithmetic::plain || !(direction.stableNorm() > 0))
      return Container::free_path(c, r, direction, limit);
    return free_path_among_near(*this, {c, r, direction, limit},
                                [&](const Facet& facet, const Motion& motion) {
                                  return bernal::free_path(edges_[facet.id], motion, arithmetic());
                                });
  }

  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    const Vector<2> place = in_half_plane(c, shape_.base, axis_);
    // By a rounding more, as the facets are rounded.
    walls_.for_each_within(place, reach + error_at(c, 0), [&](const Segment& edge) {
      const double d = distance(facets_[edge.id], c);
      if (d < reach) out.push_back({d, facets_[edge.id]});
    });
    std::sort(out.begin() + first, out.end(), [](const NearFacet& x, const NearFacet& y) {
      return x.distance != y.distance ? x.distance < y.distance : x.facet.id < y.facet.id;
    });
  }

 private:
  /// Of clearance - r: r and z as those of a cylinder (domain/cylinder.cpp), and what is between them and an
  /// edge is a difference of differences, of at most sixteen operations.
  double error_at(const Vector<3>& c, double r) const {
    return 64 * tolerance::roundoff * ((c - shape_.base).lpNorm<1>() + 2 * extent_ + r);
  }

  /// The edges that are certainly far, and those that certainly are or are not crossed, are known by doubles.
  bool clears_all_exactly(const Vector<3>& c, double r, double error) const {
    const ExactVector center = exact(c);
    const Vector<2> place = in_half_plane(c, shape_.base, axis_);
    bool clear = true, on_wall = false;
    walls_.for_each_within(place, r + error, [&](const Segment& s) {
      if (!clear || s.offset(place).norm() > r + error) return;
      clear = clears_exactly(edges_[s.id], center, r);
      if (r == 0) on_wall |= !clears_exactly(edges_[s.id], center, std::numeric_limits<double>::denorm_min());
    });
    if (!clear || on_wall) return clear;
    bool odd = false;
    walls_.for_each_ahead(place, error, [&](const Segment& s) {
      const Vector<2> low = s.a.cwiseMin(s.b), high = s.a.cwiseMax(s.b);
      if (low[1] > place[1] + error || high[1] < place[1] - error || high[0] < place[0] - error) return;
      const bool ends_apart = low[1] < place[1] - error && high[1] > place[1] + error;
      if (ends_apart && low[0] > place[0] + error)
        odd = !odd;
      else
        odd ^= is_crossed_outwards_exactly(edges_[s.id], center);
    });
    return odd;
  }

  Revolved shape_;
  Vector<3> axis_;
  Bounds<3> bounds_;
  double volume_ = 0, extent_ = 0;
  SegmentTree walls_;
  std::vector<ProfileEdge> edges_;
  std::vector<Facet> facets_;
};

}  // namespace

void require_profile(const Revolved& shape) {
  const auto require = [](bool holds, const std::string& message) {
    if (!holds) throw Error(ErrorCode::bad_argument, message);
  };
  require(shape.base.allFinite() && shape.axis.allFinite() && !shape.axis.isZero(0),
          "a solid of revolution needs a finite base and an axis that is finite and not zero");
  for (std::size_t k = 0; k < shape.profile.size(); ++k) {
    const Vector<2>& p = shape.profile[k];
    require(p.allFinite() && p[0] >= 0,
            fmt::format("point {} of the profile, ({:.6g}, {:.6g}), must be finite and not on the other side "
                        "of the axis: give points [r, z] with r >= 0",
                        k + 1, p[0], p[1]));
  }
  require_simple(Polygon{{shape.profile}});
}

std::unique_ptr<Container> make_revolved(const Revolved& shape, WallArithmetic arithmetic,
                                         double resolution) {
  auto walls = std::make_unique<RevolvedContainer>(shape, arithmetic, resolution);
  if (shape.inset == 0) return walls;
  return make_inset_container(std::move(walls), shape.inset, volume_of(shape));
}

}  // namespace bernal
