#include "domain/free_path.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#include "bernal/core/tolerance.hpp"
#include "core/rounding.hpp"
#include "domain/exact_way.hpp"
#include "domain/frustum.hpp"
#include "domain/last_clear.hpp"
#include "kernels/first_contact.hpp"

namespace bernal {
namespace {

using Wide = Eigen::Matrix<long double, 3, 1>;

/// Unit roundoff of the 64 bits of long double.
constexpr long double wide_roundoff = LDBL_EPSILON / 2;
/// So many roundoffs of the lengths involved bound the error of every sum of products below: differences of
/// coordinates, three products and their sum, a norm and a quotient take fewer than 16, and what a place on
/// the way adds to them fewer than that again.
constexpr long double wide_error = 32 * wide_roundoff;
constexpr double largest_double = std::numeric_limits<double>::max();

Wide wide(const Vector<3>& v) { return v.cast<long double>(); }

/// The largest double that is not above x >= 0.
double round_down(long double x) {
  if (!(x < largest_double)) return largest_double;
  const auto rounded = static_cast<double>(x);
  return rounded > x ? std::nextafter(rounded, 0.0) : rounded;
}

// ---- what is nearest, in long double: guesses, which only have to be good

struct Nearest {
  Wide weights;  ///< of the corners, none negative, of sum 1: those of the nearest point
  Wide offset;   ///< from it
};

Nearest nearest_of_segment(const std::array<Wide, 3>& to, int i, int j) {
  const Wide along = to[i] - to[j];  // from corner i to corner j; to[k] is the way from corner k to the place
  const long double squared = along.squaredNorm();
  const long double share = squared > 0 ? std::clamp(to[i].dot(along) / squared, 0.0L, 1.0L) : 0.0L;
  Nearest nearest{Wide::Zero(), to[i] - share * along};
  nearest.weights[i] = 1 - share;
  nearest.weights[j] += share;
  return nearest;
}

/// `to` leads from the corners to the place.
Nearest nearest_of_triangle(const std::array<Wide, 3>& to) {
  const Wide normal = (to[0] - to[1]).cross(to[0] - to[2]);
  const long double squared = normal.squaredNorm();
  if (squared > 0) {
    const Wide weights(to[1].cross(to[2]).dot(normal), to[2].cross(to[0]).dot(normal),
                       to[0].cross(to[1]).dot(normal));
    if (weights.minCoeff() >= 0 && weights.sum() > 0)
      return {weights / weights.sum(), (to[0].dot(normal) / squared) * normal};
  }
  Nearest nearest = nearest_of_segment(to, 0, 1);
  for (const auto& [i, j] : {std::pair{1, 2}, std::pair{2, 0}}) {
    const Nearest other = nearest_of_segment(to, i, j);
    if (other.offset.squaredNorm() < nearest.offset.squaredNorm()) nearest = other;
  }
  return nearest;
}

/// The ways from the corners to c + t·direction.
std::array<Wide, 3> ways_from(const std::array<Wide, 3>& from_start, const Wide& direction, long double t) {
  return {from_start[0] + t * direction, from_start[1] + t * direction, from_start[2] + t * direction};
}

/// A ball on its way to a triangle, seen along a direction n from the triangle to it: the plane across n that
/// touches the triangle has all of it behind. So whatever n is, with w_i = c - v_i,
///
///   A = min_i n·w_i - r·|n| >= 0  and  S = -n·direction <= 0:  the way is free;
///   A >= 0 and S > 0:                                          it is free up to A / S at least.
///
/// At the first contact, n being the offset there, that is the contact itself; and as it is the largest of
/// all n, a small error of n is of second order in t.
struct View {
  Wide n;
  long double allowance, approach;  ///< A, S
  long double path() const { return allowance / approach; }
};

struct WideWay {
  WideWay(const Corners& t, const Motion& m) : direction(wide(m.direction)), r(m.r) {
    for (std::size_t i = 0; i < 3; ++i) {
      from_start[i] = wide(m.c) - wide(t[i]);
      farthest = std::max(farthest, from_start[i].norm());
    }
    speed = direction.norm();
  }
  View view(const Wide& n) const {
    const long double least = std::min({n.dot(from_start[0]), n.dot(from_start[1]), n.dot(from_start[2])});
    return {n, least - r * n.norm(), -n.dot(direction)};
  }

