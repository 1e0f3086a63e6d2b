#include "run/take_coats_off.hpp"

#include <algorithm>
#include <cmath>

#include "bernal/core/tolerance.hpp"
#include "core/rounding.hpp"

namespace bernal {
namespace {

/// s (r + coat) >= t r + coat for all radii up to the largest, or from the smallest on: t = s + (s - 1) coat
/// / r is least for the largest r if s > 1, else for the smallest.
double scale_of_drawn(double scale, double coat, double smallest, double largest) {
  if (scale == 1) return 1;
  const double least = scale + (scale - 1) * coat / (scale > 1 ? largest : smallest);
  return least * (1 - 8 * tolerance::roundoff * (1 + coat / smallest));
}

}  // namespace

double take_coats_off(std::vector<double>& radii, const std::vector<std::uint32_t>& tags,
                      const Supply& supply, double coat) {
  double smallest = supply.drawn(0), largest = smallest;
  for (std::size_t tag = 0; tag < supply.wanted(); ++tag) {
    smallest = std::min(smallest, supply.drawn(tag));
    largest = std::max(largest, supply.drawn(tag));
  }
  const double drawn_scale = scale_of_drawn(supply.scale(), coat, smallest, largest);
  for (std::size_t i = 0; i < radii.size(); ++i)
    radii[i] = std::min(drawn_scale * supply.drawn(tags[i]), sum_rounded_down(radii[i], -coat));
  return drawn_scale;
}

double share_of_drawn(const Supply& supply, int dimension) {
  double drawn = 0, with_coats = 0;
  for (std::size_t tag = 0; tag < supply.wanted(); ++tag) {
    drawn += std::pow(supply.drawn(tag), dimension);
    with_coats += std::pow(supply.radii()[tag], dimension);
  }
  return with_coats > 0 ? drawn / with_coats : 1;
}

}  // namespace bernal
