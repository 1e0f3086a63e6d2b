#pragma once
#include <TopoDS_Face.hxx>

#include "cad/opencascade/face_boundary.hpp"
#include "cad/opencascade/face_triangles.hpp"

namespace bernal::cad {

/// Appends a face with its formulas to a surface: `triangles` with the face's orientation, the first of whose
/// nodes are those of the triangulation. Gaps between its edges and those of its neighbours, as far as the
/// tolerances of the file allow them, belong to it. `fine`: what may remain between an edge and its chords.
void append_face(const TopoDS_Face&, const opencascade::handle<Poly_Triangulation>&, const TopLoc_Location&,
                 const FaceTriangles& triangles, double fine, TrueSurface&);

}  // namespace bernal::cad
