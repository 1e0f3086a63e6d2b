#pragma once
#include <cstdint>
#include <vector>

namespace bernal {

/// Sorts items by the bucket that each is in, equals in their order: turns `bucket` into the place of each
/// item in that order, and `start` into where every bucket begins there, one more than there are buckets.
/// Cost: O(items + buckets).
inline void counting_sort(std::vector<std::uint32_t>& bucket, std::size_t buckets,
                          std::vector<std::uint32_t>& start) {
  start.assign(buckets + 1, 0);
  for (const std::uint32_t b : bucket) ++start[b + std::size_t{1}];
  for (std::size_t b = 0; b < buckets; ++b) start[b + 1] += start[b];
  std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
  for (std::uint32_t& b : bucket) b = next[b]++;
}

}  // namespace bernal
