#include "result/write_vtp.hpp"

#include <bit>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

namespace bernal {
namespace {

static_assert(std::endian::native == std::endian::little, "the raw data below are written as they lie");

template <class T>
void append_raw(OutputFile& file, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  file.append({bytes, sizeof bytes});
}

}  // namespace

void write_vtp(OutputFile& file, const Spheres<dynamic>& spheres, std::string_view unit) {
  const std::uint64_t n = spheres.size();
  // Each array of the appended data is led by its length in bytes; offsets count from the underscore.
  std::uint64_t offset = 0;
  const auto data_array = [&](std::string_view type, std::string_view name, std::uint64_t components = 1) {
    const std::string tag = fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        type, name, components, offset);
    offset += sizeof(std::uint64_t) + 8 * components * n;
    return tag;
  };
  const std::size_t dimension = spheres.x.size();
  std::string point_data = data_array("Float64", "radius");
  point_data += data_array("Int64", "id");
  for (std::size_t k = 3; k < dimension; ++k) point_data += data_array("Float64", fmt::format("x{}", k));
  const std::string points = data_array("Float64", "Points", 3);
  const std::string connectivity = data_array("Int64", "connectivity"),
                    offsets = data_array("Int64", "offsets");
  file.append(fmt::format(R"(<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <!-- {5}dimension {6} -->
  <PolyData>
    <Piece NumberOfPoints="{0}" NumberOfVerts="{0}" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">
      <PointData Scalars="radius">
{1}      </PointData>
      <Points>
{2}      </Points>
      <Verts>
{3}{4}      </Verts>
    </Piece>
  </PolyData>
  <AppendedData encoding="raw">
_)",
                          n, point_data, points, connectivity, offsets,
                          unit.empty() ? std::string() : fmt::format("lengths in {}; ", unit), dimension));

  const auto append_column = [&](const std::vector<double>& column) {
    append_raw(file, 8 * n);
    for (const double value : column) append_raw(file, value);
  };
  const auto append_counted_from = [&](std::uint64_t first) {
    append_raw(file, 8 * n);
    for (std::uint64_t i = first; i < first + n; ++i) append_raw(file, i);
  };
  append_column(spheres.r);
  append_counted_from(0);
  for (std::size_t k = 3; k < dimension; ++k) append_column(spheres.x[k]);
  append_raw(file, 24 * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < 3; ++k) append_raw(file, k < dimension ? spheres.x[k][i] : 0.0);
  append_counted_from(0);
  append_counted_from(1);

  file.append("\n  </AppendedData>\n</VTKFile>\n");
}

}  // namespace bernal
