#pragma once
#include <TopoDS_Shape.hxx>

#include <vector>

namespace bernal::cad {

/// What became of faces that belong to no solid.
struct Sewn {
  std::vector<TopoDS_Shape> shells;  ///< and faces that hang together with no other
  std::size_t parts = 1;             ///< that were sewn one by one
  double tolerance = 0;              ///< the largest that was needed
  int free_edges = 0;
};

/// Sews faces with the least of a few tolerances that leaves no edge free, or the fewest: each part by
/// itself, where the faces come in the order of closed parts, so that parts which touch stay apart; else all
/// together.
Sewn sew(const std::vector<TopoDS_Shape>& faces, double diagonal);

}  // namespace bernal::cad
