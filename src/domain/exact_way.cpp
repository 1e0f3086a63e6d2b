#include "domain/exact_way.hpp"

namespace bernal {
namespace {

/// Whether p + s·d, 0 <= s <= 1, keeps at least r from the point v. With w = v - p: the nearest s is that of
/// w·d / d², and there the squared distance is |w|² - (w·d)² / d².
bool segment_clears_point(const ExactVector& p, const ExactVector& d, const Dyadic& dd, const ExactVector& v,
                          const Dyadic& rr) {
  const ExactVector w = v - p;
  const Dyadic along = dot(w, d);
  if (along.sign() <= 0) return dot(w, w) >= rr;
  if (along >= dd) {
    const ExactVector rest = w - d;
    return dot(rest, rest) >= rr;
  }
  return dot(w, w) * dd - square(along) >= rr * dd;
}

/// Whether the inner points of two segments p + s·d and a + k·e keep r from each other where the lines come
/// nearest; true where they do that elsewhere.
bool inner_points_clear(const ExactVector& p, const ExactVector& d, const Dyadic& dd, const ExactVector& a,
                        const ExactVector& e, const Dyadic& rr) {
  const ExactVector across = cross(d, e);
  const Dyadic squared = dot(across, across);  // = dd·ee - (d·e)²
  if (squared.sign() == 0) return true;        // parallel: an end or a corner is as near
  const ExactVector w = p - a;
  const Dyadic de = dot(d, e), ee = dot(e, e), dw = dot(d, w), ew = dot(e, w);
  const Dyadic s = de * ew - ee * dw;
  if (s.sign() < 0 || s > squared) return true;
  const Dyadic k = dd * ew - de * dw;
  if (k.sign() < 0 || k > squared) return true;
  return square(dot(w, across)) >= rr * squared;
}

struct ExactTriangle {
  explicit ExactTriangle(const Corners& t) : corner{exact(t[0]), exact(t[1]), exact(t[2])} {
    for (std::size_t i = 0; i < 3; ++i) {
      edge[i] = corner[(i + 1) % 3] - corner[i];
      squared_edge[i] = dot(edge[i], edge[i]);
    }
    normal = cross(edge[0], edge[1]);
    squared_normal = dot(normal, normal);
  }

  /// Whether p keeps r from the inner points; true where the foot of p is not among them.
  bool inside_clears(const ExactVector& p, const Dyadic& rr) const {
    if (squared_normal.sign() == 0) return true;
    for (std::size_t i = 0; i < 3; ++i)
      if (dot(cross(edge[i], p - corner[i]), normal).sign() < 0) return true;
    return square(dot(p - corner[0], normal)) >= rr * squared_normal;
  }

  /// Whether p + s·d passes through it, from one side of its plane to the other.
  bool is_crossed(const ExactVector& p, const ExactVector& d) const {
    if (squared_normal.sign() == 0) return false;
    const int before = dot(p - corner[0], normal).sign(), after = dot(p + d - corner[0], normal).sign();
    if (before * after >= 0) return false;
    for (std::size_t i = 0; i < 3; ++i)
      if (dot(cross(corner[i] - p, corner[(i + 1) % 3] - p), d).sign() * after < 0) return false;
    return true;
  }

  ExactVector corner[3], edge[3], normal;
  Dyadic squared_edge[3], squared_normal;
};

}  // namespace

ExactVector place_after(const Motion& motion, double t) {
  return exact(motion.c) + Dyadic(t) * exact(motion.direction);
}

bool clears_exactly(const AnalyticWall& wall, const ExactVector& p, double r) {
  ++exact_decisions;
  const ExactVector w = p - exact(wall.point);
  const Dyadic room = Dyadic(wall.radius) - Dyadic(r);
  if (wall.kind == Facet::Kind::sphere) return room.sign() >= 0 && dot(w, w) <= square(room);
  const ExactVector axis = exact(wall.axis);
  const Dyadic along = dot(w, axis), squared_axis = dot(axis, axis);
  if (wall.kind == Facet::Kind::cylinder)
    return room.sign() >= 0 && dot(w, w) * squared_axis - square(along) <= square(room) * squared_axis;
  const Dyadic squared_bound = square(room) * squared_axis;
  if (room.sign() >= 0) return along.sign() >= 0 || square(along) <= squared_bound;
  return along.sign() >= 0 && square(along) >= squared_bound;
}

bool way_clears_exactly(const Corners& corners, const Motion& motion, double r, double t) {
  ++exact_decisions;
  const ExactTriangle triangle(corners);
  const ExactVector p = exact(motion.c), d = Dyadic(t) * exact(motion.direction), end = p + d;
  const Dyadic dd = dot(d, d), rr = square(Dyadic(r));
  if (!triangle.inside_clears(p, rr) || !triangle.inside_clears(end, rr)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!segment_clears_point(p, d, dd, triangle.corner[i], rr)) return false;
    for (const ExactVector* q : {&p, &end})
      if (!segment_clears_point(triangle.corner[i], triangle.edge[i], triangle.squared_edge[i], *q, rr))
        return false;
    if (!inner_points_clear(p, d, dd, triangle.corner[i], triangle.edge[i], rr)) return false;
  }
  return !triangle.is_crossed(p, d);
}

}  // namespace bernal
