#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A place where a surface fails to be a wall.
struct Defect {
  std::string what;  ///< "hole", "crossing", "edge with more than two faces"
  Vector<3> at;      ///< in the middle of it
  double across;     ///< how wide it is
};

/// What a CAD file is, as far as being a container matters. Lengths are in the unit that was asked for, or
/// else the file's own.
struct MeshReport {
  std::string reader;     ///< which reader's coordinates were used and why, one phrase
  std::string unit;       ///< of the file's coordinates: what it says, or "" where it says nothing
  double metres = 0;      ///< one unit of the file's; 0 where it says nothing
  double deflection = 0;  ///< of a true surface, as it was tessellated; 0 where the file holds none
  char up = 0;            ///< which axis the file says is up: 'x', 'y', 'z'; 0 where it says nothing
  std::vector<std::string> solids;  ///< by what names the file tells its parts apart
  std::vector<std::string> notes;   ///< what else the file says, or how it was read, one phrase each
  std::uint64_t faces = 0;          ///< triangles after triangulation and welding
  std::uint64_t vertices = 0;       ///< distinct points
  bool closed = false;
  std::uint64_t open_edges = 0;
  std::uint64_t non_manifold_edges = 0;  ///< with three or more faces
  std::uint64_t non_manifold_vertices = 0;
  std::uint64_t misoriented_edges = 0;  ///< traversed twice in the same direction by their two faces
  std::uint64_t degenerate_faces = 0;
  std::uint64_t duplicate_faces = 0;
  std::uint64_t self_intersections = 0;  ///< pairs of faces, counted up to 50,000 and two for every face
  std::uint64_t components = 0;
  std::int64_t genus = 0;  ///< sum over components, where closed
  double volume = 0;       ///< enclosed, 0 unless usable
  /// What the hollow of a usable part holds that is a shell with an opening, and so rather the wall around
  /// what is meant; 0 where it is none.
  double hollow_volume = 0;
  double area = 0;
  Bounds<3> bounds;
  std::string orientation;      ///< as read: "outward", "inward", "mixed"; "consistent" where there is no out
  std::vector<Defect> defects;  ///< the worst of each kind, a few of them
  std::vector<std::string> repairs;   ///< what is done before use, one phrase each
  bool is_repaired = false;           ///< the wall is no longer the file's surface: some of it was made up
  std::vector<std::string> cautions;  ///< what may not be as it is meant though it can be a container
  std::vector<std::string> problems;  ///< why it cannot be a container, with counts; empty if it can
  bool usable() const { return problems.empty(); }
};

}  // namespace bernal
