#include "hard/convex_walls.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "bernal/core/random.hpp"

namespace bernal {
namespace {

/// Coefficients and offsets are of order one: what is less than this is rounding.
constexpr double rounding = 1e-13;

/// a·x <= b
template <int D>
struct HalfSpace {
  Vector<D> a;
  double b;
};

/// Without component k, which is (plane.b - rest of plane.a · rest of x) / plane.a[k].
template <int D>
Vector<D - 1> without(const Vector<D>& v, int k, const HalfSpace<D>& plane) {
  Vector<D - 1> rest;
  for (int from = 0, to = 0; from < D; ++from)
    if (from != k) rest[to++] = v[from] - v[k] / plane.a[k] * plane.a[from];
  return rest;
}
template <int D>
HalfSpace<D - 1> on_plane(const HalfSpace<D>& h, int k, const HalfSpace<D>& plane) {
  return {without<D>(h.a, k, plane), h.b - h.a[k] / plane.a[k] * plane.b};
}

/// The x in the box and in all half-spaces for which goal·x is the most.
template <int D>
Vector<D> optimum(const Vector<D>& goal, const std::vector<HalfSpace<D>>& spaces, const Bounds<D>& box) {
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
      const HalfSpace<D>& plane = spaces[i];
      if (plane.a.dot(x) <= plane.b + rounding) continue;
      int k;
      if (!(plane.a.cwiseAbs().maxCoeff(&k) > rounding)) continue;
      std::vector<HalfSpace<D - 1>> rest;
      rest.push_back(on_plane<D>({Vector<D>::Unit(k), box.upper[k]}, k, plane));
      rest.push_back(on_plane<D>({-Vector<D>::Unit(k), -box.lower[k]}, k, plane));
      for (std::size_t j = 0; j < i; ++j) rest.push_back(on_plane<D>(spaces[j], k, plane));
      Bounds<D - 1> side;
      for (int from = 0, to = 0; from < D; ++from) {
        if (from == k) continue;
        side.lower[to] = box.lower[from];
        side.upper[to++] = box.upper[from];
      }
      const Vector<D - 1> y = optimum<D - 1>(without<D>(goal, k, plane), rest, side);
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

}  // namespace

LargestSphere largest_sphere_between(std::span<const Wall<3>> planes, const Bounds<3>& bounds) {
  const Vector<3> middle = bounds.center();
  const double unit = bounds.diagonal();
  std::vector<HalfSpace<4>> spaces;
  for (const Wall<3>& plane : planes) {
    Vector<4> a;
    a << plane.along, 1;
    spaces.push_back({a, plane.clearance(middle) / unit});
  }
  Random random(0, stream(Stream::room));
  for (std::size_t i = spaces.size(); i > 1; --i)
    std::swap(spaces[i - 1], spaces[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
  const Vector<4> best =
      optimum<4>(Vector<4>::Unit(3), spaces, {-Vector<4>::Constant(2), Vector<4>::Constant(2)});
  LargestSphere largest{middle + unit * best.head<3>(), std::numeric_limits<double>::infinity()};
  for (const Wall<3>& plane : planes)
    largest.radius = std::min(largest.radius, plane.clearance(largest.center));
  return largest;
}

}  // namespace bernal
