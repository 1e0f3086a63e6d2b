#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string_view>

#include "bernal/core/monitor.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// What a voxel holds.
enum class VoxelValues {
  binary,    ///< one byte: 0 pore, 1 sphere, 2 outside the container
  labels,    ///< four, unsigned: 0 pore, i + 1 sphere i, 0xFFFFFFFF (-1 where read as signed) outside
  fraction,  ///< a float: the volume of the spheres in the voxel over that of the voxel
};

/// Bytes a voxel: 1 or 4.
int bytes_per_voxel(VoxelValues);

/// Equal boxes side by side that cover a domain. Lengths are in the domain's unit.
///
/// Along an axis that repeats itself they divide the period evenly; along others the first begins where the
/// domain's bounds do, and the last may reach beyond them. In two dimensions there is one layer, the plane
/// z = 0 in its middle.
struct VoxelGrid {
  int dimension = 3;
  std::array<std::int64_t, 3> count = {1, 1, 1};
  Vector<3> corner = Vector<3>::Zero();  ///< the lowest of voxel (0, 0, 0)
  Vector<3> spacing = Vector<3>::Ones();

  std::int64_t voxels() const { return count[0] * count[1] * count[2]; }
  /// The middle of the i-th voxel along an axis.
  double center(int axis, std::int64_t i) const {
    return corner[axis] + (static_cast<double>(i) + 0.5) * spacing[axis];
  }
  /// Where the i-th voxel along an axis begins.
  double plane(int axis, std::int64_t i) const {
    return corner[axis] + static_cast<double>(i) * spacing[axis];
  }
  /// Area of a voxel in two dimensions, else its volume.
  double measure() const { return dimension == 2 ? spacing[0] * spacing[1] : spacing.prod(); }
  /// Whether all edges are equal, to rounding.
  bool has_cubes() const;
};

/// The grid of voxels whose edge is about `edge`: where axes repeat themselves, the edge is the nearest that
/// divides the longest period evenly, and each other period is divided by an edge of its own. Precondition:
/// two or three dimensions. Throws Error{bad_argument} for an edge that is not positive and finite or makes
/// more than 2^40 voxels, 2^31 along an axis or 2^30 in a layer.
VoxelGrid voxel_grid(const Domain&, double edge);

/// The grid with so many voxels along the longest edge of the domain's bounds; each axis that repeats itself
/// has the whole number nearest to that. Throws as the other, and for less than one.
VoxelGrid voxel_grid_of(const Domain&, std::int64_t resolution);

/// Takes whole layers of voxels, little-endian, x fastest, then y; layers come in the order of z.
using TakeLayers = std::function<void(std::string_view)>;

/// The image of spheres, in all their periodic images, and of the walls of their domain.
///
/// A voxel whose centre lies in a ball, or on its surface, is that sphere's; if there are several balls, the
/// first sphere's: dx*dx + (dy*dy + dz*dz) <= r*r for the difference of the voxel's `center` and the ball's,
/// computed in doubles. Of the others those are outside whose centre lies outside the domain, to rounding.
///
/// A fraction is the exact volume (in two dimensions the area) of the spheres' parts in the voxel over the
/// voxel's, to a few times 1e-16 (r/h)^3 for voxels of edge h, and then rounded to a float. Fractions know
/// nothing of walls, so that they sum up to the volume of the spheres. Where balls overlap each counts, up to
/// 1.
///
/// Precondition: spheres and domain of two or three dimensions. The same bytes for any number of threads. At
/// most 64 MiB of layers are in memory, or one layer (of fractions eight, up to 512 MiB), and 48 bytes for
/// each image of a sphere there. Cost: for labels and binary images about 50 ns for every row of voxels in a
/// ball and 1 ns a triangle and layer; for fractions some µs a ball, and some ns a voxel of its bounds.
/// Throws Error{bad_packing} where a sphere meets a million of its images, Cancelled once the monitor says
/// stop.
void voxelise(const Spheres<dynamic>&, const Domain&, const VoxelGrid&, VoxelValues, const TakeLayers&,
              const Monitor& monitor = {});

}  // namespace bernal
