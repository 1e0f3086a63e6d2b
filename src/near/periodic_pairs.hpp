#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "core/archive.hpp"
#include "core/order.hpp"
#include "near/cell_grid.hpp"

namespace bernal {

/// Every pair of spheres in a periodic box whose surfaces are near each other, each once, and each image of a
/// pair for itself: two spheres of a small box may meet in several places, and a sphere may meet itself.
///
/// Pair p stands for the displacement x[first] - x[second] - image ∘ edges, where image is a vector of whole
/// numbers. As long as no centre is wrapped that stays true while the spheres move and the box grows.
template <int D>
class PeriodicPairs {
 public:
  struct Pair {
    using ArchivedAsBytes = void;
    std::uint32_t first, second;
    std::uint32_t image;  // in images()
  };

  /// Finds the pairs with d < (1 + wide) (ri + rj) + skin. Sphere i has its centre at centers[D i … D i + D -
  /// 1], anywhere, and radius[i] > 0. Pairs come in the order of their first spheres. Cost: O(N) for spheres
  /// that do not overlap much, however their radii differ.
  void find(const double* centers, const std::vector<double>& radius, const Vector<D>& edges, double wide,
            double skin);

  const std::vector<Pair>& pairs() const { return pairs_; }
  void erase(std::size_t pair) { pairs_.erase(pairs_.begin() + static_cast<std::ptrdiff_t>(pair)); }
  /// Forgets the pairs for which keep(pair) is false.
  template <class Keep>
  void keep_if(Keep&& keep) {
    std::erase_if(pairs_, [&](const Pair& pair) { return !keep(pair); });
  }
  /// In whole edges; images()[0] is zero.
  const std::vector<Vector<D>>& images() const { return images_; }
  void archive(Archive& a) { a(pairs_, images_); }

 private:
  using Center = Eigen::Map<const Vector<D>>;

  /// Adds the pairs of i and j over all images nearer than `limit`.
  void add(std::uint32_t i, std::uint32_t j, const Vector<D>& difference, const Vector<D>& edges,
           double limit);
  std::uint32_t number_of(const Vector<D>& image);
  void order_by_first(std::size_t spheres);

  std::vector<Pair> pairs_;
  std::vector<Vector<D>> images_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
};

template <int D>
void PeriodicPairs<D>::find(const double* centers, const std::vector<double>& radius, const Vector<D>& edges,
                            double wide, double skin) {
  pairs_.clear();
  images_.assign(1, Vector<D>::Zero());
  numbers_.clear();
  const auto [least, most] = std::ranges::minmax(radius);
  const Boundary<D> box{edges};
  CellGrid<D> grid(box, least, most, radius.size());
  // Each pair is met when its smaller sphere comes, which need not reach far for the larger.
  for (const std::uint32_t i : largest_first(radius)) {
    const Center c(centers + D * std::size_t{i});
    const Vector<D> wrapped = box.wrap(c);
    grid.insert(i, wrapped, radius[i]);
    const double reach = radius[i] + wide * (radius[i] + most) + skin;
    grid.for_each_near(wrapped, reach, [&](std::uint32_t j) {
      const Center other(centers + D * std::size_t{j});
      add(std::min(i, j), std::max(i, j), i < j ? Vector<D>(c - other) : Vector<D>(other - c), edges,
          (1 + wide) * (radius[i] + radius[j]) + skin);
    });
  }
  order_by_first(radius.size());
}

template <int D>
void PeriodicPairs<D>::add(std::uint32_t i, std::uint32_t j, const Vector<D>& difference,
                           const Vector<D>& edges, double limit) {
  // On each axis the images that alone would be near enough; mostly one.
  std::array<int, D> first, last;
  for (int k = 0; k < D; ++k) {
    first[k] = static_cast<int>(std::ceil((difference[k] - limit) / edges[k]));
    last[k] = static_cast<int>(std::floor((difference[k] + limit) / edges[k]));
    if (first[k] > last[k]) return;
  }
  std::array<int, D> at = first;
  for (;;) {
    Vector<D> image;
    for (int k = 0; k < D; ++k) image[k] = at[k];
    const bool near = (difference - image.cwiseProduct(edges)).squaredNorm() < limit * limit;
    // Of a sphere and its own images each pair of opposite ones counts once, and the sphere itself not.
    const bool once = i != j || std::ranges::lexicographical_compare(std::array<int, D>{}, at);
    if (near && once) pairs_.push_back({i, j, number_of(image)});
    int k = 0;
    while (k < D && ++at[k] > last[k]) {
      at[k] = first[k];
      ++k;
    }
    if (k == D) return;
  }
}

template <int D>
std::uint32_t PeriodicPairs<D>::number_of(const Vector<D>& image) {
  if (image.isZero(0)) return 0;
  std::uint64_t key = 0;  // a sphere does not reach over a hundred boxes
  for (int k = 0; k < D; ++k) key = key * 256 + static_cast<std::uint64_t>(image[k] + 128);
  const auto [entry, is_new] = numbers_.try_emplace(key, static_cast<std::uint32_t>(images_.size()));
  if (is_new) images_.push_back(image);
  return entry->second;
}

template <int D>
void PeriodicPairs<D>::order_by_first(std::size_t spheres) {
  std::vector<std::size_t> next(spheres + 1, 0);
  for (const Pair& pair : pairs_) ++next[pair.first + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<Pair> ordered(pairs_.size());
  for (const Pair& pair : pairs_) ordered[next[pair.first]++] = pair;
  pairs_ = std::move(ordered);
}

}  // namespace bernal
