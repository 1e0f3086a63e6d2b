#include "predict/rods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

namespace bernal::predict {

std::vector<double> rod_lengths(const SizeDistribution& sizes, int count) {
  // In y = L² the share of longer rods, m2 - y m0, is convex and falls with the slope -m0. So Newton's method
  // started below a root, here at the root of the next shorter rod, climbs to it and never passes it; where
  // m0 is a staircase (size classes) it arrives after a step a class.
  const double all = sizes.moment(2);
  std::vector<double> lengths(static_cast<std::size_t>(count));
  double y = 0;
  for (int i = 0; i < count; ++i) {
    const double longer = (count - i - 0.5) / count * all;
    for (;;) {
      const double length = std::sqrt(y);
      const double m0 = sizes.moment_above(0, length), m2 = sizes.moment_above(2, length);
      if (!(m0 > 0)) break;  // rounding carried y past the largest sphere, where the longest rods end
      const double better = (m2 - longer) / m0;
      const bool arrived = !(better > y * (1 + 8 * std::numeric_limits<double>::epsilon()));
      y = std::max(y, better);
      if (arrived) break;
    }
    lengths[static_cast<std::size_t>(i)] = std::sqrt(y);
  }
  return lengths;
}

double covered_fraction(std::span<const double> ascending_lengths) {
  constexpr double f = 0.7654;  // gives equal spheres their random close packing fraction
  std::priority_queue<double> gaps;
  double total_gap = f * ascending_lengths.back();
  gaps.push(total_gap);
  for (std::size_t i = ascending_lengths.size() - 1; i-- > 0;) {
    const double length = ascending_lengths[i];
    const double gap = gaps.top();
    const double left = f * length, right = std::max(f * length, gap - (1 + f) * length);
    gaps.pop();
    gaps.push(left);
    gaps.push(right);
    total_gap += left + right - gap;
  }
  const double total_length = std::accumulate(ascending_lengths.begin(), ascending_lengths.end(), 0.0);
  return total_length / (total_length + total_gap);
}

}  // namespace bernal::predict
