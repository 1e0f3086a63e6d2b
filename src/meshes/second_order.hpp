#pragma once
#include <cstddef>

#include "meshes/volume_mesh.hpp"

namespace bernal {

/// Gives tetrahedra and triangles the middles of their edges. Those of edges on round surfaces of patches lie
/// on them: on spheres and layers, on necks, on round walls; where several surfaces meet, or one and a plane,
/// on all of them, such as on the circles in which necks begin. Edges within a layer that join two spheres
/// about one centre have theirs half way between these. At opposite ends of periods middles are equal, too.
///
/// Every tetrahedron is the image of a straight one without folds: the determinant of the map's derivative,
/// a polynomial of degree 3, is positive since its 20 coefficients in Bernstein's basis are (which bound it
/// from below; see Johnen, Remacle and Geuzaine, Geometrical validity of curvilinear finite elements, 2013).
/// Where one is not, or the SICN is below 0.12 for the curves' sake, the edges of that tetrahedron are
/// straight.
///
/// Returns how many edges lie on round surfaces, and how many of these stay straight for that reason. Cost:
/// some µs a tetrahedron, and 200 bytes. Precondition: not yet of second order.
struct CurvedEdges {
  std::size_t curved = 0, kept_straight = 0;
};
CurvedEdges make_second_order(VolumeMesh&);

/// The least of the 20 coefficients in Bernstein's basis of the determinant of the derivative of the map from
/// (0, x, y, z) with x + y + z ≤ 1: positive only if that is positive everywhere. Six volumes if straight.
double least_jacobian_coefficient(const VolumeMesh&, std::size_t tetrahedron);

/// The least SICN of the map from the regular tetrahedron to one with ten nodes, at corners, middles and
/// centroid.
double curved_sicn(const VolumeMesh&, std::size_t tetrahedron);
/// Over all. Precondition: of second order.
double least_curved_sicn(const VolumeMesh&);

/// Volumes of regions with curved edges: by quadrature that is exact for ten nodes.
std::vector<double> curved_volumes_of_regions(const VolumeMesh&);

}  // namespace bernal
