#include "verify/tally.hpp"

#include <algorithm>
#include <cmath>

namespace bernal::verify {

void Tally::add_pair(const Certificate::Overlap& pair, bool clear) {
  ++pairs;
  if (worse(pair, worst_pair)) worst_pair = pair;
  if (clear) return;
  ++overlapping;
  overlaps.add(pair);
}

void Tally::add_distant_pair(std::uint64_t first, std::uint64_t second, double gap_ratio) {
  const Certificate::Overlap pair{{std::min(first, second), std::max(first, second)},
                                  0.0 - with_sign(gap_ratio, true)};
  if (worse(pair, worst_pair)) worst_pair = pair;
}

void Tally::add_ball(const Certificate::Protrusion& ball, bool inside) {
  if (worse(ball, worst_wall)) worst_wall = ball;
  if (inside) return;
  ++protruding;
  protrusions.add(ball);
}

Tally& Tally::operator+=(const Tally& other) {
  pairs += other.pairs;
  walls += other.walls;
  centers += other.centers;
  decisions.by_double += other.decisions.by_double;
  decisions.by_exact += other.decisions.by_exact;
  overlapping += other.overlapping;
  protruding += other.protruding;
  if (worse(other.worst_pair, worst_pair)) worst_pair = other.worst_pair;
  if (worse(other.worst_wall, worst_wall)) worst_wall = other.worst_wall;
  overlaps.add(other.overlaps);
  protrusions.add(other.protrusions);
  least_distance = std::min(least_distance, other.least_distance);
  least_wall_distance = std::min(least_wall_distance, other.least_wall_distance);
  return *this;
}

double with_sign(double ratio, bool holds) {
  constexpr double largest = std::numeric_limits<double>::max();
  constexpr double smallest = std::numeric_limits<double>::min();
  if (std::isnan(ratio)) ratio = 0;  // after an overflow only the sign is known
  return holds ? std::clamp(ratio, 0.0, largest) : std::clamp(ratio, -largest, -smallest);
}

}  // namespace bernal::verify
