#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "meshes/volume_mesh.hpp"

namespace bernal {

/// The signed inverse condition number of a tetrahedron, as Gmsh has it: 3 / (|A| |A⁻¹|) in the norm of
/// Frobenius, of the linear map A that takes a regular tetrahedron to this one, negative where that turns it
/// inside out. Equal to 18 V / √(Σ l² Σ S²) over the six edges l and the areas S of the four faces: 1 for the
/// regular one, 0 for a flat one.
double sicn(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c, const Vector<3>& d);

/// The angles between faces, in degrees, at the edges of `edges_of_tetrahedron`.
std::array<double, 6> dihedral_angles(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c,
                                      const Vector<3>& d);

struct MeshQuality {
  /// One of the worst tetrahedra.
  struct Place {
    double sicn = 1;
    std::size_t tetrahedron = 0;
    Vector<3> center = Vector<3>::Zero();  ///< mean of its corners
  };
  double least_sicn = 1, mean_sicn = 0;
  double least_angle = 180, largest_angle = 0;  ///< dihedral, in degrees
  std::array<std::size_t, 10>
      histogram{};           ///< of the SICN, by tenths from 0; what is negative is in the first
  std::vector<Place> worst;  ///< up to ten, the worst first
};
/// Cost: some 100 ns a tetrahedron. Of edges that are straight.
MeshQuality quality_of(const VolumeMesh&);

}  // namespace bernal
