#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A place where a surface fails as a wall.
struct Defect {
  std::string what;  ///< "hole", "crossing", "edge with more than two faces"
  Vector<3> at;      ///< in the middle of the defect
  double across;     ///< width of the defect
};

/// What the importer found in a CAD file. Lengths are in the requested unit, or in the file's own if none was
/// requested.
struct MeshReport {
  std::string reader;           ///< the reader whose coordinates were used, and why, one phrase
  std::string unit;             ///< of the file's coordinates, as the file states it; "" if it does not
  double metres = 0;            ///< one unit of the coordinates in metres; 0 if the file does not say
  double stated_metres = 0;     ///< `unit` in metres: readers convert STEP and IGES to millimetres
  std::string without_surface;  ///< why the mesh has no `surface`, though it was asked for; "" else
  double deflection = 0;  ///< linear deflection of the tessellation; 0 if the file holds no true surfaces
  char up = 0;            ///< the file's upward axis: 'x', 'y' or 'z'; 0 if it does not say
  std::vector<std::string> solids;  ///< names of the file's parts
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
  std::uint64_t self_intersections = 0;  ///< pairs of faces, counted up to 50,000 plus two per face
  std::uint64_t components = 0;
  std::int64_t genus = 0;  ///< sum over components; only if closed
  double volume = 0;       ///< enclosed volume; 0 unless usable
  /// Volume of the hollow, if the usable part is a shell with an opening, so that the file probably models
  /// the wall around the intended container; else 0.
  double hollow_volume = 0;
  double area = 0;
  Bounds<3> bounds;
  /// As read: "outward", "inward", "mixed"; "consistent" if there is no outside.
  std::string orientation;
  std::vector<Defect> defects;       ///< the worst few of each kind
  std::vector<std::string> repairs;  ///< repairs made before use, one phrase each
  /// The wall differs from the file's surface, which was completed or replaced.
  bool is_repaired = false;
  std::vector<std::string> cautions;  ///< what may not be as intended, although the mesh can be a container
  std::vector<std::string> problems;  ///< why it cannot be a container, with counts; empty if it can
  bool usable() const { return problems.empty(); }
};

}  // namespace bernal
