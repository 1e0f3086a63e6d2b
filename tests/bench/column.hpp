#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal::bench {

constexpr double least_move = 1e-3;  // in radii
constexpr double left_out = 3;       // above the floor and below the top, in diameters

/// Spheres of diameter 1 in a column, by cells of edge 1.
class Column {
 public:
  Column(const Packing& packing, double across) : packing_(packing), radius_(across / 2) {
    for (std::uint32_t i = 0; i < packing.spheres.size(); ++i) cells_[cell(center(i))].push_back(i);
  }

  /// How far sphere i walks down, all others held, by steps of half a thousandth of its radius in directions
  /// drawn at random that descend by a hundredth or more, until a few hundred in a row lead into something.
  double walk(std::uint32_t i, Random& random) const {
    constexpr int most_failures = 300, most_steps = 3000;
    constexpr double step = 0.25 * least_move, least_descent = 0.01;
    const Vector<3> start = center(i);
    Vector<3> p = start;
    for (int failures = 0, steps = 0; failures < most_failures && steps < most_steps; ++steps) {
      Vector<3> u;
      do u = Vector<3>(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 0));
      while (u.squaredNorm() > 1 || u.squaredNorm() < 0.01);
      u.normalize();
      const Vector<3> to = p + step * u;
      if (u[2] > -least_descent || !is_free(to, i)) {
        ++failures;
        continue;
      }
      p = to;
      failures = 0;
    }
    return 2 * (p - start).norm();
  }

  /// Of a column that is as dense everywhere: twice as high as its spheres on average.
  double top() const {
    double sum = 0;
    for (const double z : packing_.spheres.x[2]) sum += z;
    return 2 * sum / static_cast<double>(packing_.spheres.size());
  }

  double porosity_of_core() const {
    const double low = left_out, high = top() - left_out;
    double filled = 0;
    for (const double z : packing_.spheres.x[2]) filled += share_below(high - z) - share_below(low - z);
    return 1 - filled / (1.5 * radius_ * radius_ * 4 * (high - low));
  }

  /// Porosity at a distance from the wall, in diameters, of the core.
  double porosity_at(double distance) const {
    constexpr int angles = 400;
    const double rho = radius_ - distance, low = left_out, high = top() - left_out;
    double area = 0;
    for (std::uint32_t i = 0; i < packing_.spheres.size(); ++i) {
      const Vector<3> p = center(i);
      if (p[2] < low || p[2] > high) continue;
      const double s = std::hypot(p[0], p[1]);
      if (std::abs(s - rho) > 0.5) continue;
      for (int a = 0; a < angles; ++a) {
        const double phi = std::numbers::pi * (a + 0.5) / angles;
        const double squared = 0.25 - (rho * rho + s * s - 2 * rho * s * std::cos(phi));
        if (squared > 0) area += 2 * std::sqrt(squared) * rho * 2 * std::numbers::pi / angles;
      }
    }
    return 1 - area / (2 * std::numbers::pi * rho * (high - low));
  }

 private:
  Vector<3> center(std::uint32_t i) const { return packing_.spheres.center(i); }
  static std::int64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return (z * 4096 + y) * 4096 + x;
  }
  static std::int64_t cell(const Vector<3>& p) {
    return key(std::llround(std::floor(p[0])) + 2048, std::llround(std::floor(p[1])) + 2048,
               std::llround(std::floor(p[2])));
  }
  static double share_below(double level) {
    const double t = std::clamp(level + 0.5, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }
  bool is_free(const Vector<3>& p, std::uint32_t i) const {
    if (p[2] < 0.5 || std::hypot(p[0], p[1]) > radius_ - 0.5) return false;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = cells_.find(cell(p + Vector<3>(x, y, z)));
          if (found == cells_.end()) continue;
          for (const std::uint32_t k : found->second)
            if (k != i && (center(k) - p).squaredNorm() < 1) return false;
        }
    return true;
  }

  const Packing& packing_;
  double radius_;
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace bernal::bench
