#include "verify/tally.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace bernal::verify {

void Tally::add_pair_ratio(std::uint64_t first, std::uint64_t second, double overlap) {
  if (std::tuple(-overlap, first, second) < std::tuple(-max_overlap, worst_pair[0], worst_pair[1])) {
    worst_pair[0] = first;
    worst_pair[1] = second;
    max_overlap = overlap;
  }
}

void Tally::add_wall_ratio(std::uint64_t sphere, double gap) {
  if (std::tuple(gap, sphere) < std::tuple(min_wall_gap, worst_wall)) {
    worst_wall = sphere;
    min_wall_gap = gap;
  }
}

Tally& Tally::operator+=(const Tally& other) {
  pairs += other.pairs;
  walls += other.walls;
  centers += other.centers;
  decided_double += other.decided_double;
  decided_exact += other.decided_exact;
  overlapping += other.overlapping;
  protruding += other.protruding;
  add_pair_ratio(other.worst_pair[0], other.worst_pair[1], other.max_overlap);
  add_wall_ratio(other.worst_wall, other.min_wall_gap);
  return *this;
}

double with_sign(double ratio, bool holds) {
  constexpr double largest = std::numeric_limits<double>::max();
  constexpr double smallest = std::numeric_limits<double>::min();
  if (std::isnan(ratio)) ratio = 0;  // an overflow on the way leaves only the sign
  return holds ? std::clamp(ratio, 0.0, largest) : std::clamp(ratio, -largest, -smallest);
}

}  // namespace bernal::verify
