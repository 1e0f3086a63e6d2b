#pragma once
#include <TopoDS_Shape.hxx>

#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// The solid that a closed mesh encloses, of planar faces: each a polygon with holes, as corners of the mesh,
/// the outline first and counter-clockwise from outside. Two faces share the vertices and edges at which they
/// meet, so that nothing has to be sewn. Null where an edge has not one face on either side. Precondition:
/// corners lie within 1e-9 of the mesh's extent on the planes of their faces. Cost: O(edges log edges).
TopoDS_Shape solid_of_mesh(const Mesh& mesh,
                           const std::vector<std::vector<std::vector<std::uint32_t>>>& faces);

}  // namespace bernal::cad
