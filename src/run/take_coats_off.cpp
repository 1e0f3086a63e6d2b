#include "run/take_coats_off.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

double take_coats_off(std::vector<double>& radii, const Supply& supply, double coat, double scale) {
  std::vector<std::pair<double, double>> sizes;  // with the coat, and as drawn
  for (std::size_t tag = 0; tag < supply.wanted(); ++tag)
    sizes.emplace_back(supply.radii()[tag], supply.drawn(tag));
  std::ranges::stable_sort(sizes, {}, &std::pair<double, double>::first);
  double smallest = sizes.front().second, largest = smallest;
  for (const auto& [with_coat, drawn] : sizes) {
    smallest = std::min(smallest, drawn);
    largest = std::max(largest, drawn);
  }
  const double drawn_scale = scale_of_drawn(scale, coat, smallest, largest);
  std::vector<std::uint32_t> given(sizes.size(), 0);  // of each first of equal ones
  for (double& r : radii) {
    const auto [first, last] = std::ranges::equal_range(sizes, r, {}, &std::pair<double, double>::first);
    const auto at = std::min(first - sizes.begin(), static_cast<std::ptrdiff_t>(sizes.size()) - 1);
    const auto skip =
        first == last ? 0 : std::min<std::ptrdiff_t>(given[static_cast<std::size_t>(at)]++, last - first - 1);
    const double drawn = drawn_scale * sizes[static_cast<std::size_t>(at + skip)].second;
    r = std::min(drawn, sum_rounded_down(r, -coat));
  }
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
