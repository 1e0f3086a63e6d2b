#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bernal/geometry/mesh.hpp"
#include "meshes/delaunay.hpp"

namespace bernal {

/// A part of a sphere or of a plane with its boundary as points and edges between them.
struct BoundedPart {
  Delaunay::Surface surface = Delaunay::Surface::sphere;
  double extent = 1;                                     ///< as of `Delaunay`
  std::vector<Vector<3>> points = {};                    ///< about the sphere's centre, or in the plane z = 0
  std::vector<std::array<std::uint32_t, 2>> edges = {};  ///< of its boundary
  /// Points of circles outside of which a sphere's part lies, by circle.
  std::vector<std::vector<std::uint32_t>> circles = {};
  std::vector<Vector<3>> starts = {};                 ///< points inside to begin with
  std::function<double(const Vector<3>&)> size = {};  ///< the longest edges at a point
  /// A strip that repeats itself along x: `points` has those of one period, 0 <= x < period, which may have
  /// any y. 0: no strip. Copies within `margin` beyond the period are made here.
  double period = 0, margin = 0;
};

/// Triangles over the points of a patch and those added inside.
struct PatchMesh {
  std::vector<Vector<3>> added;
  std::vector<FaceCorners> triangles;  ///< counterclockwise; corners count the patch's points first
};

/// Triangles of a patch: all edges of its boundary are edges of triangles, sizes are kept, and angles are at
/// least 27 degrees where the boundary leaves room (Chew 1993, Ruppert 1995: circumcentres are inserted, here
/// never where they would come near the boundary, then points are moved to the middle of their neighbours as
/// long as the least angle grows). Throws Error{bad_argument} if a part of the boundary is missing in the
/// triangulation of its points, which are then too near to each other for the size of its edges (in the
/// plane: if such parts cross).
PatchMesh mesh_patch(const BoundedPart&);

/// Its corners, on the unit sphere: points to begin with.
std::vector<Vector<3>> icosahedron();

/// The least angle of a triangle, in radians.
double least_angle(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c);

}  // namespace bernal
