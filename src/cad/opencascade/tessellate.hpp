#pragma once
#include "cad/read/polygon_soup.hpp"

class TopoDS_Shape;

namespace bernal::cad {

/// What became of the faces of a shape.
struct Tessellated {
  SurfaceDeviation deviation;
  std::size_t untriangulated = 0;  ///< faces that the mesher left out
  std::size_t without_area = 0;    ///< faces whose triangles all collapse
};

/// Triangles of a shape of OpenCASCADE, appended to the soup, no farther than `deflection` from its surfaces.
/// The deviation says whether that was reached: surfaces whose edges are known only to a larger tolerance
/// allow no less. Faces that share an edge share its points by index, whatever was rounded in the placement
/// of each: a closed shape gives closed triangles. Triangles run as their faces are oriented.
Tessellated append_tessellation(const TopoDS_Shape& shape, double deflection, PolygonSoup& soup);

}  // namespace bernal::cad
