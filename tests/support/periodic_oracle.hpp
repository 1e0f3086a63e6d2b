#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "support/packing_oracle.hpp"

// What is true of a packing in a periodic box, from the definition: all pairs, all images, rational numbers.

namespace bernal::oracle {

/// Every n edge + d that can be the nearest to zero, and some more: n runs from -m to m with m edges > |d|.
inline std::vector<Rational> images(double a, double b, double edge) {
  const Rational d = Rational(a) - Rational(b), period(edge);
  std::vector<Rational> all{d};
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
  if (i == j) return reach >= Rational(edges.minCoeff());
  for (int k = 0; k < s.dimension(); ++k) {
    const Rational a(s.x[k][i]), b(s.x[k][j]);
    const Rational size = std::max(abs(a), abs(b)) + reach + Rational(edges[k]);
    const auto near = [&](const Rational& d) { return abs(d) <= reach + Rational(margin) * size; };
    if (std::ranges::none_of(images(s.x[k][i], s.x[k][j], edges[k]), near)) return false;
  }
  return true;
}

inline Verdict judge(const Spheres<dynamic>& s, const Box& box, double allowed = 0) {
  Verdict v;
  v.max_overlap = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t j = i; j < s.size(); ++j) {
      const Rational squared = least_squared_distance(s, i, j, box.size);
      const Rational sum = Rational(s.r[i]) + Rational(s.r[j]), reach = (1 - Rational(allowed)) * sum;
      v.overlapping += squared < reach * reach ? 1 : 0;
      const bool near = images_touch(s, i, j, box.size);
      v.near_at_least += near ? 1 : 0;
      v.near_at_most += near || images_touch(s, i, j, box.size, 0x1p-50) ? 1 : 0;
      const double ratio = std::sqrt(Rational(squared / (sum * sum)).convert_to<double>());
      if (near) v.max_overlap = std::max(v.max_overlap, 1 - ratio);
    }
  return v;
}

}  // namespace bernal::oracle
