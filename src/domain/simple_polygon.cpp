#include "domain/simple_polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <string>

#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {
namespace {

struct PolygonEdge {
  Vector<2> a, b;
  std::size_t loop, corner;  ///< the number of its first corner in its line
  std::size_t next;          ///< in the list of all

  double lower(int k) const { return std::min(a[k], b[k]); }
  double upper(int k) const { return std::max(a[k], b[k]); }
};

[[noreturn]] void refuse_polygon(const std::string& why) { throw Error(ErrorCode::bad_argument, why); }

std::string name_of_loop(std::size_t loop) {
  return loop == 0 ? std::string("the outline") : fmt::format("hole {}", loop);
}
std::string name_of_edge(const PolygonEdge& e) {
  return fmt::format("edge {} of {}, from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}),", e.corner + 1,
                     name_of_loop(e.loop), e.a[0], e.a[1], e.b[0], e.b[1]);
}

/// The sign of (b - a) × (c - a): exact where the double, with an error of at most 8 roundoffs of the sum of
/// its products' sizes, does not tell (Shewchuk 1997, section 4.3, has 3 + 16 roundoffs).
int orientation(const Vector<2>& a, const Vector<2>& b, const Vector<2>& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
  const double bound = 8 * tolerance::roundoff * (std::abs(left) + std::abs(right));
  if (left - right > bound && bound > 0x1p-900) return 1;
  if (right - left > bound && bound > 0x1p-900) return -1;
  using Rational = boost::multiprecision::cpp_rational;
  const Rational ax = a[0], ay = a[1];
  return ((Rational(b[0]) - ax) * (Rational(c[1]) - ay) - (Rational(b[1]) - ay) * (Rational(c[0]) - ax))
      .sign();
}

/// Of a point on the line of the edge.
bool is_between_ends(const PolygonEdge& e, const Vector<2>& p) {
  return p[0] >= e.lower(0) && p[0] <= e.upper(0) && p[1] >= e.lower(1) && p[1] <= e.upper(1);
}

bool have_common_point(const PolygonEdge& e, const PolygonEdge& f) {
  const int ea = orientation(f.a, f.b, e.a), eb = orientation(f.a, f.b, e.b);
  const int fa = orientation(e.a, e.b, f.a), fb = orientation(e.a, e.b, f.b);
  if (ea * eb < 0 && fa * fb < 0) return true;
  return (ea == 0 && is_between_ends(f, e.a)) || (eb == 0 && is_between_ends(f, e.b)) ||
         (fa == 0 && is_between_ends(e, f.a)) || (fb == 0 && is_between_ends(e, f.b));
}

/// About where.
Vector<2> common_point(const PolygonEdge& e, const PolygonEdge& f) {
  const Vector<2> u = e.b - e.a, v = f.b - f.a, w = f.a - e.a;
  const double cross = u[0] * v[1] - u[1] * v[0];
  if (cross != 0) return e.a + std::clamp((w[0] * v[1] - w[1] * v[0]) / cross, 0.0, 1.0) * u;
  return is_between_ends(e, f.a) ? f.a : is_between_ends(e, f.b) ? f.b : e.a;
}

/// Those with a length.
std::vector<PolygonEdge> edges_with_length(const Polygon& polygon) {
  std::vector<PolygonEdge> edges;
  for (std::size_t l = 0; l < polygon.loops.size(); ++l) {
    const auto& loop = polygon.loops[l];
    for (std::size_t k = 0; k < loop.size(); ++k)
      if (!loop[k].allFinite())
        refuse_polygon(fmt::format("corner {} of {} is not finite", k + 1, name_of_loop(l)));
    const std::size_t first = edges.size();
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector<2>&a = loop[k], &b = loop[(k + 1) % loop.size()];
      if (a != b) edges.push_back({a, b, l, k, edges.size() + 1});
    }
    if (edges.size() - first < 3)
      refuse_polygon(fmt::format("{} has {} different corners, and a polygon needs three", name_of_loop(l),
                                 edges.size() - first));
    edges.back().next = first;
  }
  if (edges.empty()) refuse_polygon("a polygon needs three corners");
  return edges;
}

}  // namespace

void require_simple(const Polygon& polygon) {
  const std::vector<PolygonEdge> edges = edges_with_length(polygon);
  const auto refuse_pair = [](const PolygonEdge& e, const PolygonEdge& f) {
    const Vector<2> p = common_point(e, f);
    refuse_polygon(
        fmt::format("{} and {} meet at about ({:.6g}, {:.6g}): the lines of a polygon neither cross "
                    "nor touch themselves or each other",
                    name_of_edge(e), name_of_edge(f), p[0], p[1]));
  };
  std::vector<std::size_t> order(edges.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, [&](std::size_t i, std::size_t j) {
    return std::pair(edges[i].lower(0), i) < std::pair(edges[j].lower(0), j);
  });
  std::vector<std::size_t> open;  // whose bounds reach the front
  for (const std::size_t i : order) {
    const PolygonEdge& e = edges[i];
    std::erase_if(open, [&](std::size_t j) { return edges[j].upper(0) < e.lower(0); });
    for (const std::size_t j : open) {
      const PolygonEdge& f = edges[j];
      if (f.upper(1) < e.lower(1) || f.lower(1) > e.upper(1)) continue;
      if (e.next == j || f.next == i) {
        // Neighbours have one end in common, and more only where one runs back along the other.
        const PolygonEdge &before = e.next == j ? e : f, &after = e.next == j ? f : e;
        if (orientation(before.a, before.b, after.b) == 0 && (before.b - before.a).dot(after.b - after.a) < 0)
          refuse_polygon(fmt::format("{} runs back along the one before it", name_of_edge(after)));
      } else if (have_common_point(e, f)) {
        refuse_pair(std::min(i, j) == i ? e : f, std::min(i, j) == i ? f : e);
      }
    }
    open.push_back(i);
  }
}

bool is_inside(const std::vector<Vector<2>>& line, const Vector<2>& point) {
  bool inside = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Vector<2>&a = line[k], &b = line[(k + 1) % line.size()];
    if ((a[1] > point[1]) == (b[1] > point[1])) continue;
    // Of the ray towards +x: an edge that runs upwards crosses it where the point is on its left.
    inside ^= orientation(a, b, point) == (b[1] > a[1] ? 1 : -1);
  }
  return inside;
}

}  // namespace bernal
