#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace bernal {

/// The indices of the values, the largest value first, equal ones in their order. Values are no NaN. Cost:
/// O(N log N). Compiled once, for all the templates that place spheres by size.
std::vector<std::uint32_t> largest_first(std::span<const double> values);
/// The smallest value first.
std::vector<std::uint32_t> smallest_first(std::span<const double> values);
/// Sorts some of the indices like that.
void sort_largest_first(std::vector<std::uint32_t>& indices, std::span<const double> values);

}  // namespace bernal
