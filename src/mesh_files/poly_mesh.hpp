#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh_files/mesh_file.hpp"

namespace bernal {

/// A mesh by its faces, as OpenFOAM has it: inner faces first, in upper-triangular order: by their owner, the
/// cell of smaller number, which their normals point out of, and for one owner by the neighbour. Then those
/// of each patch; the k-th faces of both ends of a period are images, with corners in opposite turns from the
/// same first one. Source: OpenFOAM User Guide, 4.1 "Mesh description".
struct PolyMesh {
  struct Patch {
    std::string name, type;                    ///< "wall", "patch" or "cyclic"
    std::string neighbour = {};                ///< of cyclic ones
    Vector<3> separation = Vector<3>::Zero();  ///< of cyclic ones, from here to the neighbour
    std::size_t first = 0, count = 0;
  };
  std::vector<FaceCorners> faces;
  std::vector<std::uint32_t> owner;      ///< of every face
  std::vector<std::uint32_t> neighbour;  ///< of every inner face
  std::vector<Patch> patches;

  /// The inner face that two cells share. Precondition: there is one. Cost: O(log F).
  std::size_t face_between(std::uint32_t cell, std::uint32_t other) const;
};

/// Patches are surfaces that bound the mesh; what lies between two regions are inner faces. Cost: about 1 µs
/// and 60 bytes a tetrahedron. Throws Error{bad_mesh} where triangles of opposite ends are no images.
PolyMesh poly_mesh_of(const VolumeMesh&, const MeshGroups&);

}  // namespace bernal
