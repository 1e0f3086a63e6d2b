#include "soft/below_level.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "domain/nearest_first.hpp"
#include "domain/places.hpp"

namespace bernal {
namespace {

constexpr std::size_t most_points = 1 << 15;
/// So steep, in degrees, a heap is if nothing is said; and so many planes stand for its cone.
constexpr double usual_heap_angle = 20;
constexpr int flanks = 32;

class CutByPlanes final : public Container {
 public:
  CutByPlanes(std::shared_ptr<const Container> whole, std::vector<Facet> planes, double volume)
      : Container(whole->arithmetic(), whole->resolution(), whole->boundary(), whole->dimension(),
                  whole->inset()),
        whole_(std::move(whole)),
        planes_(std::move(planes)),
        volume_(volume) {}

  std::string_view kind() const override { return whole_->kind(); }
  double volume() const override { return volume_; }

  /// Cut where a plane lies across an axis.
  Bounds<3> bounds() const override {
    Bounds<3> bounds = whole_->bounds();
    for (const Facet& plane : planes_)
      for (int k = 0; k < 3; ++k) {
        if (std::abs(plane.b[k]) < 1) continue;
        double& end = plane.b[k] < 0 ? bounds.upper[k] : bounds.lower[k];
        end = std::clamp(plane.a[k], bounds.lower[k], bounds.upper[k]);
      }
    return bounds;
  }

  double clearance(const Vector<3>& p) const override { return std::min(whole_->clearance(p), depth(p)); }
  double clearance_within(const Vector<3>& p, double reach) const override {
    return std::min(whole_->clearance_within(p, reach), depth(p));
  }
  bool contains(const Vector<3>& c, double r) const override {
    return depth(c) >= r && whole_->contains(c, r);
  }
  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    const auto before = static_cast<std::ptrdiff_t>(out.size());
    whole_->facets_near(c, reach, out);
    add_planes(c, reach, before, out);
  }
  bool few_facets_near(const Vector<3>& c, double reach, std::size_t most,
                       std::vector<NearFacet>& out) const override {
    const auto before = static_cast<std::ptrdiff_t>(out.size());
    if (!whole_->few_facets_near(c, reach, most, out)) return false;
    add_planes(c, reach, before, out);
    return true;
  }
  void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const override {
    whole_->contacts(c, r, out);
    for (const Facet& plane : planes_)
      if (depth(plane, c) < r) out.push_back({plane.b, depth(plane, c)});
  }
  double first_contact(const Vector<3>& c, double r, const Vector<3>& direction,
                       double limit) const override {
    return whole_->first_contact(c, r, direction, std::min(limit, until_planes(c, r, direction)));
  }
  double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const override {
    return whole_->free_path(c, r, direction, std::min(limit, until_planes(c, r, direction)));
  }

 private:
  static double depth(const Facet& plane, const Vector<3>& p) { return (p - plane.a).dot(plane.b); }
  double depth(const Vector<3>& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Facet& plane : planes_) least = std::min(least, depth(plane, p));
    return least;
  }
  double until_planes(const Vector<3>& c, double r, const Vector<3>& direction) const {
    double way = std::numeric_limits<double>::infinity();
    for (const Facet& plane : planes_) {
      const double approach = -direction.dot(plane.b);
      if (approach > 0) way = std::min(way, std::max(0.0, depth(plane, c) - r) / approach);
    }
    return way;
  }
  void add_planes(const Vector<3>& c, double reach, std::ptrdiff_t before,
                  std::vector<NearFacet>& out) const {
    for (const Facet& plane : planes_) {
      const NearFacet near{depth(plane, c), plane};
      if (near.distance < reach) insert_nearest_first(near, before, out);
    }
  }

  std::shared_ptr<const Container> whole_;
  std::vector<Facet> planes_;
  double volume_;
};

}  // namespace

BedTop::BedTop(const BedTarget& bed, const Container& container, const Vector<3>& down) : up_(-down) {
  if (bed.top != BedTarget::Top::heap) return;
  // Whose edges lie on the cone.
  const double angle =
      std::atan(std::tan(bed.heap_angle.value_or(usual_heap_angle) * std::numbers::pi / 180) /
                std::cos(std::numbers::pi / flanks));
  cosine_ = std::cos(angle);
  const Vector<3> center = container.bounds().center();
  middle_ = center - center.dot(up_) * up_;
  const Vector<3> a = up_.unitOrthogonal(), b = up_.cross(a);
  for (int k = 0; k < flanks; ++k) {
    const double turn = 2 * std::numbers::pi * k / flanks;
    const Vector<3> across = std::cos(turn) * a + std::sin(turn) * b;
    normals_.push_back(cosine_ * up_ + std::sin(angle) * across);
  }
}

double BedTop::height(const Vector<3>& p) const {
  double highest = up_.dot(p);
  for (const Vector<3>& n : normals_) highest = std::max(highest, n.dot(p - middle_) / cosine_);
  return highest;
}

std::vector<Facet> BedTop::planes(double height) const {
  std::vector<Facet> planes = {{.kind = Facet::Kind::plane, .a = height * up_, .b = -up_}};
  for (const Vector<3>& n : normals_)
    planes.push_back({.kind = Facet::Kind::plane, .a = middle_ + height * up_, .b = -n});
  return planes;
}

std::shared_ptr<const Container> cut_by_planes(std::shared_ptr<const Container> whole,
                                               std::vector<Facet> planes, double volume) {
  return std::make_shared<CutByPlanes>(std::move(whole), std::move(planes), volume);
}

std::vector<Vector<3>> even_points_inside(const Container& container) {
  const Bounds<3> bounds = container.bounds();
  const Vector<3> size = bounds.size();
  // The additive recurrence of the plastic number's relative in three dimensions (Roberts 2018).
  const Vector<3> step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  const auto even_point = [&](std::size_t n) -> Vector<3> {
    const Vector<3> at = static_cast<double>(n + 1) * step;
    return bounds.lower + size.cwiseProduct(Vector<3>(at - at.array().floor().matrix()));
  };
  return points_inside(container, most_points, 1, even_point);
}

Heights::Heights(const Container& container, const BedTop& top, double ground)
    : ground_(ground), volume_(container.volume()) {
  for (const Vector<3>& p : even_points_inside(container)) heights_.push_back(top.height(p));
  if (heights_.empty()) heights_.push_back(top.height(container.bounds().center()));
  std::ranges::sort(heights_);
}

double Heights::volume_below(double height) const {
  const auto above = std::ranges::upper_bound(heights_, height);
  return volume_ * static_cast<double>(above - heights_.begin()) / static_cast<double>(heights_.size());
}

double Heights::holding(double volume) const {
  const double place = volume / volume_ * static_cast<double>(heights_.size());
  return heights_[std::min(heights_.size() - 1, static_cast<std::size_t>(place))];
}

double Heights::volume_below_mean(double height) const {
  double sum = 0;
  for (std::size_t k = 0; k < heights_.size(); ++k) {
    sum += heights_[k];
    if (sum > height * static_cast<double>(k + 1))
      return volume_ * static_cast<double>(k + 1) / static_cast<double>(heights_.size());
  }
  return volume_;
}

}  // namespace bernal
