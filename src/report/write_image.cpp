#include "report/write_image.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "files/seal.hpp"

namespace bernal {
namespace {

/// The names of a voxel's type.
struct VoxelType {
  std::string_view nrrd, vtk, array, numpy;
};

VoxelType type_of(VoxelValues values) {
  switch (values) {
    case VoxelValues::binary:
      return {"uint8", "UInt8", "phase", "|u1"};
    case VoxelValues::labels:
      return {"uint32", "UInt32", "FeatureIds", "<u4"};
    case VoxelValues::materials:
      return {"uint8", "UInt8", "material", "|u1"};
    case VoxelValues::layers:
      return {"uint8", "UInt8", "layer", "|u1"};
    case VoxelValues::fraction:
      break;
  }
  return {"float", "Float32", "solid_fraction", "<f4"};
}

std::uint64_t bytes_of(const VoxelImage& image) {
  return static_cast<std::uint64_t>(image.grid.voxels()) *
         static_cast<std::uint64_t>(bytes_per_voxel(image.values));
}

/// The first `count` entries of a row as text.
template <class Row>
std::string joined(const Row& row, int count, std::string_view between) {
  std::string text;
  for (int k = 0; k < count; ++k) text += fmt::format("{}{}", k == 0 ? "" : between, row[k]);
  return text;
}

Vector<3> first_center(const VoxelGrid& grid) {
  return {grid.center(0, 0), grid.center(1, 0), grid.center(2, 0)};
}

}  // namespace

std::string meaning_of(const VoxelImage& image) {
  if (!image.meaning.empty()) return image.meaning;
  switch (image.values) {
    case VoxelValues::binary:
      return "0 pore, 1 sphere, 2 outside the container";
    case VoxelValues::labels:
      return "0 pore, i + 1 sphere i (counted from 0), 4294967295 outside the container";
    case VoxelValues::materials:
    case VoxelValues::layers: {
      std::string text = "0 pore";
      for (std::size_t k = 0; k < image.names.size(); ++k)
        text += fmt::format(", {} {}", k + 1, image.names[k]);
      return text + ", 255 outside the container";
    }
    case VoxelValues::fraction:
      break;
  }
  return fmt::format("volume fraction of {}, 0 to 1", image.names.empty() ? "spheres" : image.names.front());
}

void write_nrrd(OutputFile& file, const VoxelImage& image, const Monitor& monitor) {
  const VoxelGrid& grid = image.grid;
  const int dimension = grid.dimension;
  std::string directions[3];
  for (int k = 0; k < dimension; ++k) {
    const Vector<3> step = grid.spacing[k] * Vector<3>::Unit(k);
    directions[k] = fmt::format("({})", joined(step, dimension, ","));
  }
  const std::string cells[] = {"cell", "cell", "cell"}, kinds[] = {"domain", "domain", "domain"},
                    quoted = fmt::format("\"{}\"", image.unit), units[] = {quoted, quoted, quoted};
  std::string header = fmt::format("NRRD0004\n# {}\ntype: {}\ndimension: {}\nspace dimension: {}\n",
                                   plain_text(image.title), type_of(image.values).nrrd, dimension, dimension);
  header += fmt::format("sizes: {}\nspace directions: {}\ncenters: {}\nkinds: {}\n",
                        joined(grid.count, dimension, " "), joined(directions, dimension, " "),
                        joined(cells, dimension, " "), joined(kinds, dimension, " "));
  if (bytes_per_voxel(image.values) > 1) header += "endian: little\n";
  header += fmt::format("encoding: raw\nspace origin: ({})\nspace units: {}\nvalues:={}\n\n",
                        joined(first_center(grid), dimension, ","), joined(units, dimension, " "),
                        meaning_of(image));
  file.append(header);
  write_raw(file, image, monitor);
}

void write_vti(OutputFile& file, const VoxelImage& image, const Monitor& monitor) {
  const VoxelGrid& grid = image.grid;
  const VoxelType type = type_of(image.values);
  const bool flat = grid.dimension == 2;
  const std::string extent =
      fmt::format("0 {} 0 {} 0 {}", grid.count[0], grid.count[1], flat ? 0 : grid.count[2]);
  Vector<3> corner = grid.corner;
  if (flat) corner[2] = 0;
  file.append(fmt::format(R"(<?xml version="1.0"?>
<!-- lengths in {0}; {1} -->
<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <ImageData WholeExtent="{2}" Origin="{3}" Spacing="{4}">
    <Piece Extent="{2}">
      <CellData Scalars="{5}">
        <DataArray type="{6}" Name="{5}" NumberOfComponents="1" format="appended" offset="0"/>
      </CellData>
    </Piece>
  </ImageData>
  <AppendedData encoding="raw">
_)",
                          image.unit, meaning_of(image), extent, joined(corner, 3, " "),
                          joined(grid.spacing, 3, " "), type.array, type.vtk));
  const std::uint64_t bytes = bytes_of(image);
  char length[sizeof bytes];
  std::memcpy(length, &bytes, sizeof bytes);
  file.append({length, sizeof length});
  write_raw(file, image, monitor);
  file.append("\n  </AppendedData>\n</VTKFile>\n");
}

void write_raw(OutputFile& file, const VoxelImage& image, const Monitor& monitor) {
  constexpr std::size_t piece = std::size_t{1} << 20;  // keeps the file's buffer small
  const TakeLayers take = [&](std::string_view layers) {
    for (std::size_t k = 0; k < layers.size(); k += piece) file.append(layers.substr(k, piece));
  };
  if (image.make)
    image.make(image.spheres, image.domain, image.grid, take, monitor);
  else
    voxelise(image.spheres, image.domain, image.grid, image.values, take, monitor, image.layers);
}

std::string raw_header(const VoxelImage& image) {
  const VoxelGrid& grid = image.grid;
  const int dimension = grid.dimension;
  std::array<std::int64_t, 3> shape;
  std::reverse_copy(grid.count.begin(), grid.count.begin() + dimension, shape.begin());
  std::string header = fmt::format(
      R"({{
  "dtype": "{}",
  "shape": [{}],
  "order": "x fastest, then y, then z",
  "sizes": [{}],
  "spacing": [{}],
  "corner": [{}],
  "origin": [{}],
  "unit": "{}",
  "values": "{}",
  "written": ")",
      type_of(image.values).numpy, joined(shape, dimension, ", "), joined(grid.count, dimension, ", "),
      joined(grid.spacing, dimension, ", "), joined(grid.corner, dimension, ", "),
      joined(first_center(grid), dimension, ", "), image.unit, meaning_of(image));
  return sealed(std::move(header), "", "\"\n}\n");
}

}  // namespace bernal
