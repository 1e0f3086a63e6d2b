#include "result/write_vtp.hpp"

#include <bit>
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

/// The appended data of a file, each array led by its length in bytes; offsets count from the underscore. All
/// numbers have 64 bits.
class AppendedData {
 public:
  /// The tag of the next array.
  std::string tag(std::string_view type, std::string_view name, std::uint64_t rows,
                  std::uint64_t components = 1) {
    const std::string tag = fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        type, name, components, offset_);
    offset_ += sizeof(std::uint64_t) + 8 * components * rows;
    return tag;
  }

 private:
  std::uint64_t offset_ = 0;
};

std::string head_of(std::string_view about, std::string_view unit, std::size_t dimension) {
  return fmt::format(R"(<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <!-- {}{}dimension {} -->
)",
                     about, unit.empty() ? std::string() : fmt::format("lengths in {}; ", unit), dimension);
}

constexpr std::string_view appended_begin = "  <AppendedData encoding=\"raw\">\n_",
                           appended_end = "\n  </AppendedData>\n</VTKFile>\n";

template <class T>
void append_column(OutputFile& file, const std::vector<T>& column) {
  static_assert(sizeof(T) == 8);
  append_raw(file, std::uint64_t{8 * column.size()});
  for (const T value : column) append_raw(file, value);
}

/// first, first + step, …
void append_counted(OutputFile& file, std::uint64_t n, std::uint64_t first, std::uint64_t step = 1) {
  append_raw(file, 8 * n);
  for (std::uint64_t i = 0; i < n; ++i) append_raw(file, first + i * step);
}

/// The three components of a point or vector; missing ones are 0.
template <class Component>
void append_in_space(OutputFile& file, std::size_t dimension, const Component& component) {
  for (std::size_t k = 0; k < 3; ++k) append_raw(file, k < dimension ? component(k) : 0.0);
}

}  // namespace

void write_vtp(OutputFile& file, const Spheres<dynamic>& spheres, std::string_view unit,
               std::span<const std::uint32_t> coordination, std::span<const std::uint32_t> classes,
               const std::vector<NamedColumn>& more) {
  const std::uint64_t n = spheres.size();
  const std::size_t dimension = spheres.x.size();
  AppendedData data;
  std::string point_data = data.tag("Float64", "radius", n);
  point_data += data.tag("Int64", "id", n);
  if (!coordination.empty()) point_data += data.tag("Int64", "coordination", n);
  if (!classes.empty()) point_data += data.tag("Int64", "class", n);
  for (std::size_t k = 3; k < dimension; ++k) point_data += data.tag("Float64", fmt::format("x{}", k), n);
  for (const NamedColumn& column : more) point_data += data.tag("Float64", column.name, n);
  const std::string points = data.tag("Float64", "Points", n, 3);
  const std::string connectivity = data.tag("Int64", "connectivity", n),
                    offsets = data.tag("Int64", "offsets", n);
  file.append(head_of({}, unit, dimension));
  file.append(fmt::format(R"(  <PolyData>
    <Piece NumberOfPoints="{0}" NumberOfVerts="{0}" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">
      <PointData Scalars="radius">
{1}      </PointData>
      <Points>
{2}      </Points>
      <Verts>
{3}{4}      </Verts>
    </Piece>
  </PolyData>
)",
                          n, point_data, points, connectivity, offsets));
  file.append(appended_begin);
  append_column(file, spheres.r);
  append_counted(file, n, 0);
  for (const auto& numbers : {coordination, classes}) {
    if (numbers.empty()) continue;
    append_raw(file, 8 * n);
    for (const std::uint32_t number : numbers) append_raw(file, std::uint64_t{number});
  }
  for (std::size_t k = 3; k < dimension; ++k) append_column(file, spheres.x[k]);
  for (const NamedColumn& column : more) append_column(file, column.values);
  append_raw(file, 24 * n);
  for (std::size_t i = 0; i < n; ++i)
    append_in_space(file, dimension, [&](std::size_t k) { return spheres.x[k][i]; });
  append_counted(file, n, 0);
  append_counted(file, n, 1);
  file.append(appended_end);
}

void write_contacts_vtp(OutputFile& file, const ContactList& contacts, const Spheres<dynamic>& spheres,
                        std::string_view unit) {
  const std::uint64_t n = contacts.size();
  const std::size_t dimension = spheres.x.size();
  AppendedData data;
  std::string cell_data = data.tag("Int64", "i", n);
  cell_data += data.tag("Int64", "j", n);
  cell_data += data.tag("Float64", "gap", n);
  cell_data += data.tag("Float64", "normal", n, 3);
  const std::string points = data.tag("Float64", "Points", 2 * n, 3);
  const std::string connectivity = data.tag("Int64", "connectivity", 2 * n),
                    offsets = data.tag("Int64", "offsets", n);
  file.append(head_of(fmt::format("{}; ", contacts_in_vtp), unit, dimension));
  file.append(fmt::format(R"(  <PolyData>
    <Piece NumberOfPoints="{0}" NumberOfVerts="0" NumberOfLines="{1}" NumberOfStrips="0" NumberOfPolys="0">
      <CellData Scalars="gap">
{2}      </CellData>
      <Points>
{3}      </Points>
      <Lines>
{4}{5}      </Lines>
    </Piece>
  </PolyData>
)",
                          2 * n, n, cell_data, points, connectivity, offsets));
  file.append(appended_begin);
  append_column(file, contacts.i);
  append_column(file, contacts.j);
  append_column(file, contacts.gap);
  append_raw(file, 24 * n);
  for (std::size_t c = 0; c < n; ++c)
    append_in_space(file, dimension, [&](std::size_t k) { return contacts.normal[k][c]; });
  append_raw(file, 48 * n);
  for (std::size_t c = 0; c < n; ++c) {
    const auto i = static_cast<std::size_t>(contacts.i[c]);
    double length = spheres.r[i] + contacts.gap[c];
    if (contacts.j[c] != ContactList::wall) length += spheres.r[static_cast<std::size_t>(contacts.j[c])];
    for (const double away : {0.0, length})
      append_in_space(file, dimension,
                      [&](std::size_t k) { return spheres.x[k][i] + away * contacts.normal[k][c]; });
  }
  append_counted(file, 2 * n, 0);
  append_counted(file, n, 2, 2);
  file.append(appended_end);
}

}  // namespace bernal
