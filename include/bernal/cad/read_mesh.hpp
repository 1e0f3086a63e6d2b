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

/// What an import depends on besides its options.
struct ImportFor {
  std::optional<Unit> unit = {};  ///< of the returned coordinates; the file's own if absent
  /// Smallest sphere radius, in that unit; surfaces of CAD files are tessellated to within a fiftieth of it,
  /// or, where spheres are to lie inside of them, within less than a thousandth. 0: unknown.
  double smallest_radius = 0;
  /// Limit of processor time for each requested repair; a repair that takes longer is abandoned.
  double repair_seconds = 600;
};

/// An option contradicts the file. `option` is the member's name, "unit" or "solids".
class OptionError : public Error {
 public:
  OptionError(std::string_view of, const std::string& message)
      : Error(ErrorCode::bad_mesh, message), option(of) {}
  std::string option;
};

/// Whether the file name's extension, in either case, is that of a format that can be read: STL, OBJ, PLY,
/// OFF, 3MF, AMF, glTF, Collada, FBX, STEP, IGES, BREP.
bool is_mesh_file_name(const std::filesystem::path& file);
/// Whether it holds surfaces by their formulas, not triangles: STEP, IGES, BREP.
bool has_true_surface(const std::filesystem::path& file);
/// {".stl", ".obj", …}
std::span<const std::string_view> mesh_file_endings();

/// Reads a file of any known format, applies the options and reports what it found. Throws Error{bad_mesh} if
/// the file is missing, cannot be parsed, has no faces or has coordinates that are not finite; throws
/// OptionError if an option contradicts it. Everything else is in the report. Cost: 5 to 10 µs a face, half
/// of it for the diagnosis; quadratic in the number of faces at one vertex.
ImportedMesh read_mesh(const MeshFile& options, const ImportFor& purpose = {});

/// The same for a file that must be a container. Throws Error{bad_mesh} with the report's problems and their
/// remedies in one line if it cannot be one.
///
/// Of one that is to repeat itself along some axes the surface may be closed, with flat faces at both ends,
/// or open there; the faces of the ends become openings. The period is its extent. Rims of both ends must
/// have the same corners to within `weld`, or where nothing is said a millionth of the diagonal, and the
/// upper are moved onto the lower; coordinates along the axes are rounded by 2^-47 of the largest, so that
/// the period is exact. Throws OptionError of "periodic" where they have not, with the place and by how much.
ImportedMesh read_container_mesh(const MeshFile& options, const ImportFor& purpose);

/// The unit that a CAD file says of itself, as those of STEP, IGES, 3MF, AMF and glTF do. Throws
/// Error{bad_argument} where it says none, or one in which no scene can be, and as `read_mesh`. Cost: reads
/// the file.
Unit unit_of_mesh_file(const std::filesystem::path& file);

enum class Effort {
  quick,    ///< about as long as reading the file takes
  thorough  ///< also tries a coarse wrap
};

/// Lines for [container] that turn a file that is no container into one, the line that changes least first;
/// of a file that is one, lines for what may be meant instead: its hollow, each of its solids. Each was tried
/// as it stands (with a line break: both lines together); empty if nothing helps. Lengths are in the unit of
/// `purpose`.
std::vector<std::string> lines_that_help(const MeshFile& options, const ImportFor& purpose,
                                         const ImportedMesh& as_it_is, Effort effort);

/// Writes the surface as PLY with defects in colour: orange at open edges, blue at edges with more than two
/// faces, red at self-intersections, grey elsewhere. Throws Error{cannot_write}.
void write_places(const ImportedMesh& imported, const std::filesystem::path& file);

}  // namespace bernal
