#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/voxels/voxels.hpp"

namespace bernal {
namespace {

constexpr double most_voxels = 0x1p40, most_along_axis = 0x1p31, most_in_layer = 0x1p30;
/// Along an axis with n voxels, n times this share of a voxel may stay uncovered, so that rounding of an edge
/// that is a multiple of a voxel's does not add another voxel.
constexpr double slack = 1e-9;

void require_dimension(const Domain& domain) {
  const int dimension = dimension_of(domain);
  if (dimension != 2 && dimension != 3)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("images have two or three dimensions, and this packing has {}; export its spheres as "
                    "numbers instead",
                    dimension));
}

VoxelGrid grid_of_edge(const Domain& domain, double edge) {
  const Bounds<3> bounds = bounds_of(domain);
  const Vector<3> periods = boundary_in_space(domain).edges;
  VoxelGrid grid{.dimension = dimension_of(domain), .corner = bounds.lower};
  double counts[3] = {1, 1, 1};
  for (int k = 0; k < grid.dimension; ++k) {
    const double n = (periods[k] > 0 ? periods[k] : bounds.size()[k]) / edge;
    counts[k] = std::max(1.0, periods[k] > 0 ? std::round(n) : std::ceil(n * (1 - slack)));
  }
  const double layer = counts[0] * counts[1], all = layer * counts[2];
  // (Also NaN, for an infinitely small edge.)
  if (!(*std::max_element(counts, counts + 3) < most_along_axis && layer <= most_in_layer &&
        all <= most_voxels))
    throw Error(ErrorCode::bad_argument,
                fmt::format("voxels of edge {:.6g} make an image of {:.6g} x {:.6g} x {:.6g}, which is more "
                            "than 2^40 of them, 2^31 along an axis or 2^30 in a layer; take larger ones",
                            edge, counts[0], counts[1], counts[2]));
  for (int k = 0; k < grid.dimension; ++k) {
    grid.count[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(counts[k]);
    grid.spacing[k] = periods[k] > 0 ? periods[k] / counts[k] : edge;
  }
  if (grid.dimension == 2) {
    grid.spacing[2] = edge;
    grid.corner[2] = -0.5 * edge;
  }
  return grid;
}

}  // namespace

int bytes_per_voxel(VoxelValues values) {
  return values == VoxelValues::labels || values == VoxelValues::fraction ? 4 : 1;
}

bool VoxelGrid::has_cubes() const {
  for (int k = 1; k < dimension; ++k)
    if (!(std::abs(spacing[k] - spacing[0]) <= 1e-12 * spacing[0])) return false;
  return true;
}

VoxelGrid voxel_grid(const Domain& domain, double edge) {
  require_dimension(domain);
  if (!(edge > 0 && std::isfinite(edge)))
    throw Error(ErrorCode::bad_argument,
                fmt::format("the edge of a voxel must be a positive length, not {}", edge));
  const double longest = boundary_in_space(domain).edges.maxCoeff();
  return grid_of_edge(domain, longest > 0 ? longest / std::max(1.0, std::round(longest / edge)) : edge);
}

VoxelGrid voxel_grid_of(const Domain& domain, std::int64_t resolution) {
  require_dimension(domain);
  if (resolution < 1)
    throw Error(ErrorCode::bad_argument,
                fmt::format("there must be at least one voxel along the longest edge, not {}", resolution));
  return grid_of_edge(domain, bounds_of(domain).size().maxCoeff() / static_cast<double>(resolution));
}

}  // namespace bernal
