#include "cad/certified_distance.hpp"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bernal/core/tolerance.hpp"
#include "domain/exact_way.hpp"
#include "kernels/closest_point.hpp"

namespace bernal::cad {
namespace {

using tolerance::roundoff;

/// Lengths and weights below this are useless as a guess: their products might underflow.
constexpr double least_meaning = 1e-140;

using Corners = std::array<Vector<3>, 3>;

/// A lower bound of min_i n·w_i / |n| for exact w_i, n as given and not zero. `farthest` >= |w_i| for all i.
///
/// With u the roundoff: a computed w_i is off by at most u per component, relatively; the dot product of two
/// 3-vectors by at most 3u |n|·|w_i| (componentwise absolute values, so at most 3u |n| |w_i| in norms);
/// together below 4.01 u |n| |w_i|. The norm |n| is right to 3u, the quotient adds one u more: taking 6 for
/// the first and widening the result by 8u of itself covers them.
double lower_bound(const Corners& w, const Vector<3>& n, double farthest) {
  const double length = n.norm();
  if (!(length > least_meaning)) return 0;
  const double least = std::min({n.dot(w[0]), n.dot(w[1]), n.dot(w[2])});
  const double bound = least / length - 6 * roundoff * farthest;
  return std::max(0.0, bound * (1 - 8 * roundoff));
}

/// An upper bound of |sum lambda_i w_i| / sum lambda_i for exact w_i and the lambda_i >= 0 as given.
///
/// Each product lambda_i w_i is off by 2u of itself (w_i and the product), two additions add 2u of the
/// partial sums: below 4.01 u · sum lambda_i |w_i| <= 4.01 u · farthest · sum lambda_i. Norm, sum and
/// quotient add a few u of the result.
double upper_bound(const Corners& w, const Vector<3>& lambda, double farthest) {
  const double sum = lambda[0] + lambda[1] + lambda[2];
  if (!(sum > least_meaning)) return farthest;
  const Vector<3> offset = lambda[0] * w[0] + lambda[1] * w[1] + lambda[2] * w[2];
  return (offset.norm() / sum + 6 * roundoff * farthest) * (1 + 8 * roundoff);
}

/// Weights of the vertices for the point p - offset, none negative: areas of the three parts.
Vector<3> weights_of(const Corners& w, const Vector<3>& offset, const Vector<3>& normal) {
  Vector<3> lambda;
  for (int i = 0; i < 3; ++i) {
    const Vector<3> to_next = w[(i + 1) % 3] - offset, to_last = w[(i + 2) % 3] - offset;
    lambda[i] = std::max(0.0, normal.dot(to_next.cross(to_last)));
  }
  return lambda;
}

}  // namespace

DistanceBounds bound_distance(const Vector<3>& p, const WallTriangle& t) {
  const Corners w = {p - t.a, p - t.b, p - t.c};
  const double farthest =
      std::sqrt(std::max({w[0].squaredNorm(), w[1].squaredNorm(), w[2].squaredNorm()})) * (1 + 4 * roundoff);
  const Vector<3> offset = PreparedTriangle(t.a, t.b, t.c).offset(p);
  const Vector<3> normal = (t.b - t.a).cross(t.c - t.a);
  const Vector<3> facing = normal.dot(offset) < 0 ? Vector<3>(-normal) : normal;
  return {std::max(lower_bound(w, offset, farthest), lower_bound(w, facing, farthest)),
          upper_bound(w, weights_of(w, offset, normal), farthest)};
}

bool exactly_clears(const Vector<3>& p, const WallTriangle& t, double r) {
  using Kernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;
  ++exact_decisions;
  const auto exact = [](const Vector<3>& v) { return Kernel::Point_3(v[0], v[1], v[2]); };
  const Kernel::FT radius(r);
  return CGAL::squared_distance(exact(p), Kernel::Triangle_3(exact(t.a), exact(t.b), exact(t.c))) >=
         radius * radius;
}

bool certainly_clears(const Vector<3>& p, const WallTriangle& t, double r) {
  const DistanceBounds bounds = bound_distance(p, t);
  if (bounds.lower >= r) return true;
  if (bounds.upper < r) return false;
  return exactly_clears(p, t, r);
}

}  // namespace bernal::cad
