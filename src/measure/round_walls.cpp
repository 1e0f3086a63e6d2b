#include "measure/round_walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace bernal {
namespace {

using std::numbers::pi;

/// A corner relative to a round wall: its offset from the axis and its position along that, or its offset
/// from the centre.
template <int N>
struct WallCorner {
  Vector<N> at;
  double along;
  bool inside;
};

/// The part of the line from a to b inside the ball about zero; from >= to if there is none. Consistent with
/// the corners' own sides, so that ways in and out alternate around a loop.
struct Part {
  double from, to;
};
template <int N>
Part part_inside(const WallCorner<N>& a, const WallCorner<N>& b, double radius) {
  if (a.inside && b.inside) return {0, 1};
  const Vector<N> d = b.at - a.at;
  const double squared = d.squaredNorm();
  if (!(squared > 0)) return {0, a.inside ? 1.0 : 0.0};
  const double nearest = -a.at.dot(d) / squared;
  const double left = radius * radius - (a.at + nearest * d).squaredNorm();
  if (!a.inside && !b.inside && !(left > 0 && nearest > 0 && nearest < 1)) return {0, 0};
  const double half = std::sqrt(std::max(0.0, left) / squared);
  return {a.inside ? 0 : std::clamp(nearest - half, 0.0, 1.0),
          b.inside ? 1 : std::clamp(nearest + half, 0.0, 1.0)};
}

double cross(const Vector<2>& a, const Vector<2>& b) { return a[0] * b[1] - a[1] * b[0]; }
/// The angle by which a line from a to b turns about zero.
double turn(const Vector<2>& a, const Vector<2>& b) { return std::atan2(cross(a, b), a.dot(b)); }

/// x - sin x
double x_minus_sin(double x) {
  if (std::abs(x) > 0.5) return x - std::sin(x);
  const double s = x * x;
  return x * s / 6 *
         (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110 * (1 - s / 156 * (1 - s / 210))))));
}

/// The integral of a linear function z over the part of a polygon inside a disc about zero; negative for
/// clockwise corners. z may be very steep on a face nearly parallel to the axis, whose projection is a
/// sliver, so z is evaluated only between corners of the inner part and in segments of the disc.
class OverDisc {
 public:
  OverDisc(std::span<const WallCorner<2>> loop, double radius) : loop_(loop), radius_(radius) {
    find_plane();
    find_ways();
  }

  double integral() const {
    if (!(twice_area_ != 0)) return 0;
    if (ways_.empty())
      return std::abs(outside_) > pi ? std::copysign(pi, outside_) * squared() * at_zero() : 0;
    double sum = 0;
    for (std::size_t k = 0; k < ways_.size(); ++k) {
      const Way& way = ways_[k];
      const Way& before = ways_[(k > 0 ? k : ways_.size()) - 1];
      const double turned = way.turned + (k == 0 ? outside_ : 0);
      sum += triangle(way.in, way.out) + triangle(before.out, way.in) + segment(before.out, way.in, turned);
    }
    return sum;
  }

 private:
  struct Point {
    Vector<2> at;
    double z;
  };
  /// A straight part of the inner region's boundary, and the angle turned outside before it.
  struct Way {
    Point in, out;
    double turned;
  };

  double squared() const { return radius_ * radius_; }

  void find_plane() {
    Vector<3> area = Vector<3>::Zero();
    const auto from_first = [&](const WallCorner<2>& corner) {
      const Vector<2> d = corner.at - loop_.front().at;
      return Vector<3>(d[0], d[1], corner.along - loop_.front().along);
    };
    lowest_ = highest_ = loop_.front().along;
    for (std::size_t k = 1; k < loop_.size(); ++k) {
      if (k + 1 < loop_.size()) area += from_first(loop_[k]).cross(from_first(loop_[k + 1]));
      lowest_ = std::min(lowest_, loop_[k].along);
      highest_ = std::max(highest_, loop_[k].along);
    }
    twice_area_ = area[2];
    if (twice_area_ != 0) slope_ = -area.head<2>() / twice_area_;
  }

