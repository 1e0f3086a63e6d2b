#pragma once
#include <Poly_Triangulation.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Face.hxx>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "cad/opencascade/face_patches.hpp"

namespace bernal::cad {

/// A piece of a face's edge between two nodes of its triangulation: points of parameters on the edge, between
/// which it is nearly straight.
struct BoundaryLine {
  std::vector<Parameters> points;
  std::vector<double> off;  ///< how far in space the surface over the edge is from that over each chord
  double tolerance = 0;     ///< of the edge
  double tolerance_from = 0, tolerance_to = 0;  ///< of a corner at either end; 0: there is none
};

/// By their nodes, in the order of the points.
using Boundary = std::map<std::array<std::uint32_t, 2>, BoundaryLine>;

/// The edges of a face. They are divided until chords are at most `fine` off, or each is in 64 pieces between
/// two nodes. A tolerance that is less than what is measured at these points is replaced by that. Throws
/// Standard_Failure, with words, where an edge has a curve that nothing bounds.
Boundary boundary_of(const TopoDS_Face&, const opencascade::handle<Poly_Triangulation>&,
                     const TopLoc_Location&, FacePatches&, double fine);

/// Cuts a straight line at a node.
void cut(Boundary&, const std::array<std::uint32_t, 2>& edge, std::uint32_t node, const Parameters& at);

}  // namespace bernal::cad
