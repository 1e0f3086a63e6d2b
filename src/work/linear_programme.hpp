#pragma once
#include <algorithm>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// a·x <= b
template <int D>
struct Constraint {
  Vector<D> a;
  double b;
};

namespace linear_programme {

/// Coefficients and offsets are of order one: what is less than this is rounding.
inline constexpr double rounding = 1e-13;

/// Without component k, which is (plane.b - rest of plane.a · rest of x) / plane.a[k].
template <int D>
Vector<D - 1> without(const Vector<D>& v, int k, const Constraint<D>& plane) {
  Vector<D - 1> rest;
  for (int from = 0, to = 0; from < D; ++from)
    if (from != k) rest[to++] = v[from] - v[k] / plane.a[k] * plane.a[from];
  return rest;
}
template <int D>
Constraint<D - 1> on_plane(const Constraint<D>& h, int k, const Constraint<D>& plane) {
  return {without<D>(h.a, k, plane), h.b - h.a[k] / plane.a[k] * plane.b};
}

}  // namespace linear_programme

/// The x in the box and in all half-spaces for which goal·x is the most. Half-spaces come one after the
/// other; one that leaves the best x so far outside is touched by the next best, which is the same programme
/// with a variable less. Where no x is in all of them, the answer is in the last ones that cut it off.
/// Cost: O(half-spaces), expected, if their order is random. Source: Seidel, Discrete Comput. Geom. 6, 423
/// (1991).
template <int D>
Vector<D> optimum(const Vector<D>& goal, const std::vector<Constraint<D>>& spaces, const Bounds<D>& box) {
  using linear_programme::rounding;
  if constexpr (D == 1) {
    double from = box.lower[0], to = box.upper[0];
    for (const auto& [a, b] : spaces) {
      if (a[0] > rounding) to = std::min(to, b / a[0]);
      if (a[0] < -rounding) from = std::max(from, b / a[0]);
    }
    return Vector<1>(goal[0] > 0 ? to : from);
  } else {
    Vector<D> x = (goal.array() > 0).select(box.upper, box.lower);
    for (std::size_t i = 0; i < spaces.size(); ++i) {
      const Constraint<D>& plane = spaces[i];
      if (plane.a.dot(x) <= plane.b + rounding) continue;
      int k;
      if (!(plane.a.cwiseAbs().maxCoeff(&k) > rounding)) continue;
      std::vector<Constraint<D - 1>> rest;
      rest.push_back(linear_programme::on_plane<D>({Vector<D>::Unit(k), box.upper[k]}, k, plane));
      rest.push_back(linear_programme::on_plane<D>({-Vector<D>::Unit(k), -box.lower[k]}, k, plane));
      for (std::size_t j = 0; j < i; ++j) rest.push_back(linear_programme::on_plane<D>(spaces[j], k, plane));
      Bounds<D - 1> side;
      for (int from = 0, to = 0; from < D; ++from) {
        if (from == k) continue;
        side.lower[to] = box.lower[from];
        side.upper[to++] = box.upper[from];
      }
      const Vector<D - 1> y = optimum<D - 1>(linear_programme::without<D>(goal, k, plane), rest, side);
      double along = plane.b;
      for (int to = 0, from = 0; to < D; ++to) {
        if (to == k) continue;
        along -= plane.a[to] * y[from];
        x[to] = y[from++];
      }
      x[k] = along / plane.a[k];
    }
    return x;
  }
}

}  // namespace bernal