  void find_ways() {
    for (std::size_t k = 0; k < loop_.size(); ++k) {
      const WallCorner<2>&a = loop_[k], &b = loop_[(k + 1) % loop_.size()];
      const Part part = part_inside(a, b, radius_);
      const auto point = [&](double share) {
        return Point{a.at + share * (b.at - a.at), a.along + share * (b.along - a.along)};
      };
      if (!(part.from < part.to)) {
        outside_ += turn(a.at, b.at);
        continue;
      }
      const Point in = part.from > 0 ? point(part.from) : Point{a.at, a.along};
      const Point out = part.to < 1 ? point(part.to) : Point{b.at, b.along};
      if (part.from > 0) outside_ += turn(a.at, in.at);
      ways_.push_back({in, out, outside_});
      outside_ = part.to < 1 ? turn(out.at, b.at) : 0;
    }
  }

  double within_face(double z) const { return std::clamp(z, lowest_, highest_); }

  double at_zero() const { return within_face(loop_.front().along - slope_.dot(loop_.front().at)); }

  /// The triangle with the first point.
  double triangle(const Point& u, const Point& v) const {
    const Point& first = ways_.front().in;
    return 0.5 * cross(u.at - first.at, v.at - first.at) * (first.z + u.z + v.z) / 3;
  }

  /// Between the chord from u to v and the arc of this angle.
  double segment(const Point& u, const Point& v, double turned) const {
    const double twice = x_minus_sin(turned);
    if (twice == 0) return 0;
    const double half = 0.5 * turned, sine = std::sin(half);
    const Vector<2> middle(std::cos(half) * u.at[0] - sine * u.at[1],
                           sine * u.at[0] + std::cos(half) * u.at[1]);  // of the arc
    // The centroid's distance from zero over the radius, minus that of the chord.
    const double height = 4. / 3 * sine * sine * sine / twice - std::cos(half);
    return 0.5 * squared() * twice * within_face(0.5 * (u.z + v.z) + height * slope_.dot(middle));
  }

  std::span<const WallCorner<2>> loop_;
  double radius_;
  double twice_area_ = 0, lowest_ = 0, highest_ = 0;
  Vector<2> slope_ = Vector<2>::Zero();
  std::vector<Way> ways_;
  double outside_ = 0;  ///< angle turned since the last of these
};

/// The part inside the ball about zero of the cones from zero over a face, whose loop is anticlockwise seen
/// from outside the cell.
double cone_in_ball(std::span<const WallCorner<3>> loop, double radius) {
  Vector<3> normal = Vector<3>::Zero();
  const Vector<3>& first = loop.front().at;
  for (std::size_t k = 1; k + 1 < loop.size(); ++k)
    normal += (loop[k].at - first).cross(loop[k + 1].at - first);
  if (!(normal.squaredNorm() > 0)) return 0;
  normal.stableNormalize();
  const double height = normal.dot(first), away = std::abs(height);
  const Vector<3> towards = std::copysign(1.0, height) * normal;  // the nearest point of the face's plane
  double twice_area = 0, angle = 0, turned = 0;                   // angle: solid angle of what is outside
  const auto add_outside = [&](const Vector<3>& u, const Vector<3>& v) {
    const double nu = u.norm(), nv = v.norm();
    angle += 2 * std::atan2(towards.dot(u.cross(v)), nu * nv + away * (nu + nv) + u.dot(v));
    turned += std::atan2(normal.dot(u.cross(v)), u.dot(v) - height * height);
  };
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const WallCorner<3>&a = loop[k], &b = loop[(k + 1) % loop.size()];
    const Part part = part_inside(a, b, radius);
    if (!(part.from < part.to)) {
      add_outside(a.at, b.at);
      continue;
    }
    const Vector<3> in = a.at + part.from * (b.at - a.at), out = a.at + part.to * (b.at - a.at);
    if (part.from > 0) add_outside(a.at, in);
    twice_area += normal.dot(in.cross(out));
    if (part.to < 1) add_outside(out, b.at);
  }
  const double cube = radius * radius * radius;
  if (away < radius) {  // else the disc is empty
    twice_area += (radius * radius - height * height) * turned;
    angle -= std::copysign(1 - away / radius, height) * turned;
  }
  return (0.5 * height * twice_area + cube * angle) / 3;
}

