#include "geometry/curved_patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bernal {
namespace {

using Swept = TrueSurface::Swept;
using Bezier = TrueSurface::Bezier;
using Pair = std::array<double, 2>;

constexpr double pi = std::numbers::pi;

/// 1, s, cos s, sin s.
struct Basis {
  double s, cosine, sine;

  explicit Basis(double at) : s(at), cosine(std::cos(at)), sine(std::sin(at)) {}

  /// The k-th derivatives.
  std::array<double, 4> derivative(int k) const {
    const double turned[] = {cosine, -sine, -cosine, sine};
    return {k == 0 ? 1.0 : 0.0, k == 0 ? s : k == 1 ? 1.0 : 0.0, turned[k % 4], turned[(k + 3) % 4]};
  }
};

/// The largest |cos| between a and b.
double largest_cosine(double a, double b) {
  constexpr double rounding = 1e-14;
  if (std::floor(b / pi + rounding) >= std::ceil(a / pi - rounding)) return 1;
  return std::max(std::abs(std::cos(a)), std::abs(std::cos(b)));
}

/// The largest absolute values of the same between a and b.
struct LargestBasis {
  double s, cosine, sine;

  LargestBasis(double a, double b)
      : s(std::max(std::abs(a), std::abs(b))),
        cosine(largest_cosine(a, b)),
        sine(largest_cosine(a - 0.5 * pi, b - 0.5 * pi)) {}

  std::array<double, 4> derivative(int k) const {
    const bool even = k % 2 == 0;
    return {k == 0 ? 1.0 : 0.0, k == 0 ? s : k == 1 ? 1.0 : 0.0, even ? cosine : sine, even ? sine : cosine};
  }
};

/// The longer semi-axis of the ellipse cos t a + sin t b: of the matrix of their products the root of the
/// larger eigenvalue.
double semi_axis(const Vector<3>& a, const Vector<3>& b) {
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
  return std::sqrt(0.5 * (aa + bb) + std::hypot(0.5 * (aa - bb), ab));
}

Vector<3> derivative_of(const Swept& patch, const Basis& u, const Basis& v, int k, int l) {
  const auto bu = u.derivative(k), bv = v.derivative(l);
  Vector<3> sum = Vector<3>::Zero();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) sum += bu[i] * bv[j] * patch.c[i][j];
  return sum;
}

/// Bounds of the derivatives of a sweep in a box.
class SweptBounds {
 public:
  SweptBounds(const Swept& patch, const ParameterBox& box)
      : patch_(patch),
        u_(box.lower[0], box.upper[0]),
        v_(box.lower[1], box.upper[1]),
        middle_u_(0.5 * (box.lower[0] + box.upper[0])),
        middle_v_(0.5 * (box.lower[1] + box.upper[1])),
        half_{0.5 * (box.upper[0] - box.lower[0]), 0.5 * (box.upper[1] - box.lower[1])} {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 4; ++i) length_[i][j] = patch.c[i][j].norm();
      turning_[j] = semi_axis(patch.c[2][j], patch.c[3][j]);
    }
  }

  /// The sum over the terms of their largest lengths; cosine and sine of u together.
  double largest_terms(int k, int l) const {
    const auto bu = u_.derivative(k), bv = v_.derivative(l);
    double sum = 0;
    for (int j = 0; j < 4; ++j)
      sum += bv[j] * (bu[0] * length_[0][j] + bu[1] * length_[1][j] +
                      std::min(turning_[j], bu[2] * length_[2][j] + bu[3] * length_[3][j]));
    return sum;
  }

  double largest_derivative(int k, int l) const {
    const double from_middle = derivative_of(patch_, middle_u_, middle_v_, k, l).norm() +
                               half_[0] * largest_terms(k + 1, l) + half_[1] * largest_terms(k, l + 1);
    return std::min(from_middle, largest_terms(k, l));
  }

 private:
  const Swept& patch_;
  LargestBasis u_, v_;
  Basis middle_u_, middle_v_;
  Pair half_;
  std::array<std::array<double, 4>, 4> length_{};
  std::array<double, 4> turning_{};
};

/// The control points of a line of them, `stride` apart, over [a, b] of [0, 1] in place, by de Casteljau's
/// algorithm.
void restrict_line(std::array<double, 4>* points, int degree, std::ptrdiff_t stride, double a, double b) {
  const auto cut = [&](double t, bool keep_right) {
    for (int level = 1; level <= degree; ++level)
      for (int n = 0; n + level <= degree; ++n) {
        const int i = keep_right ? n : degree - n;  // the point that is replaced
        auto& p = points[i * stride];
        const auto& other = points[(keep_right ? i + 1 : i - 1) * stride];
        for (int x = 0; x < 4; ++x)
          p[x] = keep_right ? (1 - t) * p[x] + t * other[x] : (1 - t) * other[x] + t * p[x];
      }
  };
  if (a < 0.5) {
    cut(a, true);
    cut((b - a) / (1 - a), false);
  } else {
    cut(b, false);
    cut(a / b, true);
  }
}

