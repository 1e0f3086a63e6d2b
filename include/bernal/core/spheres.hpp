#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// Spheres in D dimensions as a structure of arrays: one column an axis, one of radii.
///
/// Sphere `i` has its centre at `(x[0][i], …, x[D-1][i])` and the radius `r[i]`, all in the length unit of
/// the owner. All columns have the same length. The order of the spheres is part of the value.
template <int D>
struct Spheres {
  std::array<std::vector<double>, D> x;
  std::vector<double> r;

  std::size_t size() const { return r.size(); }
  bool empty() const { return r.empty(); }

  Vector<D> center(std::size_t i) const {
    Vector<D> c;
    for (int k = 0; k < D; ++k) c[k] = x[k][i];
    return c;
  }
  void set_center(std::size_t i, const Vector<D>& c) {
    for (int k = 0; k < D; ++k) x[k][i] = c[k];
  }
  void push_back(const Vector<D>& c, double radius) {
    for (int k = 0; k < D; ++k) x[k].push_back(c[k]);
    r.push_back(radius);
  }
  void reserve(std::size_t n) {
    for (auto& column : x) column.reserve(n);
    r.reserve(n);
  }
  bool operator==(const Spheres&) const = default;
};

}  // namespace bernal
