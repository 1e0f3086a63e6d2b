#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "support/packing_oracle.hpp"

// What is true of a packing in a domain that repeats itself, from the definition: all pairs, all images,
// rational numbers.

namespace bernal::oracle {

/// The period of every axis, 0 where it has none. The axis of a periodic cylinder has one component.
inline Vector<dynamic> periods_of(const Domain& domain) {
  if (const auto* box = std::get_if<Box>(&domain)) {
    Vector<dynamic> periods = box->size;
    for (int k = 0; k < box->dimension(); ++k)
      if (box->periodic.empty() || !box->periodic[static_cast<std::size_t>(k)]) periods[k] = 0;
    return periods;
  }
  Vector<dynamic> periods = Vector<3>::Zero();
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  for (int k = 0; cylinder && cylinder->periodic && k < 3; ++k)
    if (cylinder->axis[k] != 0) periods[k] = cylinder->height;
  return periods;
}

/// Every n edge + d that can be the nearest to zero, and some more: n runs from -m to m with m edges > |d|.
/// Only d where the edge is 0.
inline std::vector<Rational> images(double a, double b, double edge) {
  const Rational d = Rational(a) - Rational(b), period(edge);
  std::vector<Rational> all{d};
  if (edge == 0) return all;
  for (Rational n = 1; n == 1 || (n - 1) * period <= abs(d); n += 1) {
    all.push_back(d + n * period);
    all.push_back(d - n * period);
  }
  return all;
}

/// The least squared distance over all image vectors; of a sphere from itself, over all but the one to
/// itself.
inline Rational least_squared_distance(const Spheres<dynamic>& s, std::size_t i, std::size_t j,
                                       const Vector<dynamic>& edges) {
  std::vector<std::vector<Rational>> offsets;
  for (int k = 0; k < s.dimension(); ++k) offsets.push_back(images(s.x[k][i], s.x[k][j], edges[k]));
  std::optional<Rational> least;
  const auto try_all = [&](const auto& self, std::size_t axis, const Rational& so_far) -> void {
    if (axis == offsets.size()) {
      if (i == j && so_far == 0) return;
      if (!least || so_far < *least) least = so_far;
      return;
    }
    for (const Rational& offset : offsets[axis]) self(self, axis + 1, so_far + offset * offset);
  };
  try_all(try_all, 0, 0);
  return *least;
}

/// On every axis some images of the two balls have coordinates in common, or miss that by `margin` times the
/// largest number; of a ball with itself, on an axis with another image than the ball.
inline bool images_touch(const Spheres<dynamic>& s, std::size_t i, std::size_t j,
                         const Vector<dynamic>& edges, double margin = 0) {
  const Rational reach = Rational(s.r[i]) + Rational(s.r[j]);
  if (i == j)
    return std::ranges::any_of(edges, [&](double edge) { return edge > 0 && reach >= Rational(edge); });
  for (int k = 0; k < s.dimension(); ++k) {
    const Rational a(s.x[k][i]), b(s.x[k][j]);
    const Rational size = std::max(abs(a), abs(b)) + reach + Rational(edges[k]);
    const auto near = [&](const Rational& d) { return abs(d) <= reach + Rational(margin) * size; };
    if (std::ranges::none_of(images(s.x[k][i], s.x[k][j], edges[k]), near)) return false;
  }
  return true;
}

inline Verdict judge(const Spheres<dynamic>& s, const Domain& domain, double allowed = 0) {
  const Vector<dynamic> periods = periods_of(domain);
  Verdict v;
  v.max_overlap = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < s.size(); ++i) {
    v.protruding += inside(s.center(i), s.r[i], domain) ? 0 : 1;
    for (std::size_t j = periods.isZero(0) ? i + 1 : i; j < s.size(); ++j) {
      const Rational squared = least_squared_distance(s, i, j, periods);
      const Rational sum = Rational(s.r[i]) + Rational(s.r[j]), reach = (1 - Rational(allowed)) * sum;
      if (squared < reach * reach) v.pairs.push_back({i, j});
      const bool near = images_touch(s, i, j, periods);
      v.near_at_least += near ? 1 : 0;
      v.near_at_most += near || images_touch(s, i, j, periods, 0x1p-50) ? 1 : 0;
      const double ratio = std::sqrt(Rational(squared / (sum * sum)).convert_to<double>());
      v.max_overlap = std::max(v.max_overlap, 1 - ratio);
    }
  }
  v.overlapping = v.pairs.size();
  return v;
}

}  // namespace bernal::oracle