  std::array<Wide, 3> from_start;
  Wide direction;
  long double r, farthest = 0, speed = 0;
};

/// Newton's method for the distance along the way, whose tangents are such views: from the left it never
/// passes the contact. Ends where it would move by less than its rounding, at the limit, or where it is free.
View last_view(const WideWay& way, long double limit) {
  constexpr int most_iterations = 100;
  long double t = 0;
  View view{};
  for (int k = 0; k < most_iterations; ++k) {
    const Nearest nearest = nearest_of_triangle(ways_from(way.from_start, way.direction, t));
    if (!(nearest.offset.squaredNorm() > 0)) return view;
    view = way.view(nearest.offset);
    if (!(view.approach > 0)) return view;
    const long double next = view.path();
    if (!(next > t) || next >= limit) return view;
    const bool converged = (next - t) * way.speed <= 4 * wide_roundoff * (way.farthest + way.r);
    t = next;
    if (converged) return view;
  }
  return view;
}

// ---- exactly

template <class Clears>
double exact_path(const Motion& m, const Clears& clears, double guess) {
  const double limit = std::min(m.limit, largest_double);
  if (!clears(0.0)) return 0;
  if (clears(limit)) return m.limit;
  return last_clear(guess, limit, clears);
}

double exact_free_path(const Corners& triangle, const Motion& m) {
  const WideWay way(triangle, m);
  const View view = last_view(way, m.limit);
  const double guess = view.approach > 0 && view.path() > 0 ? static_cast<double>(view.path()) : 0;
  return exact_path(
      m, [&](double t) { return way_clears_exactly(triangle, m, m.r, t); }, guess);
}

// ---- filtered

double filtered_free_path(const Corners& triangle, const Motion& m) {
  const WideWay way(triangle, m);
  const View view = last_view(way, m.limit);
  const long double n = view.n.norm();
  const long double allowance = view.allowance - wide_error * (way.farthest + way.r) * n;
  const long double approach = view.approach + wide_error * n * way.speed;
  if (!(n > 0) || !(allowance >= 0)) return exact_free_path(triangle, m);
  if (!(approach > 0)) return m.limit;
  const long double surely = allowance / approach * (1 - wide_error);
  if (surely >= m.limit) return m.limit;
  const double t = round_down(surely);

  // A little farther on it surely penetrates: a point of the triangle is nearer than r.
  const long double slack = 2 * tolerance::roundoff * ((way.farthest + way.r) / way.speed + 2 * surely);
  const long double beyond = std::min<long double>(m.limit, surely + slack);
  const auto to = ways_from(way.from_start, way.direction, beyond);
  const Wide weights = nearest_of_triangle(to).weights;
  const Wide offset = weights[0] * to[0] + weights[1] * to[1] + weights[2] * to[2];
  const long double error = wide_error * (way.farthest + beyond * way.speed + way.r);
  if (offset.norm() + error < way.r) return t;
  return exact_free_path(triangle, m);
}

// ---- walls whose free side is convex

/// The gap of the ball at c + t·direction in long double, and where it ends.
struct WideGap {
  WideGap(const AnalyticWall& wall, const Motion& m)
      : kind(wall.kind), w(wide(m.c) - wide(wall.point)), v(wide(m.direction)), axis(wide(wall.axis)) {
    room = static_cast<long double>(wall.radius) - m.r;
    lengths = w.norm() + std::abs(static_cast<long double>(wall.radius)) + m.r;
    speed = v.norm();
    if (kind != Facet::Kind::sphere) axis /= axis.stableNorm();
  }

