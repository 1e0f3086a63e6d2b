#include "plan/sizes_at_hand.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace bernal {
namespace {

constexpr double negligible_tail = 0.1;
/// Classes up to where a tenth of the number lies above, and from there on a decade.
constexpr int classes_below = 100, classes_a_decade = 60;
constexpr double top = 0.1;
/// Of what is there.
constexpr std::size_t most_classes = 500;

using Numbers = std::map<double, double>;  // of each radius

/// The middle of each of equal shares of the ascending radii.
void add_there(Numbers& numbers, std::vector<double> radii) {
  std::ranges::sort(radii);
  const std::size_t n = radii.size(), classes = std::min(n, most_classes);
  for (std::size_t k = 0; k < classes; ++k) {
    const std::size_t first = k * n / classes, last = (k + 1) * n / classes;
    double volume = 0;
    for (std::size_t i = first; i < last; ++i) volume += std::pow(radii[i], 3);
    const auto count = static_cast<double>(last - first);
    numbers[std::cbrt(volume / count)] += count;
  }
}

/// So many draws, of which the largest is the quantile in the middle of the last.
void add_drawn(Numbers& numbers, const SizeDistribution& radii, double drawn) {
  for (int k = 0; k < classes_below; ++k)
    numbers[radii.quantile((1 - top) * (k + 0.5) / classes_below)] += drawn * (1 - top) / classes_below;
  const double decades = std::max(0.0, std::log10(top * drawn));
  const int classes = std::max(1, static_cast<int>(classes_a_decade * decades));
  double above = top;
  for (int k = 1; k <= classes; ++k) {
    const double next = k == classes ? 0 : top * std::pow(10, -decades * k / classes);
    numbers[radii.quantile(1 - 0.5 * (above + next))] += drawn * (above - next);
    above = next;
  }
}

}  // namespace

std::unique_ptr<SizeDistribution> sizes_at_hand(const std::vector<double>& there,
                                                const SizeDistribution& radii, double drawn) {
  if (there.empty()) {
    const double largest = radii.quantile(1 - 1 / std::max(2.0, drawn));
    if (radii.moment_above(3, largest) <= negligible_tail * radii.moment(3)) return nullptr;
  }
  Numbers numbers;
  add_there(numbers, there);
  if (drawn >= 1) add_drawn(numbers, radii, drawn);
  std::vector<double> values, shares;
  for (const auto& [radius, number] : numbers) {
    values.push_back(radius);
    shares.push_back(number);
  }
  return make_classes(std::move(values), std::move(shares), Basis::number);
}

}  // namespace bernal
