#pragma once
#include <array>
#include <cstddef>
#include <utility>
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
  void resize(std::size_t n) {
    for (auto& column : x) column.resize(n);
    r.resize(n);
  }
  bool operator==(const Spheres&) const = default;
};

/// Spheres in as many dimensions as `x` has columns: what results and files hold. Algorithms take `in<D>()`.
template <>
struct Spheres<dynamic> {
  std::vector<std::vector<double>> x;
  std::vector<double> r;

  explicit Spheres(int dimension = 3) : x(static_cast<std::size_t>(dimension)) {}
  /// Moves the columns of an rvalue: O(1).
  template <int D>
  Spheres(Spheres<D> spheres) : r(std::move(spheres.r)) {
    for (auto& column : spheres.x) x.push_back(std::move(column));
  }

  int dimension() const { return static_cast<int>(x.size()); }
  std::size_t size() const { return r.size(); }
  bool empty() const { return r.empty(); }

  Vector<dynamic> center(std::size_t i) const {
    Vector<dynamic> c(dimension());
    for (std::size_t k = 0; k < x.size(); ++k) c[static_cast<int>(k)] = x[k][i];
    return c;
  }
  void set_center(std::size_t i, const Vector<dynamic>& c) {
    for (std::size_t k = 0; k < x.size(); ++k) x[k][i] = c[static_cast<int>(k)];
  }
  void push_back(const Vector<dynamic>& c, double radius) {
    for (std::size_t k = 0; k < x.size(); ++k) x[k].push_back(c[static_cast<int>(k)]);
    r.push_back(radius);
  }
  void reserve(std::size_t n) {
    for (auto& column : x) column.reserve(n);
    r.reserve(n);
  }
  void resize(std::size_t n) {
    for (auto& column : x) column.resize(n);
    r.resize(n);
  }
  /// A copy with the dimension fixed; precondition: D == dimension().
  template <int D>
  Spheres<D> in() const {
    Spheres<D> spheres;
    for (std::size_t k = 0; k < D; ++k) spheres.x[k] = x[k];
    spheres.r = r;
    return spheres;
  }
  bool operator==(const Spheres&) const = default;
};

}  // namespace bernal
