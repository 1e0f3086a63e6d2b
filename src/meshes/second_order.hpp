#pragma once
#include <cstddef>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {

/// Gives tetrahedra and triangles the middles of their edges. Those of edges on spheres lie on the true
/// spheres: of the given radii and centres, or the image that is nearest; where a sphere meets a plane, on
/// the circle in which they meet. Those on the side of a cylinder lie on it. Rims of necks stay straight.
/// Where a tetrahedron would be turned inside out at a corner, a middle or its centroid, its edges stay
/// straight. Returns how many edges lie on spheres, and how many of these stay straight for that reason.
///
/// Cost: some µs a tetrahedron, and 200 bytes. Precondition: not yet of second order.
struct CurvedEdges {
  std::size_t curved = 0, kept_straight = 0;
};
CurvedEdges make_second_order(VolumeMesh&, const Spheres<dynamic>&, const Domain&);

/// The least SICN of the map from the regular tetrahedron to one with ten nodes, at corners, middles and
/// centroid.
double curved_sicn(const VolumeMesh&, std::size_t tetrahedron);
/// Over all. Precondition: of second order.
double least_curved_sicn(const VolumeMesh&);

/// Volumes of regions with curved edges: by quadrature that is exact for ten nodes.
std::vector<double> curved_volumes_of_regions(const VolumeMesh&);

}  // namespace bernal
