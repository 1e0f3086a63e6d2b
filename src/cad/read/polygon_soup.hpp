#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bernal/core/vector.hpp"
#include "bernal/geometry/true_surface.hpp"

namespace bernal::cad {

/// A named part of a file: the polygons from `first` to the start of the next part.
struct Solid {
  std::string name;  ///< may be empty
  std::size_t first = 0;
};

/// Polygons as in the file: not welded, closed or oriented; every index is valid and every coordinate finite.
struct PolygonSoup {
  std::vector<Vector<3>> points;
  std::vector<std::vector<std::uint32_t>> polygons;
  std::vector<Solid> solids = {};  ///< in their order; empty if the file names no parts
};

/// Removes all solids with a false entry in `kept`, and their polygons.
void keep_solids(PolygonSoup&, const std::vector<bool>& kept);

/// Distance of the true surface from the triangles that approximate it, measured at points of each triangle.
struct SurfaceDeviation {
  double outside = 0;  ///< beyond the triangles' outer side
  double inside = 0;
};

/// What the file says about its coordinates.
struct FileFacts {
  struct Length {
    double metres;     ///< one unit of the file in metres
    std::string name;  ///< in common use: "inch"
  };
  std::optional<Length> unit = {};                 ///< of the coordinates in the soup
  std::optional<Length> written_in = {};           ///< the file's own unit, if the reader converts from it
  char up = 0;                                     ///< the upward axis 'x', 'y' or 'z', if the file names it
  std::optional<SurfaceDeviation> deviation = {};  ///< of a tessellated surface, in `unit`
  std::optional<double> deflection = {};           ///< deflection of the tessellation, in `unit`
  std::vector<std::string> notes = {};             ///< what else a user should know, one phrase each
};

/// What is to lie inside of a surface itself, in units of the coordinates.
struct SpheresInside {
  double smallest_radius = 0;  ///< 0: unknown
};

/// The result of a reader: a soup, or the reason for its failure. Coordinates are those of the file: neither
/// scaled to another unit nor turned.
struct ReadAttempt {
  PolygonSoup soup = {};
  std::string failure = {};  ///< one line; empty if the soup is good
  FileFacts facts = {};
  /// The option of the scene that the failure is about, if it is about one.
  std::string failed_option = {};
  TrueSurface surface = {};  ///< with the triangles of the soup as `flats`, where it was asked for
  std::string reader = {};   ///< name of the reader and its precision, one phrase

  bool ok() const { return failure.empty(); }
};

/// 3MF: the build items of all parts of the package (core and production specification), in double precision,
/// without the modifiers of slicers. Materials and metadata are ignored. In a child process.
ReadAttempt read_3mf(const std::filesystem::path& file);

/// AMF (ISO/ASTM 52915), zipped or not, in double precision: what its constellations place, else all objects,
/// one solid a volume. Materials are ignored. In a child process.
ReadAttempt read_amf(const std::filesystem::path& file);

/// STL, text or binary. A binary file may begin with the word "solid", so the size is tested first: 84 bytes
/// and 50 a triangle. Throws Error{bad_mesh} with the line (text) or the sizes (binary) if it is malformed or
/// truncated.
///
/// Text grammar, in any case, white space free: {"solid" [name] {"facet normal" 3 words "outer loop" 3 ×
/// ("vertex" 3 numbers) "endloop" "endfacet"} "endsolid" [name]}, names up to the end of their line. Anything
/// after a normal, "loop", "endloop" or "endfacet" on the same line is ignored with a note; so are comments,
/// from # or // at the start of a statement.
///
/// A binary file may continue after its last triangle, as long as the rest is not exactly some triangles.
ReadAttempt read_stl(const std::filesystem::path& file);

/// OBJ: vertices and faces, one solid an object, or a group if there are no objects. Everything else is
/// ignored.
ReadAttempt read_obj(const std::filesystem::path& file);

/// OFF and PLY, through CGAL, in a child process, after checks that CGAL does not make.
ReadAttempt read_with_cgal(const std::filesystem::path& file);

/// glTF, Collada, FBX, through assimp, with the transforms of nodes applied in double. Coordinates are single
/// precision. In a child process.
ReadAttempt read_with_assimp(const std::filesystem::path& file);

/// Whether the file holds surfaces and solids rather than triangles: STEP, IGES, BREP.
bool opencascade_reads(const std::filesystem::path& file);

/// The surfaces of STEP, IGES and BREP as triangles at most `deflection` away from them; a thousandth of the
/// part's diagonal if that is not positive. STEP and IGES are converted to millimetres, and `deflection` is
/// in these (a BREP has no unit). Solids are placed by the assembly; surfaces outside solids are sewn. In a
/// child process. With `inside` the formulas of the faces come with them, a deflection that is too fine for
/// the mesher is made larger, and edges and corners that are known to less than the smallest radius only are
/// refused before anything is made of them.
ReadAttempt read_with_opencascade(const std::filesystem::path& file, double deflection,
                                  const std::optional<SpheresInside>& inside = {});

}  // namespace bernal::cad
