#pragma once
#include <limits>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "cad/mesh_topology.hpp"

namespace bernal::cad {

/// The bounds of a lid, or of a face.
struct LidBox {
  Bounds<3> bounds{Vector<3>::Constant(std::numeric_limits<double>::infinity()),
                   Vector<3>::Constant(-std::numeric_limits<double>::infinity())};

  void add(const Vector<3>& p) {
    bounds.lower = bounds.lower.cwiseMin(p);
    bounds.upper = bounds.upper.cwiseMax(p);
  }
  bool meets(const LidBox& other) const {
    return (bounds.lower.array() <= other.bounds.upper.array()).all() &&
           (other.bounds.lower.array() <= bounds.upper.array()).all();
  }
};

LidBox box_of(const Mesh&, const FaceCorners&);

/// One on the edge of a hole, or on several that lie in one plane.
struct Lid {
  LidBox box;
  Vector<3> middle;         ///< of the widest edge
  bool is_flat;             ///< it lies in a plane
  std::size_t first, last;  ///< of the triangles that are its faces
};

/// Closes every hole of a surface by a lid, in the plane of its edge where that has one; holes of which the
/// edges lie in one plane share a lid, as those of a ring do. Appends their faces to `walls`. Returns nothing
/// where an edge branches or has no lid.
std::vector<Lid> put_lids(Mesh& walls);

}  // namespace bernal::cad
