#pragma once
#include <TopoDS_Shape.hxx>

#include <vector>

namespace bernal::cad {

/// The result of sewing faces that belong to no solid.
struct Sewn {
  std::vector<TopoDS_Shape> shells;  ///< including single unconnected faces
  std::size_t parts = 1;             ///< number of parts sewn separately
  double tolerance = 0;              ///< the largest used
  int free_edges = 0;
};

/// Sews faces with the smallest of a few tolerances that leaves no edge, or the fewest edges, free: part by
/// part if the faces come in the order of closed parts, so that touching parts stay apart; else all together.
Sewn sew(const std::vector<TopoDS_Shape>& faces, double diagonal);

}  // namespace bernal::cad
