#include "voxels/ball_in_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bernal {
namespace {

constexpr double whole_ball = 4.0 / 3.0 * std::numbers::pi;

/// The part with x > a.
double cap(double a) { return std::numbers::pi / 3 * (1 - a) * (1 - a) * (2 + a); }

/// The part with x > a and y > b, given the caps of both.
double wedge(double a, double b, double cap_a, double cap_b) {
  const double squared = 1 - a * a - b * b;
  if (squared <= 0) return (a < 0 ? cap_b : 0) + (b < 0 ? cap_a : 0) - (a < 0 && b < 0 ? whole_ball : 0);
  const double s = std::sqrt(squared), ab = a * b;
  const auto g = [](double t) { return 0.5 * t * (3 - t * t); };
  return 2.0 / 3.0 * (std::atan2(s, ab) + ab * s - g(a) * std::atan2(s, b) - g(b) * std::atan2(s, a));
}

/// Area of the unit disc with x > a.
double segment(double a) { return std::acos(a) - a * std::sqrt((1 - a) * (1 + a)); }

/// Area of the unit disc with x > a and y > b.
double quarter(double a, double b) {
  constexpr double pi = std::numbers::pi;
  if (a * a + b * b < 1) return 0.5 * (segment(a) + segment(b)) - 0.25 * pi + a * b;
  return (a < 0 ? segment(b) : 0) + (b < 0 ? segment(a) : 0) - (a < 0 && b < 0 ? pi : 0);
}

double larger_square(double a, double b) { return std::max(a * a, b * b); }

}  // namespace

void BallInCells::make_tables() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (double& a : planes[axis]) a = std::clamp(a, -1.0, 1.0);
    caps_[axis].clear();
    for (const double a : planes[axis]) caps_[axis].push_back(cap(a));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    wedges_[axis].clear();
    for (std::size_t j = 0; j < planes[v].size(); ++j)
      for (std::size_t i = 0; i < planes[u].size(); ++i)
        wedges_[axis].push_back(wedge(planes[u][i], planes[v][j], caps_[u][i], caps_[v][j]));
  }
}

void BallInCells::make_layer(std::size_t k, std::vector<double>& layer) const {
  const auto& [xs, ys, zs] = planes;
  const std::size_t nx = xs.size(), ny = ys.size();
  const double c = zs[k], cap_c = caps_[2][k];
  const double* wedges_ca = &wedges_[1][k * nx];
  layer.resize(nx * ny);
  for (std::size_t j = 0; j < ny; ++j) {
    const double b = ys[j], cap_b = caps_[1][j], wedge_bc = wedges_[0][k * ny + j];
    const double *wedges_ab = &wedges_[2][j * nx], *caps_a = caps_[0].data();
    const double squared = b * b + c * c, bc = b * c;
    const double rest = whole_ball / 8 - 0.25 * (cap_b + cap_c) + 0.5 * wedge_bc;
    const int negative = (b < 0) + (c < 0);
    double* row = &layer[j * nx];
    for (std::size_t i = 0; i < nx; ++i) {
      const double a = xs[i];
      if (a * a + squared < 1) {
        row[i] = rest - 0.25 * caps_a[i] + 0.5 * (wedges_ab[i] + wedges_ca[i]) - a * bc;
      } else if (a < 0) {
        row[i] = negative == 2
                     ? whole_ball - caps_a[i] - cap_b - cap_c + wedges_ab[i] + wedges_ca[i] + wedge_bc
                 : negative == 0 ? wedge_bc
                 : b < 0         ? wedge_bc + wedges_ca[i] - cap_c
                                 : wedge_bc + wedges_ab[i] - cap_b;
      } else {
        row[i] = negative == 2   ? wedges_ab[i] + wedges_ca[i] - caps_a[i]
                 : negative == 0 ? 0
                 : b < 0         ? wedges_ca[i]
                                 : wedges_ab[i];
      }
    }
  }
}

void BallInCells::add(double scale, double whole, double* to, std::ptrdiff_t stride_y,
                      std::ptrdiff_t stride_z) {
  const double low = std::min(0.0, whole), high = std::max(0.0, whole);
  make_tables();
  const auto& [xs, ys, zs] = planes;
  const std::size_t nx = xs.size();
  make_layer(0, below_);
  for (std::size_t k = 0; k + 1 < zs.size(); ++k, to += stride_z, std::swap(below_, above_)) {
    make_layer(k + 1, above_);
    for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
      const double farthest = larger_square(ys[j], ys[j + 1]) + larger_square(zs[k], zs[k + 1]);
      const double *b0 = &below_[j * nx], *b1 = b0 + nx, *a0 = &above_[j * nx], *a1 = a0 + nx;
      double* row = to + static_cast<std::ptrdiff_t>(j) * stride_y;
      for (std::size_t i = 0; i + 1 < nx; ++i) {
        if (larger_square(xs[i], xs[i + 1]) + farthest <= 1) {
          row[i] += whole;
          continue;
        }
        const double volume =
            ((b0[i] - b0[i + 1]) - (b1[i] - b1[i + 1])) - ((a0[i] - a0[i + 1]) - (a1[i] - a1[i + 1]));
        row[i] += std::clamp(scale * volume, low, high);
      }
    }
  }
}

void BallInCells::add_disc(double scale, double whole, double* to, std::ptrdiff_t stride_y) {
  const double low = std::min(0.0, whole), high = std::max(0.0, whole);
  auto& [xs, ys, zs] = planes;
  for (auto* axis : {&xs, &ys})
    for (double& a : *axis) a = std::clamp(a, -1.0, 1.0);
  for (std::size_t j = 0; j + 1 < ys.size(); ++j, to += stride_y) {
    for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
      const double a = xs[i], b = ys[j], right = xs[i + 1], top = ys[j + 1];
      if (larger_square(a, right) + larger_square(b, top) <= 1) {
        to[i] += whole;
        continue;
      }
      const double area = (quarter(a, b) - quarter(right, b)) - (quarter(a, top) - quarter(right, top));
      to[i] += std::clamp(scale * area, low, high);
    }
  }
}

}  // namespace bernal
