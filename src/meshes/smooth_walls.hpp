#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "meshes/flat_walls.hpp"
#include "near/box_tree.hpp"

namespace bernal {

/// Planar parts that are triangulated as one, seen along a direction: no two of their points lie over each
/// other.
struct SmoothPart {
  FlatPart frame;                    ///< of the part that it began with
  std::vector<std::uint32_t> parts;  ///< of PlanarWalls, in the order in which they were found

  bool is_planar() const { return parts.size() == 1; }
};

/// A line of straight pieces between two smooth parts.
struct SmoothEdge {
  std::array<std::uint32_t, 2> parts = {};                   ///< of SmoothWalls
  std::vector<std::uint32_t> line;                           ///< vertices of the mesh, from corner to corner
  std::vector<double> along;                                 ///< lengths from the first to each of them
  std::vector<std::array<std::uint32_t, 2>> flat_parts;      ///< of PlanarWalls, at each piece
  double longest = std::numeric_limits<double>::infinity();  ///< edges that the bends of the line allow

  std::array<std::uint32_t, 2> corners() const { return {line.front(), line.back()}; }
  double length() const { return along.back(); }
  /// The piece on which a share of the length ends.
  std::size_t piece_at(double share) const;
  Vector<3> at(const Mesh& mesh, double share) const;
};

/// Planar walls joined where they bend little: facets of a curved wall that are finer than a tolerance are
/// triangulated across. Planar parts are joined over an edge where a quarter of its bend times the width of
/// the narrower part is at most the tolerance, none is more than four times as wide as the other, and both
/// face the frame's way to within 38 degrees.
struct SmoothWalls {
  std::vector<SmoothPart> parts;
  std::vector<std::uint32_t> of_flat_part;
  std::vector<SmoothEdge> edges;
  /// The longest edges on each planar part, so that they stay within the tolerance of it and of its
  /// neighbours; infinite where it is not joined to others.
  std::vector<double> longest;
};
/// `keep_apart`: planar parts that are joined to no others. Precondition: `walls` are the mesh's. Cost:
/// O(T log T).
SmoothWalls smooth_walls_of(const Mesh&, const PlanarWalls& walls, double tolerance,
                            const std::vector<char>& keep_apart);

/// The triangles of a smooth part, over the plane of its frame.
class SmoothSurface {
 public:
  SmoothSurface(const Mesh&, const SmoothPart&,
                const std::vector<std::vector<std::uint32_t>>& triangles_of_flat_part);

  /// In the plane of the frame, with z = 0.
  Vector<3> flat(const Vector<3>& p) const { return {on(0, p), on(1, p), 0}; }
  struct Place {
    Vector<3> point;          ///< on the triangles, in the scene
    double height;            ///< of it above the plane of the frame
    std::uint32_t flat_part;  ///< of PlanarWalls
  };
  /// What is over a point of the plane; beside the part what is over its nearest point.
  Place over(const Vector<3>& q) const;
  double height_of(const Vector<3>& p) const { return on(2, p); }

 private:
  struct Triangle {
    std::array<Vector<3>, 3> corners;  ///< in the frame
    std::uint32_t flat_part;
  };
  double on(int axis, const Vector<3>& p) const { return (p - frame_.origin).dot(axes_.col(axis)); }

  FlatPart frame_;
  Eigen::Matrix3d axes_;
  std::vector<Triangle> triangles_;
  BoxTree<2> tree_;
  double extent_ = 0;
};

}  // namespace bernal
