#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// Corners that need not be doubles, as those of a part in another unit: corner k is exactly
/// (high[k] + low[k]) / scale, where `high` is the double nearest to the sum and `scale` a positive integer.
struct ExactCorners {
  double scale = 1;
  std::vector<Vector<3>> high, low;
};

/// Of a triangle, by their numbers among the vertices.
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
  /// The walls stand so far inside of the triangles, or behind them where that is negative: what is nearer to
  /// a triangle is not of the domain. Its bounds and its area are those of the triangles all the same.
  double inset = 0;
  /// Where the corners are not doubles, what they are; `vertices` are within two roundoffs of them then. The
  /// certificate decides on these, and what has to stay inside keeps off the others by more than that. None
  /// is left where vertices are moved.
  std::shared_ptr<const ExactCorners> exact = {};
};

}  // namespace bernal
