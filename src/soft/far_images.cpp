#include "soft/far_images.hpp"

#include <algorithm>
#include <cmath>

#include "neighbors/counting_sort.hpp"

namespace bernal {
namespace {

/// Cells as wide as two spheres reach, along the axes that have room for a few: so a box that is narrow along
/// one axis and holds very many spheres is searched no longer than another.
class WideCells {
 public:
  WideCells(const std::vector<SoftSphere>& spheres, const std::array<double, 3>& edges, double reach) {
    constexpr double fewest = 4;  // with fewer all are side by side
    for (std::size_t k = 0; k < 3; ++k)
      if (edges[k] >= fewest * reach) across_[k] = static_cast<std::size_t>(std::min(edges[k] / reach, 1e6));
    while (count() > std::max<std::size_t>(spheres.size(), 64)) *std::ranges::max_element(across_) /= 2;
    const auto cell_of = [&](std::size_t p) {
      if (!(spheres[p].r > 0)) return count();
      const std::array<std::size_t, 3> at = cell(spheres[p]);
      return at[0] + across_[0] * (at[1] + across_[1] * at[2]);
    };
    sort_into_buckets(spheres.size(), count(), cell_of, order_, start_);
  }

  /// All in the cells around a sphere and in its own, ascending.
  const std::vector<std::uint32_t>& around(const SoftSphere& sphere) {
    const std::array<std::size_t, 3> at = cell(sphere);
    found_.clear();
    std::array<std::size_t, 3> steps;
    for (std::size_t k = 0; k < 3; ++k) steps[k] = std::min<std::size_t>(across_[k], 3);
    for (std::size_t z = 0; z < steps[2]; ++z)
      for (std::size_t y = 0; y < steps[1]; ++y)
        for (std::size_t x = 0; x < steps[0]; ++x) {
          const auto beside = [&](std::size_t k, std::size_t step) {
            return (at[k] + across_[k] - 1 + step) % across_[k];
          };
          const std::size_t c = beside(0, x) + across_[0] * (beside(1, y) + across_[1] * beside(2, z));
          found_.insert(found_.end(), order_.begin() + start_[c], order_.begin() + start_[c + 1]);
        }
    std::ranges::sort(found_);
    return found_;
  }

 private:
  std::size_t count() const { return across_[0] * across_[1] * across_[2]; }
  std::array<std::size_t, 3> cell(const SoftSphere& sphere) const {
    std::array<std::size_t, 3> at;
    for (std::size_t k = 0; k < 3; ++k)
      at[k] = std::uint64_t{static_cast<std::uint32_t>(sphere.x[k])} * across_[k] >> 32;
    return at;
  }

  std::array<std::size_t, 3> across_{1, 1, 1};
  std::vector<std::uint32_t> order_, start_, found_;
};

/// Calls visit(displacement, distance) for the images of `other` but the nearest whose centres are less than
/// `reach` from `me`, as displacements from them.
template <class Visit>
void for_each_far_image(const SoftSphere& me, const SoftSphere& other, const std::array<double, 3>& edges,
                        int dimension, double reach, Visit&& visit) {
  std::array<double, 3> nearest{};
  for (std::size_t k = 0; k < 3; ++k) nearest[k] = steps_between(other, me, k) * (edges[k] * 0x1p-32);
  for (unsigned sides = 1; sides < 1u << dimension; ++sides) {
    std::array<double, 3> d = nearest;
    for (std::size_t k = 0; k < 3; ++k)
      if (sides >> k & 1) d[k] -= std::copysign(edges[k], d[k]);
    const double distance = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (distance < reach) visit(d, distance);
  }
}

}  // namespace

void FarImages::build(const std::vector<SoftSphere>& spheres, const std::array<double, 3>& edges,
                      int dimension, double skin) {
  spheres_.clear();
  dimension_ = dimension;
  const double half = 0.5 * *std::min_element(edges.begin(), edges.begin() + dimension);
  float largest = 0;
  for (const SoftSphere& sphere : spheres) largest = sphere.r > largest ? sphere.r : largest;
  if (2 * (largest + skin) < half) return;
  std::vector<std::vector<std::uint32_t>> others(spheres.size());
  const auto is_near = [&](std::uint32_t a, std::uint32_t b) {
    const double reach = double{spheres[a].r} + spheres[b].r + 2 * skin;
    bool near = false;
    if (reach > half)
      for_each_far_image(spheres[a], spheres[b], edges, dimension, reach,
                         [&](const auto&, double) { near = true; });
    return near;
  };
  WideCells cells(spheres, edges, 2 * (largest + skin));
  for (std::uint32_t a = 0; a < spheres.size(); ++a) {
    if (!(2 * (spheres[a].r + skin) > half)) continue;
    throw_if_interrupted();
    for (const std::uint32_t b : cells.around(spheres[a])) {
      const bool both_large = 2 * (spheres[b].r + skin) > half;
      if (a == b || (both_large && b < a) || !is_near(a, b)) continue;
      others[a].push_back(b);
      others[b].push_back(a);
    }
  }
  for (std::uint32_t a = 0; a < spheres.size(); ++a)
    if (!others[a].empty()) spheres_.push_back({a, std::move(others[a])});
}

float FarImages::push(std::vector<SoftSphere>& spheres, const std::array<double, 3>& edges, float omega,
                      float* squeeze, float* force) const {
  double worst = 0;
  for (const Large& large : spheres_) {
    SoftSphere& me = spheres[large.place];
    std::array<double, 3> sum{};
    double contacts = 0, squares = 0, depth = 0;
    for (const std::uint32_t p : large.others) {
      const SoftSphere& other = spheres[p];
      const double reach = double{me.r} + other.r, weight = 2 * other.r / reach;
      for_each_far_image(me, other, edges, dimension_, reach, [&](const auto& d, double distance) {
        const double ratio = 1 - distance / reach;
        worst = std::max(worst, ratio);
        squares += ratio * ratio;
        contacts += weight;
        depth += weight * ratio * reach;
        for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * (reach / distance - 1) * d[k];
      });
    }
    if (squeeze) {
      squeeze[large.place] += static_cast<float>(squares);
      force[large.place] += static_cast<float>(me.r * depth);
    }
    if (!(contacts > 0)) continue;
    const double step = std::min(omega / contacts, 1.0);
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k) {
      const auto steps = static_cast<std::int64_t>(std::llround(step * sum[k] / edges[k] * 0x1p32));
      me.x[k] =
          static_cast<std::int32_t>(static_cast<std::uint32_t>(me.x[k]) + static_cast<std::uint32_t>(steps));
    }
  }
  return static_cast<float>(worst);
}

}  // namespace bernal