/// The sum of `of_loop` over the loops, with corners mapped by `see`; the cell's own volume if all are
/// inside.
template <int N, class See, class OfLoop>
double sum_over_faces(const ConvexCell& cell, const See& see, const OfLoop& of_loop) {
  std::vector<WallCorner<N>> seen, loop;
  for (const Vector<3>& corner : cell.corners()) seen.push_back(see(corner));
  const double own = cell.volume();
  if (std::ranges::all_of(seen, &WallCorner<N>::inside)) return own;
  double sum = 0;
  cell.for_each_loop([&](std::span<const std::uint32_t> corners) {
    loop.clear();
    for (const std::uint32_t corner : corners) loop.push_back(seen[corner]);
    sum += of_loop(std::span<const WallCorner<N>>(loop));
  });
  return std::clamp(sum, 0.0, own);
}

double volume_in_column(const ConvexCell& cell, const Vector<3>& from_base, const Vector<3>& axis,
                        double radius) {
  const Vector<3> u = axis.unitOrthogonal(), v = axis.cross(u);
  const auto see = [&](const Vector<3>& p) {
    const Vector<3> w = from_base + p;
    const Vector<2> across(u.dot(w), v.dot(w));
    return WallCorner<2>{across, axis.dot(p), across.squaredNorm() <= radius * radius};
  };
  return sum_over_faces<2>(
      cell, see, [&](std::span<const WallCorner<2>> loop) { return OverDisc(loop, radius).integral(); });
}

/// `from_middle`: position of the cell's centre.
void cut_behind(ConvexCell& cell, const Vector<3>& from_middle, double radius) {
  const double away = from_middle.norm();
  if (away > 0) cell.cut(from_middle / away, radius - away, ConvexCell::wall);
}

}  // namespace

void cut_behind(ConvexCell& cell, const Vector<3>& center, const Cylinder& cylinder) {
  const Vector<3> axis = cylinder.axis.stableNormalized(), from_base = center - cylinder.base;
  const Vector<3> across = from_base - axis.dot(from_base) * axis;
  // For a centre on the axis the rounded offset may point along it.
  constexpr double points_across = 1e-9;
  if (across.norm() > points_across * from_base.norm()) cut_behind(cell, across, cylinder.radius);
}

void cut_behind(ConvexCell& cell, const Vector<3>& center, const Sphere& sphere) {
  cut_behind(cell, center - sphere.center, sphere.radius);
}

double volume_inside(const ConvexCell& cell, const Vector<3>& center, const Cylinder& cylinder) {
  if (cell.empty()) return 0;
  const Vector<3> axis = cylinder.axis.stableNormalized(), from_base = center - cylinder.base;
  // Lids normal to a coordinate axis are those of the bounds, where cells end.
  if (cylinder.periodic || cylinder.coordinate_axis() >= 0)
    return volume_in_column(cell, from_base, axis, cylinder.radius);
  ConvexCell between_lids = cell;
  const double height = axis.dot(from_base);
  between_lids.cut(-axis, height, ConvexCell::wall);
  between_lids.cut(axis, cylinder.height - height, ConvexCell::wall);
  return between_lids.empty() ? 0 : volume_in_column(between_lids, from_base, axis, cylinder.radius);
}

double volume_inside(const ConvexCell& cell, const Vector<3>& center, const Sphere& sphere) {
  if (cell.empty()) return 0;
  const Vector<3> from_center = center - sphere.center;
  const double radius = sphere.radius;
  const auto see = [&](const Vector<3>& p) {
    const Vector<3> w = from_center + p;
    return WallCorner<3>{w, 0, w.squaredNorm() <= radius * radius};
  };
  return sum_over_faces<3>(cell, see,
                           [&](std::span<const WallCorner<3>> loop) { return cone_in_ball(loop, radius); });
}

}  // namespace bernal
