#include "io/write_vtp.hpp"

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

void write_vtp(OutputFile& file, const Spheres<dynamic>& spheres) {
  const std::uint64_t n = spheres.size();
  // Each array of the appended data is led by its length in bytes; offsets count from the underscore.
  const std::uint64_t column = sizeof(std::uint64_t) + 8 * n;
  const std::uint64_t radius = 0, id = column, points = 2 * column, connectivity = points + column + 16 * n,
                      offsets = connectivity + column;
  file.append(fmt::format(R"(<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <PolyData>
    <Piece NumberOfPoints="{0}" NumberOfVerts="{0}" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">
      <PointData Scalars="radius">
        <DataArray type="Float64" Name="radius" format="appended" offset="{1}"/>
        <DataArray type="Int64" Name="id" format="appended" offset="{2}"/>
      </PointData>
      <Points>
        <DataArray type="Float64" Name="Points" NumberOfComponents="3" format="appended" offset="{3}"/>
      </Points>
      <Verts>
        <DataArray type="Int64" Name="connectivity" format="appended" offset="{4}"/>
        <DataArray type="Int64" Name="offsets" format="appended" offset="{5}"/>
      </Verts>
    </Piece>
  </PolyData>
  <AppendedData encoding="raw">
_)",
                          n, radius, id, points, connectivity, offsets));

  append_raw(file, 8 * n);
  for (const double r : spheres.r) append_raw(file, r);
  append_raw(file, 8 * n);
  for (std::uint64_t i = 0; i < n; ++i) append_raw(file, i);
  append_raw(file, 24 * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) append_raw(file, k < spheres.x.size() ? spheres.x[k][i] : 0.0);
  }
  append_raw(file, 8 * n);
  for (std::uint64_t i = 0; i < n; ++i) append_raw(file, i);
  append_raw(file, 8 * n);
  for (std::uint64_t i = 1; i <= n; ++i) append_raw(file, i);

  file.append("\n  </AppendedData>\n</VTKFile>\n");
}

}  // namespace bernal
