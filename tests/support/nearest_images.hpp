#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boost/multiprecision/cpp_int.hpp>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"

// What is true of spheres in a periodic box: all pairs, the nearest image of each, rational arithmetic.

namespace bernal::oracle {

/// Squared distance from the nearest image of centre j to centre i; for j = i from the nearest image that is
/// not the sphere itself. Exact.
template <int D>
boost::multiprecision::cpp_rational squared_image_distance(const Spheres<D>& s, const Vector<D>& edges,
                                                           std::size_t i, std::size_t j) {
  using Number = boost::multiprecision::cpp_rational;
  if (i == j) {
    const Number edge(edges.minCoeff());
    return edge * edge;
  }
  Number sum = 0;
  for (std::size_t k = 0; k < D; ++k) {
    const Number edge(edges[static_cast<int>(k)]);
    Number d = abs(Number(s.x[k][i]) - Number(s.x[k][j]));
    d = std::min(d, Number(abs(d - edge)));  // both lie in [0, edge)
    sum += d * d;
  }
  return sum;
}

/// Pairs that overlap, a sphere and its own image among them; exact. Precondition: centres in [0, edges).
template <int D>
std::uint64_t overlapping_pairs(const Spheres<D>& s, const Vector<D>& edges) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    for (std::size_t j = i; j < s.size(); ++j) {
      const boost::multiprecision::cpp_rational reach =
          boost::multiprecision::cpp_rational(s.r[i]) + boost::multiprecision::cpp_rational(s.r[j]);
      // Double precision is enough for most.
      double squared = 0;
      for (std::size_t k = 0; k < D && i != j; ++k) {
        const double d = std::remainder(s.x[k][i] - s.x[k][j], edges[static_cast<int>(k)]);
        squared += d * d;
      }
      const double sum = s.r[i] + s.r[j];
      if (squared > 1.001 * sum * sum) continue;
      count += squared_image_distance(s, edges, i, j) < reach * reach ? 1 : 0;
    }
  }
  return count;
}

/// The largest (ri + rj) / d, from all pairs.
template <int D>
double contact_factor(const Spheres<D>& s, const Vector<D>& edges) {
  double factor = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    factor = std::max(factor, 2 * s.r[i] / edges.minCoeff());
    for (std::size_t j = i + 1; j < s.size(); ++j) {
      double squared = 0;
      for (std::size_t k = 0; k < D; ++k) {
        const double d = std::remainder(s.x[k][i] - s.x[k][j], edges[static_cast<int>(k)]);
        squared += d * d;
      }
      factor = std::max(factor, (s.r[i] + s.r[j]) / std::sqrt(squared));
    }
  }
  return factor;
}

template <int D>
bool centers_in_box(const Spheres<D>& s, const Vector<D>& edges) {
  for (std::size_t k = 0; k < D; ++k)
    for (const double x : s.x[k])
      if (!(x >= 0 && x < edges[static_cast<int>(k)])) return false;
  return true;
}

/// `n` spheres anywhere in the box, as many in every octave of radii.
template <int D>
Spheres<D> anywhere(std::size_t n, double r_min, double r_max, const Vector<D>& edges, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  Spheres<D> spheres;
  for (std::size_t i = 0; i < n; ++i) {
    const double r = std::clamp(r_min * std::pow(r_max / r_min, random.uniform()), r_min, r_max);
    spheres.push_back(uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges}), r);
  }
  return spheres;
}

}  // namespace bernal::oracle