/// The part over a box, which is made wider where it is thin, so that differences of its points are no noise.
Bezier part_of(Bezier patch, const ParameterBox& box) {
  constexpr double thin = 1e-3;
  const int rows = patch.degree[0] + 1, columns = patch.degree[1] + 1;
  for (int k = 0; k < 2; ++k) {
    const double from = patch.lower[k], width = patch.upper[k] - from;
    double a = (box.lower[k] - from) / width, b = (box.upper[k] - from) / width;
    if (const double missing = thin - (b - a); missing > 0) a -= 0.5 * missing, b += 0.5 * missing;
    for (int line = 0; line < (k == 0 ? columns : rows); ++line)
      restrict_line(patch.points.data() + (k == 0 ? line : line * columns), patch.degree[k],
                    k == 0 ? columns : 1, a, b);
    patch.lower[k] = from + a * width;
    patch.upper[k] = from + b * width;
  }
  return patch;
}

/// Of the derivative of order (k, l) of the control points' polynomial: the largest |(x, y, z)| and |w|.
Pair largest_differences(const Bezier& patch, int k, int l) {
  std::array<int, 2> degree = patch.degree;
  if (k > degree[0] || l > degree[1]) return {0, 0};
  std::vector<std::array<double, 4>> points = patch.points;
  const auto differ = [&](int axis) {
    const int rows = degree[0] + 1, columns = degree[1] + 1;
    const double factor = degree[axis] / (patch.upper[axis] - patch.lower[axis]);
    std::vector<std::array<double, 4>> next;
    for (int i = 0; i + (axis == 0) < rows; ++i)
      for (int j = 0; j + (axis == 1) < columns; ++j) {
        const auto& a = points[i * columns + j];
        const auto& b = points[(i + (axis == 0)) * columns + j + (axis == 1)];
        std::array<double, 4> d;
        for (int x = 0; x < 4; ++x) d[x] = factor * (b[x] - a[x]);
        next.push_back(d);
      }
    --degree[axis];
    points = std::move(next);
  };
  for (int n = 0; n < k; ++n) differ(0);
  for (int n = 0; n < l; ++n) differ(1);
  Pair largest{0, 0};
  for (const auto& p : points) {
    largest[0] = std::max(largest[0], std::hypot(p[0], p[1], p[2]));
    largest[1] = std::max(largest[1], std::abs(p[3]));
  }
  return largest;
}

DerivativeBounds bounds_within(const Bezier& whole, const ParameterBox& box) {
  Bezier part = part_of(whole, box);
  double least_weight = std::numeric_limits<double>::infinity(), size = 0;
  Vector<3> middle = Vector<3>::Zero();
  for (const auto& p : part.points) {
    least_weight = std::min(least_weight, p[3]);
    middle += Vector<3>(p[0], p[1], p[2]) / (p[3] * static_cast<double>(part.points.size()));
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(least_weight > 0)) return {infinity, infinity, infinity, infinity, infinity};
  for (auto& p : part.points) {
    for (int x = 0; x < 3; ++x) p[x] -= p[3] * middle[x];
    size = std::max(size, std::hypot(p[0], p[1], p[2]) / p[3]);
  }
  const auto [pu, wu] = largest_differences(part, 1, 0);
  const auto [pv, wv] = largest_differences(part, 0, 1);
  const auto [puu, wuu] = largest_differences(part, 2, 0);
  const auto [puv, wuv] = largest_differences(part, 1, 1);
  const auto [pvv, wvv] = largest_differences(part, 0, 2);
  DerivativeBounds bounds;
  bounds.u = (pu + wu * size) / least_weight;
  bounds.v = (pv + wv * size) / least_weight;
  bounds.uu = (puu + 2 * wu * bounds.u + wuu * size) / least_weight;
  bounds.uv = (puv + wu * bounds.v + wv * bounds.u + wuv * size) / least_weight;
  bounds.vv = (pvv + 2 * wv * bounds.v + wvv * size) / least_weight;
  return bounds;
}

