#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bernal/cad/mesh_report.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/domain/mesh_file.hpp"

namespace bernal {

struct ImportedMesh {
  Mesh mesh;  ///< welded, triangulated and, if usable, oriented outwards
  MeshReport report;
};

/// What the import of a file depends on beside its options.
struct ImportFor {
  std::optional<Unit> unit = {};  ///< of the coordinates that are made; the file's own if absent
  /// Of the spheres, in that unit: true surfaces are tessellated to within a fiftieth of it. 0: unknown.
  double smallest_radius = 0;
  /// Of processor time, for each of the repairs that the options ask for: one that takes longer is given up.
  double repair_seconds = 600;
};

/// What the options say is at odds with the file; `option` is the member's name, "unit" or "solids".
class OptionError : public Error {
 public:
  OptionError(std::string_view of, const std::string& message)
      : Error(ErrorCode::bad_mesh, message), option(of) {}
  std::string option;
};

/// Whether a file of that name is of a format that is read: STL, OBJ, PLY, OFF, 3MF, AMF, glTF, Collada, FBX,
/// STEP, IGES, BREP, by its extension in upper or lower case.
bool is_mesh_file_name(const std::filesystem::path& file);
/// {".stl", ".obj", …}
std::span<const std::string_view> mesh_file_endings();

/// Reads a file of any known format, does what the options ask for, and says what came of it. Throws
/// Error{bad_mesh} when the file is missing, cannot be parsed, holds no faces or coordinates that are not
/// finite, and OptionError where an option is at odds with it; everything else is told in the report.
/// Cost: 5 to 10 µs a face, half of it diagnosis; quadratic in the number of faces that meet at one vertex.
ImportedMesh read_mesh(const MeshFile& options, const ImportFor& purpose = {});

/// The same where it must be a container. Throws Error{bad_mesh} with the report's problems in one line, and
/// what to do about them, when it cannot be one.
ImportedMesh read_container_mesh(const MeshFile& options, const ImportFor& purpose);

enum class Effort {
  quick,    ///< what takes about as long as reading the file
  thorough  ///< also a wrap, tried coarsely
};

/// Lines for [container] that make a container of a file that is none as it is: each was tried. The first
/// changes least; none if nothing helps. Lengths in them are in the unit of `purpose`.
std::vector<std::string> lines_that_help(const MeshFile& options, const ImportFor& purpose,
                                         const ImportedMesh& as_it_is, Effort effort);

/// Writes a surface as PLY, its faces coloured by what keeps it from being a wall: orange at open edges, blue
/// at branching ones, red where it crosses itself, grey elsewhere. Throws Error{cannot_write}.
void write_places(const ImportedMesh& imported, const std::filesystem::path& file);

}  // namespace bernal
