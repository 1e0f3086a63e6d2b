#pragma once
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Spheres in the container's own frame, where rounding errors are smallest: far from the origin the scene's
/// coordinates lose the digits that distinguish a contact from a gap. The matching wall is
/// `make_local_container`'s.
inline Spheres<3> localised(const Spheres<dynamic>& spheres, const Frame& frame) {
  Spheres<3> local;
  local.reserve(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    Vector<3> center = Vector<3>::Zero();  // two dimensions lie in the plane z = 0
    center.head(spheres.dimension()) = spheres.center(i);
    local.push_back(frame.to_local(center), spheres.r[i] / frame.scale);
  }
  return local;
}

inline Boundary<3> localised(const Boundary<3>& boundary, const Frame& frame) {
  return {boundary.edges / frame.scale, frame.to_local(boundary.origin)};
}

}  // namespace bernal
