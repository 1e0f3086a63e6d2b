#include "core/order.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace bernal {
namespace {

template <class Before>
void sort_by_value(std::vector<std::uint32_t>& indices, std::span<const double> values, Before before) {
  std::ranges::stable_sort(indices, before, [&](std::uint32_t i) { return values[i]; });
}

template <class Before>
std::vector<std::uint32_t> all_by_value(std::span<const double> values, Before before) {
  std::vector<std::uint32_t> indices(values.size());
  std::iota(indices.begin(), indices.end(), 0u);
  sort_by_value(indices, values, before);
  return indices;
}

}  // namespace

std::vector<std::uint32_t> largest_first(std::span<const double> values) {
  return all_by_value(values, std::greater<>());
}
std::vector<std::uint32_t> smallest_first(std::span<const double> values) {
  return all_by_value(values, std::less<>());
}
void sort_largest_first(std::vector<std::uint32_t>& indices, std::span<const double> values) {
  sort_by_value(indices, values, std::greater<>());
}

}  // namespace bernal
