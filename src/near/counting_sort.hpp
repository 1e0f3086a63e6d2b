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

/// How many of each bucket are in each part of the items, while they are sorted.
using BucketCounts = std::vector<std::vector<std::uint32_t>>;

/// Calls put(place, i) for the items 0 to n - 1 with their places as above, but for those in bucket number
/// `buckets`, which are left out; `start` is as above. It calls bucket_of(i) twice for each. Cost:
/// O(n + buckets).
template <class BucketOf, class Put>
void put_into_buckets(std::size_t n, std::size_t buckets, const BucketOf& bucket_of, const Put& put,
                      std::vector<std::uint32_t>& start, BucketCounts& next, bool in_threads) {
  constexpr std::size_t most_parts = 64, items_a_part = 32768;
  const std::size_t parts = in_threads ? std::min(most_parts, 1 + n / items_a_part) : 1;
  next.resize(parts);
  const auto for_each = [&](std::size_t part, const auto& visit) {
    for (std::size_t i = n * part / parts; i < n * (part + 1) / parts; ++i)
      if (const std::size_t b = bucket_of(i); b < buckets) visit(next[part][b], i);
  };
  parallel_for_if(in_threads, parts, [&](std::size_t part) {
    next[part].assign(buckets, 0);
    for_each(part, [](std::uint32_t& items, std::size_t) { ++items; });
  });
  start.resize(buckets + 1);
  std::uint32_t before = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    start[b] = before;
    for (auto& part : next) before += std::exchange(part[b], before);
  }
  start[buckets] = before;
  parallel_for_if(in_threads, parts, [&](std::size_t part) {
    for_each(part, [&](std::uint32_t& place, std::size_t i) { put(place++, i); });
  });
}

/// What sorting needs besides. Kept by who sorts often: to get memory from the system can take longer than to
/// sort.
struct BucketRoom {
  std::vector<std::uint32_t> bucket;  // of each item
  BucketCounts counts;
};

/// The same, but calls bucket_of(i) once for each.
template <class BucketOf, class Put>
void put_into_buckets(std::size_t n, std::size_t buckets, const BucketOf& bucket_of, const Put& put,
                      std::vector<std::uint32_t>& start, BucketRoom& room, bool in_threads) {
  constexpr std::size_t items_a_piece = 16384;
  std::vector<std::uint32_t>& bucket = room.bucket;
  bucket.resize(n);
  parallel_ranges_if(in_threads, n, items_a_piece, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) bucket[i] = static_cast<std::uint32_t>(bucket_of(i));
  });
  const auto found = [&](std::size_t i) { return bucket[i]; };
  put_into_buckets(n, buckets, found, put, start, room.counts, in_threads);
}

/// The items 0 to n - 1 by the bucket_of(i) that each is in, equals in their order, but for those in bucket
/// number `buckets`, which are left out: `order` are the items, and `start` is as above. In threads; it calls
/// bucket_of twice for each. Cost: O(n + buckets).
template <class BucketOf>
void sort_into_buckets(std::size_t n, std::size_t buckets, const BucketOf& bucket_of,
                       std::vector<std::uint32_t>& order, std::vector<std::uint32_t>& start) {
  BucketCounts counts;
  resize_anew(order, n);
  const auto put = [&](std::uint32_t place, std::size_t i) { order[place] = static_cast<std::uint32_t>(i); };
  put_into_buckets(n, buckets, bucket_of, put, start, counts, true);
  order.resize(start[buckets]);
}

}  // namespace bernal
