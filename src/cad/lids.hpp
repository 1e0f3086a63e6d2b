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

/// Closes every hole of a surface by a lid, in the plane of its edge where that has one; holes of which the
/// edges lie in one plane share a lid, as those of a ring do. Appends the faces of the lids to `walls` and
/// the middles of their edges to `middles`. Returns the bounds of each lid; nothing where an edge branches or
/// has no lid.
std::vector<LidBox> put_lids(Mesh& walls, std::vector<Vector<3>>& middles);

}  // namespace bernal::cad
