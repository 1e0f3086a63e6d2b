#include "measure/depths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bernal/core/random.hpp"
#include "core/parallel.hpp"
#include "domain/places.hpp"
#include "measure/volume_in.hpp"

namespace bernal {
namespace {

constexpr double most_waste = 16;
constexpr double rounding_of_shares = 1e-12;
constexpr double least_step = 1e-9;  // relative to the depth of a shape

/// Volume of the points deeper than z, up to a constant factor.
double inner_volume(const Box& box, double z) {
  Vector<3> inner = bounds_of(box).size();
  for (int k = 0; k < 3; ++k)
    if (box.has_wall(k)) inner[k] -= 2 * z;
  return inner.minCoeff() > 0 ? inner.prod() : 0;
}
double inner_volume(const Cylinder& cylinder, double z) {
  const double radius = cylinder.radius - z, height = cylinder.height - (cylinder.periodic ? 0 : 2 * z);
  return radius > 0 && height > 0 ? radius * radius * height : 0;
}
double inner_volume(const Sphere& sphere, double z) { return std::pow(std::max(0.0, sphere.radius - z), 3); }
/// Containers of facets are sampled.
double inner_volume(const Mesh&, double) { return 0; }
double inner_volume(const Polygon&, double) { return 0; }
double inner_volume(const Revolved&, double) { return 0; }

double deepest_of(const Box& box) {
  const Vector<3> size = bounds_of(box).size();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
    if (box.has_wall(k)) least = std::min(least, size[k]);
  return 0.5 * least;
}
double deepest_of(const Cylinder& cylinder) {
  return cylinder.periodic ? cylinder.radius : std::min(cylinder.radius, 0.5 * cylinder.height);
}
double deepest_of(const Sphere& sphere) { return sphere.radius; }
double deepest_of(const Mesh&) { return 0; }
double deepest_of(const Polygon&) { return 0; }
double deepest_of(const Revolved&) { return 0; }

/// The number of cells along each axis of a grid of about `wanted` roughly cubic cells over the bounds; a
/// single layer or row where the bounds are thinner than a cube.
std::array<std::size_t, 3> cells_along(const Vector<3>& size, double wanted) {
  std::array<int, 3> by_size = {0, 1, 2};
  std::ranges::sort(by_size, {}, [&](int k) { return size[k]; });
  double edge = std::cbrt(size.prod() / wanted);
  if (size[by_size[0]] < edge) edge = std::sqrt(size[by_size[1]] * size[by_size[2]] / wanted);
  if (size[by_size[1]] < edge) edge = size[by_size[2]] / wanted;
  std::array<std::size_t, 3> cells;
  for (int k = 0; k < 3; ++k)
    cells[static_cast<std::size_t>(k)] = static_cast<std::size_t>(std::max(1.0, std::round(size[k] / edge)));
  return cells;
}

/// One random point in each cell of a grid over the bounds: the error of independent points is an upper bound
/// for these. If the container fills hardly any of its bounds, points of its `Places`.
std::vector<double> sample(const Container& container, double reach, std::size_t points,
                           const std::optional<LowerPart>& below, double volume) {
  const Bounds<3> bounds = below ? below->cut(container.bounds()) : container.bounds();
  const Vector<3> size = bounds.size();
  if (!fills_its_bounds(container)) {
    std::vector<Vector<3>> inside = points_inside(container, points, 1, {});
    if (below) std::erase_if(inside, [&](const Vector<3>& p) { return !below->contains(p); });
    std::vector<double> depths(inside.size());
    parallel_for(depths.size(),
                 [&](std::size_t k) { depths[k] = container.clearance_within(inside[k], reach); });
    std::ranges::sort(depths);
    return depths;
  }
  const double waste = std::clamp(size.prod() / volume, 1.0, most_waste);
  const std::array<std::size_t, 3> cells = cells_along(size, waste * static_cast<double>(points));

  std::vector<double> depths(cells[0] * cells[1] * cells[2], -1);
  parallel_for(depths.size(), [&](std::size_t cell) {
    Random random(1, stream(Stream::measure, cell));
    const std::array<std::size_t, 3> at = {cell % cells[0], cell / cells[0] % cells[1],
                                           cell / (cells[0] * cells[1])};
    Vector<3> p;
    for (int k = 0; k < 3; ++k)
      p[k] = bounds.lower[k] +
             size[k] * (static_cast<double>(at[k]) + random.uniform()) / static_cast<double>(cells[k]);
    if ((!below || below->contains(p)) && container.contains(p, 0))
      depths[cell] = container.clearance_within(p, reach);
  });
  std::erase_if(depths, [](double depth) { return depth < 0; });
  std::ranges::sort(depths);
  return depths;
}

double volume_in(const LowerPart& part, const Domain& shape) {
  return volume_in(part, VolumeBelow(shape, part.direction));
}

}  // namespace

Depths::Depths(const Domain& shape, const Container& container, double reach, std::size_t points,
               const std::optional<LowerPart>& below)
    : below_(below), volume_(below ? volume_in(*below, shape) : container.volume()) {
  if (std::holds_alternative<Mesh>(shape) || std::holds_alternative<Revolved>(shape)) {
    shape_ = Mesh{};
    sampled_ = sample(container, reach, points, below, volume_);
    deepest_ = sampled_.empty() ? 0 : sampled_.back();
    if (deepest_ >= reach) deepest_ = std::numeric_limits<double>::infinity();
  } else {
    shape_ = shape;
    deepest_ = std::visit([](const auto& s) { return deepest_of(s); }, shape);
    if (below) deepest_ = deepest_below();
  }
}

/// By bisection: the depth at which nothing of the inner shape is below the level.
double Depths::deepest_below() const {
  double some = 0, none = deepest_;
  while (none - some > least_step * deepest_) {
    const double middle = 0.5 * (some + none);
    (deeper(middle) > 0 ? some : none) = middle;
  }
  return none;
}

/// The share of the shape (not a mesh), or of its part below the level, deeper than z.
double Depths::inner_share(double z) const {
  const double whole =
      std::visit([z](const auto& s) { return inner_volume(s, z) / inner_volume(s, 0); }, shape_);
  if (!below_ || !(whole > 0)) return whole;
  const double part = volume_in(*below_, with_walls_moved(shape_, z)) / volume_;
  return part > rounding_of_shares ? part : 0;
}

double Depths::deeper(double z) const {
  if (z <= 0) return 1;
  if (!std::holds_alternative<Mesh>(shape_)) return inner_share(z);
  const auto nearer = std::ranges::lower_bound(sampled_, z) - sampled_.begin();
  return sampled_.empty() ? 0 : 1 - static_cast<double>(nearer) / static_cast<double>(sampled_.size());
}

double Depths::error_of(double share) const {
  return sampled_.empty() ? 0 : std::sqrt(share * (1 - share) / static_cast<double>(sampled_.size()));
}

}  // namespace bernal
