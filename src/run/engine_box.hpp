#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "bernal/core/vector.hpp"

namespace bernal {

/// How a periodic box stands while an engine pushes spheres apart in it: its edges, over those that are given
/// as proportions.
struct EngineBox {
  double first, last;
};

/// Packing fractions between which a periodic box grows, in shares of what the sizes are likely to reach:
/// equal spheres from 0.70 to 0.64, just below which they jam; or up to `most`, if that is less. No sphere
/// reaches around the box.
inline EngineBox engine_box(const Vector<3>& proportions, double volume_of_spheres, double largest_radius,
                            double attainable, std::optional<double> most = {}) {
  constexpr double ends_at = 0.9955, begins_at = 1.088;
  /// Below this share of what they reach spheres come free without a box that grows.
  constexpr double comes_free = 0.9;
  /// Of edges, over the largest diameter.
  constexpr double least_edge = 1.05;
  double last = ends_at * attainable;
  if (most) last = std::min(last, *most);
  const double first = last < comes_free * attainable ? last : last * begins_at / ends_at;
  const double needed = least_edge * 2 * largest_radius / proportions.minCoeff();
  const auto scale_to = [&](double fraction) {
    return std::max(needed, std::cbrt(volume_of_spheres / fraction / proportions.prod()));
  };
  return {scale_to(first), scale_to(last)};
}

/// The unit of lengths in which an engine works: a power of two, such that the mean radius is between 1 and 2
/// of it.
inline double unit_of_engine(double mean_radius) { return std::exp2(std::floor(std::log2(mean_radius))); }

}  // namespace bernal
