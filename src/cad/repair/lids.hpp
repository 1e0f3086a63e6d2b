#pragma once
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// A lid on one hole, or on several in one plane.
struct Lid {
  Bounds<3> bounds = Bounds<3>::of_nothing();
  Vector<3> middle;         ///< of the widest edge
  bool is_flat;             ///< planar
  std::size_t first, last;  ///< range of its faces among the triangles
};

/// Closes every hole of a surface by a lid, in the plane of its rim if that is planar; holes in one plane
/// share a lid, as in a ring. Appends their faces to `walls`. Empty if an edge branches or cannot be closed.
std::vector<Lid> put_lids(Mesh& walls);

}  // namespace bernal::cad
