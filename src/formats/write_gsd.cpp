#include <bit>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "bernal/version.hpp"
#include "formats/format.hpp"
#include "io/output_file.hpp"

namespace bernal {
namespace {

static_assert(std::endian::native == std::endian::little, "GSD is little-endian, and written as it lies");

// The blocks of a GSD file of version 2.0: the header, the index, the names, then the data of every chunk.
// Source: "File layer" and "HOOMD schema" of https://gsd.readthedocs.io.
struct Header {
  std::uint64_t magic = 0x65DF65DF65DF65DF;
  std::uint64_t index_location = 0, index_entries = 0;
  std::uint64_t names_location = 0, names_blocks = 0;  ///< blocks of 64 bytes
  std::uint32_t schema_version = 1 << 16 | 4;
  std::uint32_t file_version = 2 << 16;
  char application[64] = {};
  char schema[64] = "hoomd";
  char reserved[80] = {};
};
static_assert(sizeof(Header) == 256);

struct IndexEntry {
  std::uint64_t frame = 0, rows = 0;
  std::int64_t location = 0;
  std::uint32_t columns = 0;
  std::uint16_t id = 0;
  std::uint8_t type = 0, flags = 0;
};
static_assert(sizeof(IndexEntry) == 32);

enum ElementType : std::uint8_t { uint8 = 1, uint32 = 3, uint64 = 4, float32 = 9 };

template <class T>
std::string bytes_of(const T* values, std::size_t count) {
  std::string bytes(count * sizeof(T), '\0');
  if (count > 0) std::memcpy(bytes.data(), values, bytes.size());
  return bytes;
}
template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return bytes_of(values.data(), values.size());
}
template <class T>
std::string bytes_of(const T& value) {
  return bytes_of(&value, 1);
}

struct Chunk {
  std::string name;
  ElementType type;
  std::uint64_t rows;
  std::uint32_t columns;
  std::string data;
};

/// "1", "2", …: rows as wide as the longest name and its end.
Chunk names_of_types(std::uint32_t count) {
  const auto width = static_cast<std::uint32_t>(std::to_string(count).size() + 1);
  std::string data;
  for (std::uint32_t type = 1; type <= count; ++type) {
    std::string name = std::to_string(type);
    name.resize(width);
    data += name;
  }
  return {"particles/types", uint8, count, width, data};
}

/// One frame, its chunks in the order of their names' numbers, as the index needs it.
std::vector<Chunk> chunks_of(const Exported& file) {
  const auto n = static_cast<std::uint32_t>(file.size());
  const bool flat = file.dimension() == 2;
  const Vector<3> size = file.box().size();
  const float box[] = {static_cast<float>(size[0]),
                       static_cast<float>(size[1]),
                       flat ? 0.0F : static_cast<float>(size[2]),
                       0,
                       0,
                       0};
  std::vector<float> positions, diameters;
  positions.reserve(3 * file.size());
  diameters.reserve(file.size());
  std::vector<std::uint32_t> types;
  types.reserve(file.size());
  for (std::size_t i = 0; i < file.size(); ++i) {
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(file.coordinate(k, i)));
    diameters.push_back(static_cast<float>(2 * file.spheres.r[i]));
    types.push_back(file.types[i] - 1);
  }
  return {{"configuration/step", uint64, 1, 1, bytes_of(std::uint64_t{0})},
          {"configuration/dimensions", uint8, 1, 1, bytes_of(static_cast<std::uint8_t>(flat ? 2 : 3))},
          {"configuration/box", float32, 6, 1, bytes_of(box, 6)},
          {"particles/N", uint32, 1, 1, bytes_of(n)},
          names_of_types(file.type_count),
          {"particles/typeid", uint32, n, 1, bytes_of(types)},
          {"particles/diameter", float32, n, 1, bytes_of(diameters)},
          {"particles/position", float32, n, 3, bytes_of(positions)}};
}

void write_gsd(const Exported& file, StagedFolder& staged) {
  std::vector<Chunk> chunks = chunks_of(file);
  std::erase_if(chunks, [](const Chunk& chunk) { return chunk.data.empty(); });  // of no sphere
  constexpr std::size_t block = 64;
  std::string names;
  for (const Chunk& chunk : chunks) names += chunk.name + '\0';
  names.resize((names.size() / block + 1) * block);  // and the empty name that ends the list

  Header header;
  const std::string application = fmt::format("bernal {}, lengths in {}", version(), name_of(file.unit()));
  std::memcpy(header.application, application.data(),
              std::min(application.size(), sizeof header.application - 1));
  header.index_location = sizeof header;
  header.index_entries = chunks.size() + 1;  // the last is empty and ends the list
  header.names_location = header.index_location + header.index_entries * sizeof(IndexEntry);
  header.names_blocks = names.size() / block;

  OutputFile out(staged.add(file.output.file.string()));
  out.append(bytes_of(header));
  std::uint64_t location = header.names_location + names.size();
  for (std::uint16_t id = 0; id < chunks.size(); ++id) {
    const Chunk& chunk = chunks[id];
    out.append(bytes_of(IndexEntry{.rows = chunk.rows,
                                   .location = static_cast<std::int64_t>(location),
                                   .columns = chunk.columns,
                                   .id = id,
                                   .type = chunk.type}));
    location += chunk.data.size();
  }
  out.append(bytes_of(IndexEntry{}));
  out.append(names);
  for (const Chunk& chunk : chunks) out.append(chunk.data);
  out.close();
}

}  // namespace

const Format& gsd_format() {
  static const Format format{
      .table = {.keys = output_entry(
                    "gsd",
                    "GSD, HOOMD schema, for HOOMD-blue and OVITO: single precision, origin in the middle",
                    {"unit", "types"}),
                .file = "gsd.gsd",
                .least_dimension = 2,
                .sizes = "diameter"},
      .precision = Precision::as_float,
      .centred = true,
      .write = write_gsd};
  return format;
}

}  // namespace bernal
