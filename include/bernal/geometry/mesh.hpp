#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/core/vector.hpp"
#include "bernal/geometry/true_surface.hpp"

namespace bernal {

/// Exact corners that doubles cannot hold, as of a part in another unit: corner k is exactly (high[k] +
/// low[k]) / scale, with `high` the double nearest to the sum and `scale` a positive integer.
struct ExactCorners {
  double scale = 1;
  std::vector<Vector<3>> high, low;
};

/// The three vertices of a triangle, by index.
using FaceCorners = std::array<std::uint32_t, 3>;

/// A surface as it comes from elsewhere: faces, each as the numbers of its three or more corners among the
/// vertices. It need not be closed, oriented or welded.
struct PolygonSurface {
  std::vector<Vector<3>> vertices;
  std::vector<std::vector<std::uint32_t>> faces;
};

/// A closed triangle mesh with outward orientation that does not intersect itself.
struct Mesh {
  std::vector<Vector<3>> vertices;
  std::vector<FaceCorners> triangles;
  /// Distance of the walls from the triangles, inwards (outwards if negative): what is nearer to a triangle
  /// is outside the domain. Bounds and area are still those of the triangles.
  double inset = 0;
  /// The exact corners, if they are not doubles; `vertices` are then within two roundoffs of them. The
  /// certificate decides on these, and other code keeps off the vertices by more than that. Null once
  /// vertices are moved.
  std::shared_ptr<const ExactCorners> exact = {};
  /// The surface of a CAD file that the triangles stand for, which the certificate then decides on; its flat
  /// triangles are those of the mesh. Null once vertices are moved, and where nobody asks for it.
  std::shared_ptr<const TrueSurface> surface = {};
  /// The axes along which it repeats itself, as a channel does. The triangles are then those of one period,
  /// closed: the period is the extent of the vertices, and triangles that lie in one of its two end planes
  /// are openings and no walls. Precondition: rims of both ends have the same corners but for the period,
  /// exactly, and corners plus whole periods are doubles, which `read_container_mesh` makes sure of.
  std::array<bool, 3> periodic = {};

  bool repeats() const { return periodic[0] || periodic[1] || periodic[2]; }
  /// How far the surface of the CAD file may be from the triangles, which packing keeps off them.
  double margin() const { return surface ? surface->largest(&TrueSurface::Face::apart) : 0; }
};

}  // namespace bernal
