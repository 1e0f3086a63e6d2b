#pragma once
#include <filesystem>

#include "bernal/cad/mesh_report.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

struct ImportedMesh {
  Mesh mesh;  ///< welded, triangulated and, if usable, oriented outwards
  MeshReport report;
};

/// Reads any format that assimp knows and says what it is. Coordinates stay as in the file (node transforms
/// applied in double). Throws Error{bad_mesh} when the file is missing, cannot be parsed, holds no faces or
/// coordinates that are not finite; everything else is told in the report.
/// Cost: 5 to 10 µs a face, half of it diagnosis; quadratic in the number of faces that meet at one vertex.
ImportedMesh read_mesh(const std::filesystem::path& file);

/// The mesh as a container: `read_mesh`, times `factor` (from the file's unit to the scene's). Throws
/// Error{bad_mesh} with the report's problems in one line when it cannot be one.
ImportedMesh read_container_mesh(const std::filesystem::path& file, double factor);

}  // namespace bernal
