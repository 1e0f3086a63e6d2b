#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"
#include "neighbors/counting_sort.hpp"

namespace bernal {

/// The spheres of a periodic box in blocks of space that fit the cache, each with what reaches into it from
/// around: for searches that see every sphere once, in any number of threads.
///
/// Every axis is cut into one part, or three or more of at least `reach` each. Cost: O(N). Memory: 4 bytes a
/// sphere. Precondition: centres are in [0, edge).
template <int D>
class Blocks {
 public:
  /// One of the spheres in and around a block, and where its image there is.
  struct Local {
    std::vector<std::uint32_t> ids;
    std::vector<Vector<D>> places;
  };

  Blocks(const Spheres<D>& spheres, const Vector<D>& edges, double reach, std::size_t in_block)
      : spheres_(spheres), edges_(edges), reach_(reach) {
    const double blocks = static_cast<double>(spheres.size()) / static_cast<double>(in_block);
    const double side = std::max(reach, std::pow(edges.prod() / std::max(1.0, blocks), 1.0 / D));
    std::size_t count = 1;
    for (int k = 0; k < D; ++k) {
      parts_[k] = static_cast<std::size_t>(std::clamp(std::floor(edges[k] / side), 1.0, 4096.0));
      if (parts_[k] < 3) parts_[k] = 1;
      count *= parts_[k];
    }
    sort_into_buckets(
        spheres.size(), count, [this](std::size_t i) { return block_of(i); }, order_, start_);
  }

  std::size_t size() const { return start_.size() - 1; }
  bool is_cut(int axis) const { return parts_[axis] > 1; }
  std::span<const std::uint32_t> own(std::size_t block) const {
    return std::span(order_).subspan(start_[block], start_[block + 1] - start_[block]);
  }
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
    Local local;
    for (const std::uint32_t i : own(block)) {
      local.ids.push_back(i);
      local.places.push_back(spheres_.center(i));
    }
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
  std::size_t block_of(std::size_t i) const {
    Place at;
    for (int k = 0; k < D; ++k) {
      const double part = spheres_.x[k][i] / edges_[k] * static_cast<double>(parts_[k]);
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
    for (const std::uint32_t i : own(number_of(there))) {
      const Vector<D> image = spheres_.center(i) + shift;
      if ((image.array() < bounds.lower.array()).any() || (image.array() > bounds.upper.array()).any())
        continue;
      local.ids.push_back(i);
      local.places.push_back(image);
    }
  }

  const Spheres<D>& spheres_;
  const Vector<D> edges_;
  const double reach_;
  std::array<std::size_t, D> parts_;
  std::vector<std::uint32_t> start_, order_;
};

}  // namespace bernal
