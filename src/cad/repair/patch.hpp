#pragma once
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {

/// A closed loop around a hole of a surface, in the direction of the faces that would fill it, each corner
/// once.
struct HoleLoop {
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> beyond;  ///< corner of the face across edge k, from corner k to the next
  std::uint32_t component = 0;
  bool branched = false;  ///< three or more faces meet at one of its edges
  double width = 0;       ///< the diagonal of its bounds
};

/// The holes of a consistently oriented surface; holes that meet in a corner are separated. Cost: O(T).
std::vector<HoleLoop> hole_loops(const Mesh& mesh, const MeshTopology& topology);

/// Fills holes, and keeps the surface's edges, because no patch may repeat one of them.
class Patcher {
 public:
  explicit Patcher(Mesh& mesh);

  /// Appends faces that fill the hole; false, with nothing changed, if there are none. A hole that projects
  /// without folds along its normal gets the constrained Delaunay triangulation in that projection if it is
  /// nearly flat or has many corners; other holes get the triangulation with the smallest largest angle
  /// between neighbouring faces, ties by the smallest area (Liepa 2003); if neither exists, a fan around a
  /// new corner in its middle. Precondition: not branched. Cost: O(n log n), or O(n³) for n corners up to
  /// 400.
  bool fill(const HoleLoop& loop);

 private:
  using Triangles = std::vector<FaceCorners>;
  static std::uint64_t key(std::uint32_t a, std::uint32_t b);

  Vector<3> across(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  bool is_thin(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  bool is_allowed(const HoleLoop& loop, const Triangles& triangles) const;
  Triangles seen_from_above(const HoleLoop& loop) const;
  Triangles least_bent(const HoleLoop& loop) const;
  Triangles around_middle(const HoleLoop& loop);

  Mesh& mesh_;
  std::unordered_set<std::uint64_t> edges_;
};

}  // namespace bernal::cad
