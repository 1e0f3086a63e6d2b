#pragma once
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// One on the edge of a hole, or on several that lie in one plane.
struct Lid {
  Bounds<3> bounds = Bounds<3>::of_nothing();
  Vector<3> middle;         ///< of the widest edge
  bool is_flat;             ///< it lies in a plane
  std::size_t first, last;  ///< of the triangles that are its faces
};

/// Closes every hole of a surface by a lid, in the plane of its edge where that has one; holes of which the
/// edges lie in one plane share a lid, as those of a ring do. Appends their faces to `walls`. Returns nothing
/// where an edge branches or has no lid.
std::vector<Lid> put_lids(Mesh& walls);

}  // namespace bernal::cad
