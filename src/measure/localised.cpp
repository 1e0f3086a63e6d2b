#include "measure/localised.hpp"

#include "bernal/cad/mesh_container.hpp"

namespace bernal {

Spheres<3> localised(const Spheres<dynamic>& spheres, const Frame& frame) {
  Spheres<3> local;
  local.reserve(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    local.push_back(frame.to_local(spheres.center(i)), spheres.r[i] / frame.scale);
  }
  return local;
}

std::unique_ptr<Container> localised(const Shape& scene_shape, const Frame& frame) {
  return make_container(to_local(scene_shape, frame), WallArithmetic::plain, frame.resolution);
}

}  // namespace bernal
