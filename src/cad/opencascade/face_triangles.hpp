#pragma once
#include <BRepAdaptor_Surface.hxx>
#include <gp_Pnt.hxx>
#include <gp_XY.hxx>

#include <array>
#include <cstdint>
#include <vector>

#include "bernal/core/vector.hpp"
#include "cad/read/polygon_soup.hpp"

namespace bernal::cad {

inline Vector<3> vector_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

/// The triangles that stand for one face, and which parameters of its surface their corners have.
struct FaceTriangles {
  using Corners = std::array<std::uint32_t, 3>;

  std::vector<Vector<3>> places;
  std::vector<gp_XY> parameters;
  std::vector<Corners> triangles;
};

/// How far the surface lies from fifteen points of a triangle: the middles of its edges are among them, where
/// a bulge is highest. `outside` is where the triangle's normal points to.
SurfaceDeviation deviation_of(const BRepAdaptor_Surface&, const FaceTriangles&,
                              const FaceTriangles::Corners&);

/// Splits edges between two triangles of the face, at points of the surface, until each triangle has it
/// within the deflection, beside what its corners are off, or no edge longer than the deflection is left to
/// be split. Edges of the face stay as they are. Cost: a measurement a triangle, and four a split; at most
/// twenty triangles become of one.
void refine(const BRepAdaptor_Surface&, double deflection, FaceTriangles&);

}  // namespace bernal::cad
