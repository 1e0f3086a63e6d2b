#pragma once
#include <vector>

#include "bernal/cad/mesh_report.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// Connected open edges: the rim of a hole or of an opening.
struct OpenRim {
  Bounds<3> bounds;
  std::vector<Vector<3>> ends;  ///< endpoints of its edges, each twice
};

/// All rims, the widest first. Cost: O(T log T).
std::vector<OpenRim> open_rims(const Mesh& mesh);

/// The widest few of each kind of defect.
std::vector<Defect> defects_of(const Mesh& mesh);

/// The faces of defects: with an open edge, with an edge of more than two faces, and crossing another face.
struct DefectiveFaces {
  std::vector<std::uint32_t> at_open_edges, at_branching_edges, crossing;
};
DefectiveFaces defective_faces(const Mesh& mesh);

}  // namespace bernal::cad
