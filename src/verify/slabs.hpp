#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "core/parallel.hpp"
#include "verify/ball.hpp"
#include "verify/space.hpp"

namespace bernal::verify {

/// An interval on an axis; initially empty.
struct Range {
  double lower = Box<1>::infinity, upper = -Box<1>::infinity;
  void include(double from, double to) {
    lower = std::min(lower, from);
    upper = std::max(upper, to);
  }
};

/// The balls of a packing in slabs along the longest axis, so that only some of them need be in memory
/// together: at most `at_once` a slab, unless more share one coordinate.
///
/// Only an index of 4 bytes is stored a sphere, and none if there is a single slab. The slab of a sphere
/// depends on its centre alone, not on the threads. Cost: O(N), three passes over one column.
template <int D>
class Slabs {
 public:
  /// `at_once` > 0; centres are finite.
  template <class Space>
  Slabs(const Spheres<dynamic>& spheres, const Space& space, std::size_t at_once) : spheres_(spheres) {
    const std::size_t n = spheres.size();
    if (n <= at_once) {
      start_ = {0, n};
      extents_.resize(1);
      return;
    }
    require(n <= std::numeric_limits<std::uint32_t>::max(), "there are more than 2^32 - 1 spheres");
    cut(space, at_once);
  }

  std::size_t size() const { return extents_.size(); }

  template <class Space>
  std::vector<Ball<D>> balls(std::size_t slab, const Space& space) const {
    std::vector<Ball<D>> balls(start_[slab + 1] - start_[slab]);
    parallel_ranges(balls.size(), grain, [&](std::size_t first, std::size_t last) {
      for (std::size_t b = first; b < last; ++b) {
        const std::size_t i = order_.empty() ? b : order_[start_[slab] + b];
        for (int k = 0; k < D; ++k)
          balls[b].c[k] = space.representative(k, spheres_.x[static_cast<std::size_t>(k)][i]);
        balls[b].r = spheres_.r[i];
        balls[b].index = i;
      }
    });
    return balls;
  }

  /// Bounds of the balls of a slab; finite only along the axis of the slabs.
  Box<D> extent(std::size_t slab) const { return extents_[slab]; }

 private:
  static constexpr std::size_t grain = 4096, bins_a_slab = 64;

  /// Calls body(chunk, i) for all spheres, chunks in parallel.
  template <class Body>
  void for_each_in_chunks(std::size_t chunks, const Body& body) const {
    const std::size_t n = spheres_.size();
    parallel_ranges(chunks, 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t c = first; c < last; ++c)
        for (std::size_t i = n * c / chunks; i < n * (c + 1) / chunks; ++i) body(c, i);
    });
  }

  template <class Space>
  void cut(const Space& space, std::size_t at_once) {
    constexpr std::size_t chunks = 256;
    const std::size_t n = spheres_.size();
    const auto at = [&](int k, std::size_t i) {
      return space.representative(k, spheres_.x[static_cast<std::size_t>(k)][i]);
    };
    std::vector<std::array<Range, D>> reached(chunks);
    for_each_in_chunks(chunks, [&](std::size_t c, std::size_t i) {
      for (int k = 0; k < D; ++k) reached[c][k].include(at(k, i), at(k, i));
    });
    std::array<Range, D> centers;
    for (const auto& chunk : reached)
      for (int k = 0; k < D; ++k) centers[k].include(chunk[k].lower, chunk[k].upper);
    int axis = 0;
    for (int k = 1; k < D; ++k)
      if (centers[k].upper - centers[k].lower > centers[axis].upper - centers[axis].lower) axis = k;

    // Bins of equal width, and slabs of consecutive bins.
    const std::size_t bins = bins_a_slab * ((n + at_once - 1) / at_once);
    const double lower = centers[axis].lower, extent = centers[axis].upper - lower;
    const auto bin_of = [&](std::size_t i) {
      const double share = extent > 0 ? (at(axis, i) - lower) / extent : 0;
      return std::min(bins - 1, static_cast<std::size_t>(share * static_cast<double>(bins)));
    };
    std::vector<std::vector<std::uint32_t>> counts(chunks, std::vector<std::uint32_t>(bins, 0));
    for_each_in_chunks(chunks, [&](std::size_t c, std::size_t i) { ++counts[c][bin_of(i)]; });
    std::vector<std::uint32_t> slab_of_bin(bins);
    start_ = {0};
    std::size_t in_slab = 0, before = 0;
    for (std::size_t b = 0; b < bins; ++b) {
      std::size_t in_bin = 0;
      for (const auto& chunk : counts) in_bin += chunk[b];
      if (in_slab > 0 && in_slab + in_bin > at_once) {
        start_.push_back(before);
        in_slab = 0;
      }
      slab_of_bin[b] = static_cast<std::uint32_t>(start_.size() - 1);
      in_slab += in_bin;
      before += in_bin;
    }
    start_.push_back(n);

    const std::size_t slabs = start_.size() - 1;
    std::vector<std::vector<std::size_t>> next(chunks, std::vector<std::size_t>(slabs));
    std::vector<std::size_t> filled(start_.begin(), start_.end() - 1);
    for (std::size_t c = 0; c < chunks; ++c) {
      next[c] = filled;
      for (std::size_t b = 0; b < bins; ++b) filled[slab_of_bin[b]] += counts[c][b];
    }
    order_.resize(n);
    std::vector<std::vector<Range>> along(chunks, std::vector<Range>(slabs));
    for_each_in_chunks(chunks, [&](std::size_t c, std::size_t i) {
      const std::uint32_t slab = slab_of_bin[bin_of(i)];
      order_[next[c][slab]++] = static_cast<std::uint32_t>(i);
      const double x = at(axis, i), r = spheres_.r[i];
      along[c][slab].include(rounded_down(x - r), rounded_up(x + r));
    });
    Box<D> everywhere;
    std::swap(everywhere.lower, everywhere.upper);
    extents_.assign(slabs, everywhere);
    for (std::size_t s = 0; s < slabs; ++s) {
      Range range;
      for (const auto& chunk : along) range.include(chunk[s].lower, chunk[s].upper);
      extents_[s].lower[axis] = range.lower;
      extents_[s].upper[axis] = range.upper;
    }
  }

  const Spheres<dynamic>& spheres_;
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> order_;  // empty: in the given order
  std::vector<Box<D>> extents_;
};

}  // namespace bernal::verify