  Wide radial(const Wide& x) const {
    return kind == Facet::Kind::cylinder ? Wide(x - x.dot(axis) * axis) : x;
  }
  long double at(long double t) const {
    const Wide x = w + t * v;
    return kind == Facet::Kind::plane ? x.dot(axis) + room : room - radial(x).norm();
  }
  /// The projections take a rounded axis: half of wide_error covers its error, too.
  long double error(long double t) const { return wide_error * (lengths + t * speed); }

  /// The t at which the gap falls to 0, for good; infinite where it does not fall.
  long double end() const {
    constexpr long double never = std::numeric_limits<long double>::infinity();
    if (kind == Facet::Kind::plane) {
      const long double approach = -v.dot(axis);
      return approach > 0 ? at(0) / approach : never;
    }
    const Wide out = radial(w), across = radial(v);
    const long double squared = across.squaredNorm(), outward = out.dot(across);
    if (!(squared > 0)) return never;
    const long double left = (room - out.norm()) * (room + out.norm());
    const long double root = std::sqrt(std::max(0.0L, outward * outward + squared * left));
    return outward > 0 ? left / (outward + root) : (root - outward) / squared;
  }

  Facet::Kind kind;
  Wide w, v, axis;
  long double room = 0, lengths = 0, speed = 0;
};

double exact_free_path(const AnalyticWall& wall, const Motion& m) {
  const long double end = WideGap(wall, m).end();
  return exact_path(
      m, [&](double t) { return clears_exactly(wall, place_after(m, t), m.r); },
      end > 0 ? round_down(end) : 0);
}

double filtered_free_path(const AnalyticWall& wall, const Motion& m) {
  const WideGap gap(wall, m);
  if (gap.at(0) > gap.error(0)) {
    if (std::isfinite(m.limit) && gap.at(m.limit) > gap.error(m.limit)) return m.limit;
    const long double end = gap.end(), slack = tolerance::roundoff * (gap.lengths / gap.speed + 2 * end);
    const long double before = std::max(0.0L, end - slack);
    const long double beyond = std::min<long double>(m.limit, end + slack);
    if (gap.at(before) > gap.error(before) && gap.at(beyond) < -gap.error(beyond)) return round_down(before);
  }
  return exact_free_path(wall, m);
}

// ---- plain

double plain_free_path(const Facet& f, const Motion& m) {
  const double length = m.direction.stableNorm();
  if (!(length > 0)) return m.limit;
  const double skin = rounding_skin(lengths_of(f, m));
  const double limit = m.limit * length;
  const double t = first_contact(f, m.c, m.r, m.direction / length, limit, skin);
  return t == limit ? m.limit : std::min(t / length, m.limit);
}

/// Of a ball that is to keep away from the wall of a piece the one that keeps away from the piece.
Motion around_inset(const Facet& f, Motion motion) {
  motion.r = std::max(0.0, sum_rounded_up(motion.r, f.radius));
  return motion;
}

}  // namespace

double lengths_of(const Facet& f, const Motion& m) {
  double coordinate = std::max(m.c.cwiseAbs().maxCoeff(), f.a.cwiseAbs().maxCoeff());
  double distance = (m.c - f.a).norm();
  if (f.kind == Facet::Kind::frustum) distance += f.c.cwiseAbs().sum();
  if (f.kind == Facet::Kind::triangle)
    for (const Vector<3>* corner : {&f.b, &f.c}) {
      coordinate = std::max(coordinate, corner->cwiseAbs().maxCoeff());
      distance = std::max(distance, (m.c - *corner).norm());
    }
  return coordinate + distance + std::abs(f.radius) + m.r;
}

double free_path(const Corners& triangle, const Motion& motion, WallArithmetic arithmetic) {
  if (arithmetic == WallArithmetic::exact) return exact_free_path(triangle, motion);
  if (arithmetic == WallArithmetic::filtered) return filtered_free_path(triangle, motion);
  return plain_free_path({Facet::Kind::triangle, 0, triangle[0], triangle[1], triangle[2], 0}, motion);
}

double free_path(const AnalyticWall& wall, const Motion& motion, WallArithmetic arithmetic) {
  if (arithmetic == WallArithmetic::exact) return exact_free_path(wall, motion);
  if (arithmetic == WallArithmetic::filtered) return filtered_free_path(wall, motion);
  Facet facet{wall.kind, 0, wall.point, wall.axis, Vector<3>::Zero(), wall.radius};
  if (wall.kind != Facet::Kind::sphere) facet.b.stableNormalize();
  if (wall.kind == Facet::Kind::plane) facet.a -= wall.radius * facet.b;
  return plain_free_path(facet, motion);
}

double free_path(std::span<const AnalyticWall> walls, const Motion& motion, WallArithmetic arithmetic) {
  Motion rest = motion;
  for (const AnalyticWall& wall : walls) rest.limit = free_path(wall, rest, arithmetic);
  return rest.limit;
}

double free_path(const Facet& f, const Motion& motion, WallArithmetic arithmetic) {
  if (f.kind == Facet::Kind::triangle)
    return free_path(Corners{f.a, f.b, f.c}, around_inset(f, motion), arithmetic);
  if (f.kind == Facet::Kind::frustum) {
    if (arithmetic == WallArithmetic::plain) return plain_free_path(f, motion);
    return free_path(edge_of(f), around_inset(f, motion), arithmetic);
  }
  return free_path(wall_of(f), motion, arithmetic);
}

long double gap_after(const Facet& f, const Motion& m, long double t) {
  if (f.kind == Facet::Kind::frustum) {
    const Motion around = around_inset(f, m);
    return FrustumWay(edge_of(f), around.c, around.direction).distance(t) - around.r;
  }
  if (f.kind != Facet::Kind::triangle) return gap_after(wall_of(f), m, t);
  const WideWay way({f.a, f.b, f.c}, around_inset(f, m));
  return nearest_of_triangle(ways_from(way.from_start, way.direction, t)).offset.norm() - way.r;
}

long double gap_after(const AnalyticWall& wall, const Motion& m, long double t) {
  return WideGap(wall, m).at(t);
}

double clear_radius(const Container& container, const Vector<3>& c, double reach) {
  const double guess = container.clearance_within(c, reach);
  if (container.arithmetic() == WallArithmetic::plain) return std::max(0.0, guess);
  const auto clears = [&](double r) { return container.contains(c, r); };
  if (!clears(0)) return 0;
  if (clears(reach)) return reach;
  return last_clear(guess, reach, clears);
}

double first_contact_exactly(const Facet& f, const Motion& of, double skin) {
  const Motion m = has_border(f.kind) ? around_inset(f, of) : of;
  if (f.kind == Facet::Kind::frustum) return first_contact_exactly(edge_of(f), m, skin);
  const double stop = m.r + skin, ignore = m.r + 0.5 * skin;
  if (f.kind == Facet::Kind::triangle) {
    const Corners corners{f.a, f.b, f.c};
    if (way_clears_exactly(corners, m, ignore, std::min(m.limit, largest_double))) return m.limit;
    return exact_free_path(corners, {m.c, stop, m.direction, m.limit});
  }
  const AnalyticWall wall = wall_of(f);
  const auto clears = [&](double t, double r) { return clears_exactly(wall, place_after(m, t), r); };
  const double limit = std::min(m.limit, largest_double);
  const bool starts_clear = clears(0, ignore);
  if (starts_clear && clears(limit, ignore)) return m.limit;
  const Motion widened{m.c, stop, m.direction, m.limit};
  if (clears(0, stop)) return exact_free_path(wall, widened);
  // It may still come off a round wall and meet it again on the other side.
  const long double end = WideGap(wall, widened).end();
  if (!(end > 0)) return 0;
  const double back = std::min(limit, round_down(end * (1 - 4 * tolerance::roundoff)));
  return clears(back, stop) ? back : 0;
}

}  // namespace bernal
