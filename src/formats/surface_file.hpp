#pragma once
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

#include "formats/format.hpp"
#include "io/output_file.hpp"
#include "surfaces/surfaces.hpp"

namespace bernal {

static_assert(std::endian::native == std::endian::little,
              "binary files are written as numbers lie in memory");

/// The triangles that a file is to hold. The file outlives them.
Surfaces surfaces_of(const Exported& file);

/// An entry with the keys of all formats of triangles, and those besides.
Format surface_format(std::string_view name, std::string_view help, std::string_view file,
                      std::string (*write)(const Exported&, StagedFolder&),
                      const std::vector<std::string_view>& keys = {});

/// All triangles as one binary STL file. Source: Marshall Burns, Automated Fabrication (1993), section 6.5.
void write_stl(OutputFile& out, const Exported& file, const Surfaces& surfaces);

/// Numbers into a file as they lie in memory.
template <class T>
void append_bytes(OutputFile& out, const T& value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append({bytes, sizeof bytes});
}
template <class T>
void append_bytes(OutputFile& out, std::span<const T> values) {
  out.append({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
}

}  // namespace bernal
