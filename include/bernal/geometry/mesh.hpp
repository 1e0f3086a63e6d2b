#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/core/vector.hpp"

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
};

}  // namespace bernal
