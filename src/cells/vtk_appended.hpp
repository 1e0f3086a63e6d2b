#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "files/output_file.hpp"
#include "formats/text_file.hpp"

namespace bernal {

/// Arrays as the raw appended data of an XML file of VTK's, each led by its length in bytes. Source: VTK File
/// Formats, docs.vtk.org.
class VtkAppended {
 public:
  /// Takes the array and returns its tag.
  template <class T>
  std::string tag(std::string_view type, std::string_view name, const std::vector<T>& values,
                  int components = 1) {
    const std::string made = fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        type, name, components, data_.size());
    const std::uint64_t bytes = values.size() * sizeof(T);
    data_ += bytes_of(std::span(&bytes, 1));
    data_ += bytes_of(std::span<const T>(values));
    return made;
  }
  /// The end of the file.
  void append_to(OutputFile& out) const {
    out.append("  <AppendedData encoding=\"raw\">\n_");
    out.append(data_);
    out.append("\n  </AppendedData>\n</VTKFile>\n");
  }

 private:
  std::string data_;
};

/// The beginning of a .vtu, up to its points.
inline std::string vtu_head(std::string_view title, std::string_view unit, std::size_t points,
                            std::size_t cells) {
  return fmt::format(R"(<?xml version="1.0"?>
<!-- {}; lengths in {} -->
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <UnstructuredGrid>
    <Piece NumberOfPoints="{}" NumberOfCells="{}">
      <Points>
)",
                     title, unit, points, cells);
}

}  // namespace bernal
