#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"
#include "core/parallel.hpp"
#include "neighbors/counting_sort.hpp"

namespace bernal {

/// The spheres of a periodic box in blocks of space that fit the cache, each with what reaches into it from
/// around: for searches that see every sphere once, in any number of threads.
///
/// Every axis is cut into one part, or three or more of at least `reach` each. Cost: O(N). Memory: a number
/// and a copy of its place a sphere. Precondition: centres are in [0, edge).
template <int D>
class Blocks {
 public:
  /// The spheres in and around a block, and where their images there are.
  struct Local {
    std::vector<std::uint32_t> ids;
    std::vector<Vector<D>> places;
  };

  Blocks(const Spheres<D>& spheres, const Vector<D>& edges, double reach, std::size_t in_block)
      : edges_(edges), reach_(reach) {
    const double blocks = static_cast<double>(spheres.size()) / static_cast<double>(in_block);
    const double side = std::max(reach, std::pow(edges.prod() / std::max(1.0, blocks), 1.0 / D));
    std::size_t count = 1;
    for (int k = 0; k < D; ++k) {
      parts_[k] = static_cast<std::size_t>(std::clamp(std::floor(edges[k] / side), 1.0, 4096.0));
      if (parts_[k] < 3) parts_[k] = 1;
      count *= parts_[k];
    }
    if (count == 1) return;
    sort_into_buckets(
        spheres.size(), count, [&](std::size_t i) { return block_of(spheres, i); }, order_, start_);
    places_.resize(spheres.size());
    parallel_ranges(spheres.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) places_[n] = spheres.center(order_[n]);
    });
  }

  /// How many: of one nothing else may be asked.
  std::size_t size() const { return start_.empty() ? 1 : start_.size() - 1; }
  bool is_cut(int axis) const { return parts_[axis] > 1; }
  std::span<const std::uint32_t> own(std::size_t block) const { return part(order_, block); }
  /// Along axes that are not cut, and `reach` beyond its ends along the others.
  Bounds<D> around(std::size_t block) const {
    Bounds<D> bounds{Vector<D>::Zero(), edges_};
    const auto at = place_of(block);
    for (int k = 0; k < D; ++k) {
      if (!is_cut(k)) continue;
      const double width = edges_[k] / static_cast<double>(parts_[k]);
      bounds.lower[k] = static_cast<double>(at[k]) * width - reach_;
      bounds.upper[k] = static_cast<double>(at[k] + 1) * width + reach_;
    }
    return bounds;
  }
  /// Its own first.
  Local local(std::size_t block) const {
    const std::span<const std::uint32_t> ids = own(block);
    const std::span<const Vector<D>> places = part(places_, block);
    Local local{{ids.begin(), ids.end()}, {places.begin(), places.end()}};
    const Bounds<D> bounds = around(block);
    const auto at = place_of(block);
    std::array<int, D> step;
    for (int k = 0; k < D; ++k) step[k] = is_cut(k) ? -1 : 0;
    const std::array<int, D> first = step;
    for (;;) {
      if (std::ranges::any_of(step, [](int s) { return s != 0; })) add_from(at, step, bounds, local);
      int k = 0;
      while (k < D && ++step[k] > (is_cut(k) ? 1 : 0)) {
        step[k] = first[k];
        ++k;
      }
      if (k == D) return local;
    }
  }

 private:
  using Place = std::array<std::size_t, D>;

  template <class T>
  std::span<const T> part(const std::vector<T>& items, std::size_t block) const {
    return std::span(items).subspan(start_[block], start_[block + 1] - start_[block]);
  }
  Place place_of(std::size_t block) const {
    Place at;
    for (int k = 0; k < D; ++k) {
      at[k] = block % parts_[k];
      block /= parts_[k];
    }
    return at;
  }
  std::size_t number_of(const Place& at) const {
    std::size_t block = 0;
    for (int k = D - 1; k >= 0; --k) block = block * parts_[k] + at[k];
    return block;
  }
  std::size_t block_of(const Spheres<D>& spheres, std::size_t i) const {
    Place at;
    for (int k = 0; k < D; ++k) {
      const double part = spheres.x[k][i] / edges_[k] * static_cast<double>(parts_[k]);
      at[k] = std::min(parts_[k] - 1, static_cast<std::size_t>(std::max(0.0, part)));
    }
    return number_of(at);
  }

  void add_from(const Place& at, const std::array<int, D>& step, const Bounds<D>& bounds,
                Local& local) const {
    Place there;
    Vector<D> shift = Vector<D>::Zero();
    for (int k = 0; k < D; ++k) {
      there[k] = (at[k] + parts_[k] + static_cast<std::size_t>(step[k] + 1) - 1) % parts_[k];
      if (step[k] < 0 && at[k] == 0) shift[k] = -edges_[k];
      if (step[k] > 0 && at[k] + 1 == parts_[k]) shift[k] = edges_[k];
    }
    const std::span<const std::uint32_t> ids = own(number_of(there));
    const std::span<const Vector<D>> places = part(places_, number_of(there));
    for (std::size_t n = 0; n < ids.size(); ++n) {
      const Vector<D> image = places[n] + shift;
      if ((image.array() < bounds.lower.array()).any() || (image.array() > bounds.upper.array()).any())
        continue;
      local.ids.push_back(ids[n]);
      local.places.push_back(image);
    }
  }

  const Vector<D> edges_;
  const double reach_;
  std::array<std::size_t, D> parts_;
  std::vector<std::uint32_t> start_, order_;
  std::vector<Vector<D>> places_;  // in that order
};

}  // namespace bernal
