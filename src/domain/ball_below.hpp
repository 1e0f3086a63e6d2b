#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

namespace bernal {

/// What of the ball of radius r about zero has a coordinate of at most `height` along an axis; in two
/// dimensions of the disc. Error: a few roundoffs of the ball's volume.
inline double ball_below(int dimension, double r, double height) {
  const double h = std::clamp(height, -r, r);
  if (dimension == 3) return std::numbers::pi / 3 * (r + h) * (r + h) * (2 * r - h);
  return r * r * (std::numbers::pi - std::acos(h / r)) + h * std::sqrt((r - h) * (r + h));
}

}  // namespace bernal
