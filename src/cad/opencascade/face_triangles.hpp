#pragma once
#include <BRepAdaptor_Surface.hxx>
#include <gp_Pnt.hxx>
#include <gp_XY.hxx>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "bernal/core/vector.hpp"
#include "cad/read/polygon_soup.hpp"

namespace bernal::cad {

inline Vector<3> vector_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

/// Two nodes of a triangulation; and in ascending order.
using NodePair = std::array<std::uint32_t, 2>;
inline NodePair ascending(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// The triangles of one face, and the surface parameters of their corners.
struct FaceTriangles {
  using Corners = std::array<std::uint32_t, 3>;

  std::vector<Vector<3>> places;
  std::vector<gp_XY> parameters;
  std::vector<Corners> triangles;
  /// Nodes that were added in edges of the face that are a point, and the node that was there before; and
  /// {from, to, node} in their order.
  std::map<std::uint32_t, std::uint32_t> at_pole = {};
  std::vector<Corners> cuts = {};
};

/// Distance of the surface from fifteen points of a triangle, including the middles of its edges, where a
/// bulge is highest. `outside` is in the direction of the triangle's normal.
SurfaceDeviation deviation_of(const BRepAdaptor_Surface&, const FaceTriangles&,
                              const FaceTriangles::Corners&);

/// Splits inner edges of the face at points of the surface, until each triangle is within the deflection
/// (apart from the error of its corners), or no edge longer than the deflection is left. Edges of the face
/// itself stay. Cost: a measurement a triangle, and four a split; a triangle is split into at most twenty.
void refine(const BRepAdaptor_Surface&, double deflection, FaceTriangles&);

}  // namespace bernal::cad
