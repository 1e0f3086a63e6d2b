#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal::cad {

/// A part that the file tells apart: the polygons from `first` up to those of the next one.
struct Solid {
  std::string name;  ///< may be empty
  std::size_t first = 0;
};

/// Polygons as a file lists them: nothing is welded, closed or oriented, every index is valid and every
/// coordinate is finite.
struct PolygonSoup {
  std::vector<Vector<3>> points;
  std::vector<std::vector<std::uint32_t>> polygons;
  std::vector<Solid> solids = {};  ///< in their order; none where the file tells no parts apart
};

/// Leaves the solids that are `kept`, one entry each, with their polygons.
void keep_solids(PolygonSoup&, const std::vector<bool>& kept);

/// How far the true surface lies from the triangles that stand for it, measured at points of each triangle.
struct SurfaceDeviation {
  double outside = 0;  ///< of the triangles, where they stand inside of the surface
  double inside = 0;
};

/// What the file says of its coordinates.
struct FileFacts {
  struct Length {
    double metres;     ///< one unit of the file's
    std::string name;  ///< as people call it: "inch"
  };
  std::optional<Length> unit = {};                 ///< of the coordinates as they are delivered
  std::optional<Length> written_in = {};           ///< the file's own unit, where the reader converts from it
  char up = 0;                                     ///< 'x', 'y' or 'z', where the file says which axis is up
  std::optional<SurfaceDeviation> deviation = {};  ///< of a tessellated surface, in `unit`
  std::optional<double> deflection = {};           ///< that it was tessellated with, in `unit`
  std::vector<std::string> notes = {};             ///< what else a user should know, one phrase each
};

/// What one reader made of a file: a soup, or why there is none. Coordinates are those of the file: neither
/// scaled to another unit nor turned.
struct ReadAttempt {
  PolygonSoup soup = {};
  std::string failure = {};  ///< one line; empty if the soup is good
  FileFacts facts = {};
  std::string reader = {};  ///< who read it, and in which precision: one phrase

  bool ok() const { return failure.empty(); }
};

/// 3MF: what its build places, from all parts of the package (core and production specification), in double
/// precision; of slicers' files what is a part. Materials and metadata are passed over. In a child process.
ReadAttempt read_3mf(const std::filesystem::path& file);

/// AMF (ISO/ASTM 52915), zipped or not, in double precision: what its constellations place, else its objects
/// as they stand, a solid a volume. Materials are passed over. In a child process.
ReadAttempt read_amf(const std::filesystem::path& file);

/// STL, text or binary, which may begin with the word "solid", so that the size decides first: 84 bytes and
/// 50 a triangle. Throws Error{bad_mesh} with the line (text) or the sizes (binary) where it is malformed or
/// truncated.
///
/// Text grammar, in any case, white space free: {"solid" [name] {"facet normal" 3 words "outer loop" 3 ×
/// ("vertex" 3 numbers) "endloop" "endfacet"} "endsolid" [name]}, names up to the end of their line. What
/// stands behind a normal, "loop", "endloop" or "endfacet" in the same line is passed over, which a note
/// says, and so are comments, from # or // at the start of a statement on.
///
/// A binary file may go on behind its last triangle, as long as no triangle would fit there exactly.
ReadAttempt read_stl(const std::filesystem::path& file);

/// OBJ: vertices and faces, a solid an object, or a group where there are no objects. All else is passed
/// over.
ReadAttempt read_obj(const std::filesystem::path& file);

/// OFF and PLY, through CGAL, in a child process, after a look at what CGAL takes on trust.
ReadAttempt read_with_cgal(const std::filesystem::path& file);

/// glTF, Collada, FBX: what assimp knows, transforms of nodes applied in double. Coordinates have been
/// through single precision. In a child process.
ReadAttempt read_with_assimp(const std::filesystem::path& file);

/// Whether the file holds surfaces and solids, not triangles: STEP, IGES, BREP.
bool opencascade_reads(const std::filesystem::path& file);

/// The surfaces of STEP, IGES and BREP as triangles that are at most `deflection` away from them; a
/// thousandth of the part's diagonal if that is not positive. STEP and IGES are converted to millimetres,
/// `deflection` is in these (a BREP has no unit). Solids stand where the assembly puts them; surfaces that
/// belong to no solid are sewn. In a child process.
ReadAttempt read_with_opencascade(const std::filesystem::path& file, double deflection);

}  // namespace bernal::cad
