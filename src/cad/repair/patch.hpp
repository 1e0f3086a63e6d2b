#pragma once
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {

/// Once around a hole of a surface, in the direction of the faces that would fill it. No corner occurs twice.
struct HoleLoop {
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> beyond;  ///< the corner of the face across edge k, from corner k to the next
  std::uint32_t component = 0;
  bool branched = false;  ///< at some edges of it three or more faces meet
  double width = 0;       ///< the diagonal of its bounds
};

/// The holes of a surface whose faces agree on their orientation. Where the holes meet in a corner they are
/// told apart. Cost: O(T).
std::vector<HoleLoop> hole_loops(const Mesh& mesh, const MeshTopology& topology);

/// Fills holes, and remembers which edges the surface has, because no patch may have one of them again.
class Patcher {
 public:
  explicit Patcher(Mesh& mesh);

  /// Appends faces that fill the hole; false if there are none, and then nothing is changed. A hole whose
  /// rim can be seen without folds along its normal gets the constrained Delaunay triangulation in that
  /// direction if it is nearly flat or has many corners; another the triangulation with the smallest largest
  /// angle between neighbouring faces, and of those that of the smallest area (Liepa 2003); if neither
  /// exists, a fan around a new corner in its middle.
  /// Precondition: not branched. Cost: O(n log n), or O(n³) for n corners up to 400.
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
