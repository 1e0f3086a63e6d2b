#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>  // cross products
#include <algorithm>
#include <initializer_list>
#include <limits>
#include <type_traits>
#include <utility>

namespace bernal {

/// Dimensions run from 1 to this.
inline constexpr int max_dimension = 8;
/// In place of a dimension: only known when the program runs.
inline constexpr int dynamic = Eigen::Dynamic;

/// A point or a displacement in D dimensions, in the length unit of its owner. `Vector<dynamic>` holds up to
/// max_dimension components, without an allocation.
template <int D>
using Vector = Eigen::Matrix<double, D, 1, 0, D == dynamic ? max_dimension : D, 1>;

// Sums, differences and multiples of vectors of a fixed dimension are vectors, not expressions of Eigen's,
// whose types take the compiler a fifth of its time. The arithmetic is the same, component by component.
template <class T>
concept Scalar = std::is_arithmetic_v<T>;
template <int D>
using FixedVector = std::enable_if_t<(D > 0), Vector<D>>;

template <int D, class F>
FixedVector<D> by_component(F component) {
  Vector<D> v;
  [&]<int... k>(std::integer_sequence<int, k...>) { ((v.coeffRef(k) = component(k)), ...); }
  (std::make_integer_sequence<int, D>());
  return v;
}

template <int D>
FixedVector<D> operator+(const Vector<D>& a, const Vector<D>& b) {
  return by_component<D>([&](int k) { return a.coeff(k) + b.coeff(k); });
}
template <int D>
FixedVector<D> operator-(const Vector<D>& a, const Vector<D>& b) {
  return by_component<D>([&](int k) { return a.coeff(k) - b.coeff(k); });
}
template <int D>
FixedVector<D> operator-(const Vector<D>& a) {
  return by_component<D>([&](int k) { return -a.coeff(k); });
}
template <Scalar T, int D>
FixedVector<D> operator*(T t, const Vector<D>& a) {
  return by_component<D>([&](int k) { return static_cast<double>(t) * a.coeff(k); });
}
template <int D, Scalar T>
FixedVector<D> operator*(const Vector<D>& a, T t) {
  return by_component<D>([&](int k) { return a.coeff(k) * static_cast<double>(t); });
}
template <int D, Scalar T>
FixedVector<D> operator/(const Vector<D>& a, T t) {
  return by_component<D>([&](int k) { return a.coeff(k) / static_cast<double>(t); });
}

/// The same for a dimension that is only known when the program runs, written as a list: {1, 2, 3}.
struct Coordinates : Vector<dynamic> {
  Coordinates(std::initializer_list<double> values) : Vector<dynamic>(static_cast<int>(values.size())) {
    std::copy(values.begin(), values.end(), data());
  }
  template <class Derived>
  Coordinates(const Eigen::MatrixBase<Derived>& other) : Vector<dynamic>(other) {}
  using Vector<dynamic>::operator=;
};

/// Axis-aligned bounds, `lower <= upper` in every component, unless they are `of_nothing`.
template <int D>
struct Bounds {
  Vector<D> lower = Vector<D>::Zero();
  Vector<D> upper = Vector<D>::Zero();

  Vector<D> size() const { return upper - lower; }
  Vector<D> center() const { return lower + 0.5 * (upper - lower); }
  double diagonal() const { return size().norm(); }
  double volume() const { return size().prod(); }

  /// Bounds to which points are then added.
  static Bounds of_nothing() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {Vector<D>::Constant(infinity), Vector<D>::Constant(-infinity)};
  }
  void add(const Vector<D>& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  /// Whether they have a point in common.
  bool meets(const Bounds& other) const {
    return (lower.array() <= other.upper.array()).all() && (other.lower.array() <= upper.array()).all();
  }
};

}  // namespace bernal
