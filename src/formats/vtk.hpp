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

/// A column of what a VTK file says of its points: so many numbers for each.
struct VtkArray {
  std::string name;
  std::uint64_t components = 1;
  std::vector<double> values = {};
};

/// The points of a VTK file with their data.
struct VtkPoints {
  std::vector<double> places = {};    ///< three for each
  std::vector<VtkArray> arrays = {};  ///< each as long as the points are many
  std::string kind = {};              ///< "PolyData"
  std::string remarks = {};           ///< for people, in which bernal says unit and dimension

  std::uint64_t size() const { return places.size() / 3; }
};

/// Of a word; what is too small for a double is 0, too large infinite. None where it is no number.
std::optional<double> number_in_text(std::string_view word);

/// What both formats say of points that are corners.
std::string complaint_of_faces(std::uint64_t count);
/// What both say of numbers of an unknown type.
std::string complaint_of_type(std::string_view type);
/// Whether a cell of VTK's kinds is a face or a solid.
inline bool is_face(double kind) { return kind > 4; }

/// The legacy format, versions 1 to 5, ASCII or binary, POLYDATA and UNSTRUCTURED_GRID. `text` is the whole
/// file. Throws Error{bad_packing} with the line for what is cut off, of another kind, or has faces: then the
/// points are corners and no centres. Source: VTK File Formats, docs.vtk.org.
VtkPoints read_vtk_legacy(std::string_view text, const std::filesystem::path& file);
/// The same of the XML format, .vtp and .vtu: ASCII, base64, appended data, in either order of bytes,
/// compressed by zlib or not.
VtkPoints read_vtk_xml(std::string_view text, const std::filesystem::path& file);

}  // namespace bernal