/// de Casteljau's algorithm along v, then along u, in place.
Vector<3> point_of(const Bezier& patch, const Pair& at) {
  const double t = (at[1] - patch.lower[1]) / (patch.upper[1] - patch.lower[1]);
  const double s = (at[0] - patch.lower[0]) / (patch.upper[0] - patch.lower[0]);
  using Line = std::array<std::array<double, 4>, TrueSurface::Bezier::most_degree + 1>;
  const auto combined = [](Line& line, int degree, double x) {
    for (int level = degree; level > 0; --level)
      for (int i = 0; i < level; ++i)
        for (int k = 0; k < 4; ++k) line[i][k] = (1 - x) * line[i][k] + x * line[i + 1][k];
    return line[0];
  };
  const int columns = patch.degree[1] + 1;
  Line along_u, along_v;
  for (int i = 0; i <= patch.degree[0]; ++i) {
    std::copy_n(patch.points.begin() + i * columns, columns, along_v.begin());
    along_u[i] = combined(along_v, patch.degree[1], t);
  }
  const auto p = combined(along_u, patch.degree[0], s);
  return Vector<3>(p[0], p[1], p[2]) / p[3];
}

/// Q of each edge.
std::array<double, 3> of_edges(const ParameterTriangle& t, const Bending& bending) {
  std::array<double, 3> q{};
  for (int k = 0; k < 3; ++k) {
    const double u = t[(k + 1) % 3][0] - t[k][0], v = t[(k + 1) % 3][1] - t[k][1];
    q[k] = (u == 0 ? 0 : bending.u * u * u) +
           (v == 0 ? 0 : bending.v * v * v);  // 0 times an infinite bound is 0
  }
  return q;
}

}  // namespace

ParameterBox box_of(const ParameterTriangle& t) {
  ParameterBox box{t[0], t[0]};
  for (const auto& p : t)
    for (int k = 0; k < 2; ++k) {
      box.lower[k] = std::min(box.lower[k], p[k]);
      box.upper[k] = std::max(box.upper[k], p[k]);
    }
  return box;
}

Vector<3> point_at(const TrueSurface::Patch& patch, const Pair& at) {
  if (const auto* swept = std::get_if<Swept>(&patch))
    return derivative_of(*swept, Basis(at[0]), Basis(at[1]), 0, 0);
  return point_of(std::get<Bezier>(patch), at);
}

DerivativeBounds derivative_bounds(const TrueSurface::Patch& patch, const ParameterBox& box) {
  if (const auto* bezier = std::get_if<Bezier>(&patch)) return bounds_within(*bezier, box);
  const SweptBounds swept(std::get<Swept>(patch), box);
  const auto largest = [&](int k, int l) { return swept.largest_derivative(k, l); };
  return {largest(1, 0), largest(0, 1), largest(2, 0), largest(1, 1), largest(0, 2)};
}

Bending bending_of(const ParameterTriangle& t, const DerivativeBounds& bounds) {
  const ParameterBox box = box_of(t);
  const double du = box.upper[0] - box.lower[0], dv = box.upper[1] - box.lower[1];
  if (!(du > 0 && dv > 0)) return {bounds.uu, bounds.vv};
  return {bounds.uu + bounds.uv * dv / du, bounds.vv + bounds.uv * du / dv};
}

double bend_of(const ParameterTriangle& t, const Bending& bending) {
  return bend_of_edges(of_edges(t, bending));
}

double bend_of_edges(const std::array<double, 3>& q) {
  const double x = q[0], y = q[1], z = q[2], largest = std::max({x, y, z});
  if (x + y > z && y + z > x && z + x > y) {
    // 4 x y - (x + y - z)², which does not cancel to less than its last digits where it is positive
    const double under = 4 * x * y - (x + y - z) * (x + y - z);
    if (under > 1e-9 * largest * largest) return std::min(0.5 * x * y * z / under, largest / 6);
    return largest / 6;  // l_i l_j sums to a third at most
  }
  return largest / 8;
}

double rounding_of(const TrueSurface::Patch& patch, const ParameterBox& box, const DerivativeBounds& bounds) {
  constexpr double of_terms = 0x1p-43, of_parameters = 0x1p-46;
  const auto largest = [&](int k) { return std::max(std::abs(box.lower[k]), std::abs(box.upper[k])); };
  double size = 0;
  if (const auto* bezier = std::get_if<Bezier>(&patch)) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const auto& p : bezier->points) {
      least = std::min(least, p[3]), most = std::max(most, p[3]);
      for (int x = 0; x < 3; ++x) size = std::max(size, std::abs(p[x]) / p[3]);
    }
    size *= most / least;
  } else {
    size = SweptBounds(std::get<Swept>(patch), box).largest_terms(0, 0);
  }
  return of_terms * size + of_parameters * (bounds.u * largest(0) + bounds.v * largest(1));
}

int edge_to_halve(const ParameterTriangle& t, const Bending& bending) {
  const std::array<double, 3> q = of_edges(t, bending);
  return static_cast<int>(std::ranges::max_element(q) - q.begin());
}

}  // namespace bernal
