#pragma once
#include <string_view>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/geometry/true_surface.hpp"

namespace bernal::cad {

/// Gives a mesh the surface that its triangles stand for, once it is a container and `surface` has its unit
/// and its axes, with the bounds of how far the two are apart; the report says what they are. Where something
/// changed the triangles, or nothing is proven of a face, the report says that, and the mesh gets nothing.
void attach(TrueSurface&& surface, std::string_view unit, ImportedMesh&);

/// Throws OptionError where the scene asks for the surface, and the mesh has none.
void require_true_surface(const MeshFile&, const ImportedMesh&);

}  // namespace bernal::cad
