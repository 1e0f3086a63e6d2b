#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// What a CAD file is, as far as being a container matters. Lengths are in the file's own unit.
struct MeshReport {
  std::string reader;          ///< which reader's coordinates were used and why, one phrase
  std::uint64_t faces = 0;     ///< triangles after triangulation and welding
  std::uint64_t vertices = 0;  ///< distinct points
  bool closed = false;
  std::uint64_t open_edges = 0;
  std::uint64_t non_manifold_edges = 0;  ///< with three or more faces
  std::uint64_t non_manifold_vertices = 0;
  std::uint64_t misoriented_edges = 0;  ///< traversed twice in the same direction by their two faces
  std::uint64_t degenerate_faces = 0;
  std::uint64_t duplicate_faces = 0;
  std::uint64_t self_intersections = 0;  ///< pairs of faces
  std::uint64_t components = 0;
  std::int64_t genus = 0;  ///< sum over components, where closed
  double volume = 0;       ///< enclosed, 0 unless usable
  double area = 0;
  Bounds<3> bounds;
  std::string orientation;  ///< as read: "outward", "inward", "mixed"; "consistent" where there is no out
  std::vector<std::string> repairs;   ///< what is done before use, one phrase each; all of them safe
  std::vector<std::string> problems;  ///< why it cannot be a container, with counts; empty if it can
  bool usable() const { return problems.empty(); }
};

}  // namespace bernal
