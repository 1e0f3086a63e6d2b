#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/large_pages.hpp"
#include "core/parallel.hpp"

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

/// The items 0 to n - 1 by the bucket_of(i) that each is in, equals in their order, but for those in bucket
/// number `buckets`, which are left out: `order` are the items, and `start` is as above. In threads; it calls
/// bucket_of twice for each. Cost: O(n + buckets).
template <class BucketOf>
void sort_into_buckets(std::size_t n, std::size_t buckets, const BucketOf& bucket_of,
                       std::vector<std::uint32_t>& order, std::vector<std::uint32_t>& start) {
  constexpr std::size_t most_chunks = 64, items_a_chunk = 65536;
  const std::size_t chunks = std::min(most_chunks, 1 + n / items_a_chunk);
  std::vector<std::vector<std::uint32_t>> next(chunks, std::vector<std::uint32_t>(buckets, 0));
  const auto for_each = [&](const auto& visit) {
    parallel_for(chunks, [&](std::size_t c) {
      for (std::size_t i = n * c / chunks; i < n * (c + 1) / chunks; ++i)
        if (const std::size_t b = bucket_of(i); b < buckets) visit(next[c][b], i);
    });
  };
  for_each([](std::uint32_t& count, std::size_t) { ++count; });
  start.assign(buckets + 1, 0);
  std::uint32_t before = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    start[b] = before;
    for (auto& chunk : next) before += std::exchange(chunk[b], before);
  }
  start[buckets] = before;
  resize_anew(order, before);
  for_each([&](std::uint32_t& place, std::size_t i) { order[place++] = static_cast<std::uint32_t>(i); });
}

}  // namespace bernal
