#include "measure/localised.hpp"

namespace bernal {

Spheres<3> localised(const Spheres<dynamic>& spheres, const Frame& frame) {
  Spheres<3> local;
  local.reserve(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    local.push_back(frame.to_local(spheres.center(i)), spheres.r[i] / frame.scale);
  }
  return local;
}

Boundary<3> localised(const Boundary<3>& boundary, const Frame& frame) {
  return {boundary.edges / frame.scale, frame.to_local(boundary.origin)};
}

}  // namespace bernal
