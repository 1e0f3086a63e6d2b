#include "formats/level_walls.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace bernal {
namespace {

using Kind = LevelSurface::Kind;

/// One piece of wall of a solid of revolution within a slab: r = r0 + slope (z - z0).
struct ProfileEdge {
  Vector<2> a, b;
  double at(double z) const { return a[0] + (b[0] - a[0]) * ((z - a[1]) / (b[1] - a[1])); }
  bool spans(double low, double high) const {
    return std::min(a[1], b[1]) <= low && std::max(a[1], b[1]) >= high && a[1] != b[1];
  }
  bool is_axis() const { return a[0] == 0 && b[0] == 0; }
};

class Walls {
 public:
  LevelWalls operator()(const Box& box) {
    const Bounds<3> bounds = bounds_of(Domain(box));
    CommonPart all;
    for (int k = 0; k < 3; ++k)
      for (const bool upper : {false, true}) {
        const bool repeats = box.repeats(k);
        const std::size_t plane =
            add({.axis = Vector<3>::Unit(k), .size = upper ? bounds.upper[k] : bounds.lower[k]}, repeats);
        beyond(all, {plane, !upper});
        all.push_back({plane, upper});
      }
    made_.inside = {all};
    return made_;
  }

  LevelWalls operator()(const Sphere& sphere) {
    const std::size_t face = add({.kind = Kind::sphere, .at = sphere.center, .size = sphere.radius});
    made_.inside = {{{face, true}}};
    made_.outside = {{{face, false}}};
    return made_;
  }

  LevelWalls operator()(const Cylinder& cylinder) {
    const Vector<3> axis = axis_of(cylinder.axis);
    const double foot = axis.dot(cylinder.base);
    const std::size_t low = add({.axis = axis, .size = foot}, cylinder.periodic),
                      high = add({.axis = axis, .size = foot + cylinder.height}, cylinder.periodic),
                      side = add({Kind::cylinder, cylinder.base, axis, cylinder.radius});
    CommonPart all;
    for (const SurfaceSide& half : {SurfaceSide{low, false}, {high, true}, {side, true}}) {
      beyond(all, {half.surface, !half.inner});
      all.push_back(half);
    }
    made_.inside = {all};
    return made_;
  }

  LevelWalls operator()(const Revolved& revolved) {
    axis_ = axis_of(revolved.axis);
    base_ = revolved.base;
    const std::size_t n = revolved.profile.size();
    for (std::size_t k = 0; k < n; ++k) {
      edges_.push_back({revolved.profile[k], revolved.profile[(k + 1) % n]});
      heights_.push_back(revolved.profile[k][1]);
    }
    std::ranges::sort(heights_);
    heights_.erase(std::ranges::unique(heights_).begin(), heights_.end());
    surface_of_edge_.assign(n, none);
    std::vector<std::size_t> planes;
    for (const double z : heights_) planes.push_back(add({.axis = axis_, .size = axis_.dot(base_) + z}));
    made_.outside.push_back({{planes.front(), true}});
    made_.outside.push_back({{planes.back(), false}});
    for (std::size_t k = 0; k + 1 < heights_.size(); ++k)
      add_slab(heights_[k], heights_[k + 1], {planes[k], false}, {planes[k + 1], true});
    return made_;
  }

  LevelWalls operator()(const Mesh&) { return {}; }     // by precondition
  LevelWalls operator()(const Polygon&) { return {}; }  // by precondition

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  /// A coordinate axis to the last bit where it is one.
  static Vector<3> axis_of(const Vector<3>& given) {
    for (int k = 0; k < 3; ++k)
      if (given[(k + 1) % 3] == 0 && given[(k + 2) % 3] == 0)
        return std::copysign(1.0, given[k]) * Vector<3>::Unit(k);
    return given.normalized();
  }

  std::size_t add(const LevelSurface& surface, bool periodic = false) {
    made_.surfaces.push_back(surface);
    made_.periodic.push_back(periodic);
    return made_.surfaces.size() - 1;
  }
  /// What is within `so_far` and on that side.
  void beyond(CommonPart so_far, const SurfaceSide& half) {
    so_far.push_back(half);
    made_.outside.push_back(std::move(so_far));
  }

  std::size_t surface_of(std::size_t edge) {
    std::size_t& known = surface_of_edge_[edge];
    if (known != none) return known;
    const auto& [a, b] = edges_[edge];
    if (a[0] == b[0]) return known = add({Kind::cylinder, base_, axis_, a[0]});
    const double slope = (b[0] - a[0]) / (b[1] - a[1]);
    // From the nearer end, so that an apex on the axis is that corner.
    const Vector<2>& from = a[0] < b[0] ? a : b;
    return known = add({Kind::cone, base_ + (from[1] - from[0] / slope) * axis_, axis_, slope});
  }

  void add_slab(double low, double high, const SurfaceSide& above, const SurfaceSide& below) {
    std::vector<std::size_t> crossing;
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (edges_[e].spans(low, high)) crossing.push_back(e);
    const double middle = 0.5 * (low + high);
    std::ranges::sort(crossing, {}, [&](std::size_t e) { return edges_[e].at(middle); });
    bool is_inside = false;
    std::optional<SurfaceSide> from;  // beyond the last edge
    for (const std::size_t e : crossing) {
      if (!edges_[e].is_axis()) {
        const std::size_t face = surface_of(e);
        CommonPart part = {above, below, {face, true}};
        if (from) part.push_back(*from);
        (is_inside ? made_.inside : made_.outside).push_back(part);
        from = SurfaceSide{face, false};
      }
      is_inside = !is_inside;
    }
    CommonPart rest = {above, below};
    if (from) rest.push_back(*from);
    made_.outside.push_back(rest);
  }

  LevelWalls made_;
  Vector<3> axis_ = Vector<3>::UnitZ(), base_ = Vector<3>::Zero();
  std::vector<ProfileEdge> edges_;
  std::vector<double> heights_;
  std::vector<std::size_t> surface_of_edge_;
};

}  // namespace

int LevelSurface::coordinate_axis() const {
  for (int k = 0; k < 3; ++k)
    if (axis[(k + 1) % 3] == 0 && axis[(k + 2) % 3] == 0) return k;
  return -1;
}

std::array<double, 10> LevelSurface::quadric() const {
  if (kind == Kind::plane) return {0, 0, 0, 0, 0, 0, axis[0], axis[1], axis[2], -size};
  // |q|² - w (q·a)² - s for q = p - at.
  const double w = kind == Kind::sphere     ? 0
                   : kind == Kind::cylinder ? 1
                                            : 1 + size * size,
               s = kind == Kind::cone ? 0 : size * size;
  const Vector<3>& a = axis;
  const auto square = [&](int k) { return 1 - w * a[k] * a[k]; };
  const auto product = [&](int i, int j) { return 0 - 2 * w * a[i] * a[j]; };
  const double along = a.dot(at);
  const Vector<3> linear = -2 * (at - w * along * a);
  return {square(0),     square(1), square(2), product(0, 1), product(1, 2),
          product(0, 2), linear[0], linear[1], linear[2],     at.squaredNorm() - w * along * along - s};
}

LevelWalls walls_of(const Domain& domain) {
  LevelWalls made = std::visit([](const auto& one) { return Walls()(one); }, domain);
  made.words = name_of(domain);
  return made;
}

}  // namespace bernal
