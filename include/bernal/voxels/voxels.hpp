#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// The values of an image's voxels.
enum class VoxelValues {
  binary,     ///< one byte: 0 pore, 1 sphere, 2 outside the container
  labels,     ///< four bytes, unsigned: 0 pore, i + 1 sphere i, 0xFFFFFFFF (-1 if signed) outside
  fraction,   ///< a float: the share of the voxel's volume inside spheres, or inside some of their layers
  materials,  ///< one byte: 0 pore, k what the layers are made of, 255 outside the container
  layers,     ///< the same of the layers themselves
};

/// What spheres are made of, from the centre out: a ball, then shells. Empty: each is one ball.
struct VoxelLayers {
  std::vector<std::size_t> first = {};   ///< one entry a sphere, and one more: where its layers begin below
  std::vector<double> outer = {};        ///< where each layer ends, ascending to the sphere's radius
  std::vector<std::uint8_t> value = {};  ///< of each layer: from 1 to 254; of a fraction 1 where it counts
};

/// Bytes a voxel: 1 or 4.
int bytes_per_voxel(VoxelValues);

/// A grid of equal boxes that covers a domain. Lengths are in the domain's unit.
///
/// Along periodic axes the voxels divide the period evenly; along others the first begins at the domain's
/// bounds, and the last may reach beyond them. In two dimensions there is one layer, with the plane z = 0 in
/// its middle.
struct VoxelGrid {
  int dimension = 3;
  std::array<std::int64_t, 3> count = {1, 1, 1};
  Vector<3> corner = Vector<3>::Zero();  ///< lowest corner of voxel (0, 0, 0)
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
  /// The area of a voxel in two dimensions, else its volume.
  double measure() const { return dimension == 2 ? spacing[0] * spacing[1] : spacing.prod(); }
  /// Whether all edges are equal, to rounding.
  bool has_cubes() const;
};

/// The grid of voxels with edges of about `edge`. With periodic axes, the edge is the nearest that divides
/// the longest period evenly, and each other period gets its own nearest divisor. Precondition: two or three
/// dimensions. Throws Error{bad_argument} for an edge that is not positive and finite, or that makes more
/// than 2^40 voxels, 2^31 along an axis or 2^30 in a layer.
VoxelGrid voxel_grid(const Domain&, double edge);

/// The grid with `resolution` voxels along the longest edge of the domain's bounds; each periodic axis gets
/// the nearest whole number. Throws as `voxel_grid`, and for less than one voxel.
VoxelGrid voxel_grid_of(const Domain&, std::int64_t resolution);

/// Receives whole layers of voxels in the order of z: little-endian, x fastest, then y.
using TakeLayers = std::function<void(std::string_view)>;

/// Makes the image of spheres, with all their periodic images, and of the walls of their domain.
///
/// A voxel belongs to the first sphere whose ball, surface included, contains its centre: dx*dx + (dy*dy +
/// dz*dz) <= r*r for the difference of the voxel's `center` and the ball's, computed in doubles. Other voxels
/// are outside if their centre is outside the domain, to rounding.
///
/// A fraction is the exact volume (area in two dimensions) of the spheres in the voxel over the voxel's, to a
/// few times 1e-16 (r/h)^3 for voxels of edge h, rounded to a float. Fractions ignore walls, so they sum to
/// the volume of the spheres. Overlapping balls each count, up to 1. Of layers the fraction is that of those
/// whose value is not 0: the difference of balls, each exact.
///
/// Where spheres have layers, a voxel of the values `materials` and `layers` has the value of the layer that
/// contains its centre.
///
/// Precondition: spheres and domain of two or three dimensions. The bytes are the same for any number of
/// threads. Memory: at most 64 MiB of layers, or one layer (for fractions eight, up to 512 MiB), plus 48
/// bytes for each image of a sphere there. Cost: for labels and binary images about 50 ns a row of voxels in
/// a ball and 1 ns a triangle and layer; for fractions some µs a ball and some ns a voxel in its bounds.
/// Throws Error{bad_packing} if a sphere meets a million of its images, Cancelled once the monitor says stop.
void voxelise(const Spheres<dynamic>&, const Domain&, const VoxelGrid&, VoxelValues, const TakeLayers&,
              const Monitor& monitor = {}, const VoxelLayers& layers = {});

}  // namespace bernal
