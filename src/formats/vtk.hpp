#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/raw_numbers.hpp"

namespace bernal {

inline constexpr std::string_view vtk_blanks = " \t\r\n";

/// A data array of the points in a VTK file, with `components` numbers for each.
struct VtkArray {
  std::string name;
  std::uint64_t components = 1;
  std::vector<double> values = {};
};

/// The points of a VTK file with their data.
struct VtkPoints {
  std::vector<double> places = {};    ///< three for each point
  std::vector<VtkArray> arrays = {};  ///< one entry for each point
  std::string kind = {};              ///< "PolyData"
  std::string remarks = {};           ///< free text, in which bernal states unit and dimension

  std::uint64_t size() const { return places.size() / 3; }
};

/// A word as a number; underflow gives 0, overflow infinity. Absent if it is no number.
std::optional<double> number_in_text(std::string_view word);

/// The error of both formats for points that are corners.
std::string faces_error(std::uint64_t count);
/// The error of both formats for numbers of an unknown type.
std::string type_error(std::string_view type);
/// Whether a VTK cell type is a face or a solid.
inline bool is_face(double kind) { return kind > 4; }

/// Reads the legacy format, versions 1 to 5, ASCII or binary, POLYDATA and UNSTRUCTURED_GRID. `text` is the
/// whole file. Throws Error{bad_packing} with the line if it is truncated, of another kind, or has faces
/// (then the points are corners, not centres). Source: VTK File Formats, docs.vtk.org.
VtkPoints read_vtk_legacy(std::string_view text, const std::filesystem::path& file);
/// The same for the XML format, .vtp and .vtu: ASCII, base64, appended data, in either byte order, with or
/// without zlib compression.
VtkPoints read_vtk_xml(std::string_view text, const std::filesystem::path& file);

}  // namespace bernal
