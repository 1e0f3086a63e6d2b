#include "measure/convex.hpp"

#include "geometry/measures.hpp"
#include "geometry/topology.hpp"

namespace bernal {

bool is_convex(const Mesh& mesh) {
  constexpr double rounding = 1e-12;
  const double size = bounds_of(mesh).size().maxCoeff();
  const MeshTopology topology = topology_of(mesh);
  if (topology.components != 1) return false;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector<3> normal = doubled_area(mesh, mesh.triangles[t]), &on = mesh.vertices[mesh.triangles[t][0]];
    for (const std::uint32_t beside : topology.neighbor[t])
      for (const std::uint32_t v : mesh.triangles[beside])
        if (normal.dot(mesh.vertices[v] - on) > rounding * size * normal.norm()) return false;
  }
  return true;
}

}  // namespace bernal
