#include "soft/far_images.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "near/point_grid.hpp"

namespace bernal {
namespace {

Vector<3> center_of(const SoftSphere& sphere, const std::array<double, 3>& edges) {
  Vector<3> c;
  for (std::size_t k = 0; k < 3; ++k)
    c[static_cast<int>(k)] = static_cast<std::uint32_t>(sphere.x[k]) * (edges[k] * 0x1p-32);
  return c;
}

/// The centres of the spheres of a box, in which axes beyond the dimension are open.
PointGrid<3> grid_of(const std::vector<SoftSphere>& spheres, const std::array<double, 3>& edges,
                     int dimension, double reach) {
  Boundary<3> box;
  for (int k = 0; k < dimension; ++k) box.edges[k] = edges[static_cast<std::size_t>(k)];
  Spheres<3> centers;
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    centers.push_back(center_of(spheres[i], edges), spheres[i].r);
    if (spheres[i].r > 0) ids.push_back(i);
  }
  return PointGrid<3>(centers, ids, box, reach);
}

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
  const double farthest = 2 * (largest + skin);
  const PointGrid<3> grid = grid_of(spheres, edges, dimension, farthest);
  std::vector<std::uint32_t> near;
  for (std::uint32_t a = 0; a < spheres.size(); ++a) {
    if (!(2 * (spheres[a].r + skin) > half)) continue;
    throw_if_interrupted();
    near.clear();
    grid.for_each_near(center_of(spheres[a], edges), farthest,
                       [&](std::uint32_t b, const Vector<3>&) { near.push_back(b); });
    std::ranges::sort(near);
    near.erase(std::ranges::unique(near).begin(), near.end());
    for (const std::uint32_t b : near) {
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
