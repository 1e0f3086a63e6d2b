#pragma once
#include "cad/read/polygon_soup.hpp"

class TopoDS_Shape;

namespace bernal::cad {

/// The result of a tessellation.
struct Tessellated {
  SurfaceDeviation deviation;
  std::size_t untriangulated = 0;  ///< faces that the mesher left out
  std::size_t without_area = 0;    ///< faces whose triangles all collapse
};

/// Appends the triangles of an OpenCASCADE shape to the soup, at most `deflection` from its surfaces. The
/// deviation states what was reached; edges known only to a larger tolerance limit it. Faces share the points
/// of their common edges by index, independent of rounding in their placements: a closed shape gives closed
/// triangles. Triangles have the orientation of their faces.
///
/// Where `surface` is given, the faces are appended to it with their formulas; `fine`: what may remain
/// between their edges and chords.
Tessellated append_tessellation(const TopoDS_Shape& shape, double deflection, PolygonSoup& soup,
                                TrueSurface* surface = nullptr, double fine = 0);

}  // namespace bernal::cad
