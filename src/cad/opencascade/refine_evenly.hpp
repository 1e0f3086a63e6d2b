#pragma once
#include "cad/opencascade/face_triangles.hpp"

namespace bernal::cad {

/// Splits and turns inner edges of a face until no triangle bends by more than `most`: the surface over it is
/// as far as that from where the flat triangle has the same parameters, by the formula of
/// `geometry/curved_patch.hpp` with the distances that are measured in the middles of its edges. Edges of the
/// face itself stay, so more may be left beside them. `poles`: edges that are one point in space, such as the
/// pole of a ball and the apex of a cone, and a straight line of parameters; these get as many nodes as there
/// are triangles around them. Returns what is left.
///
/// Cost: some ten points of the surface a triangle that is made; the mesher of OpenCASCADE takes longer, the
/// more the more it makes.
double refine_evenly(const BRepAdaptor_Surface&, const std::vector<NodePair>& poles, double most,
                     FaceTriangles&);

}  // namespace bernal::cad
