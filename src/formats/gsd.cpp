#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include "bernal/version.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

// The blocks of a GSD file of version 2.0, which is written, and of 1, which is read too: the header, the
// index, the names, then the data of every chunk. Source: "File layer" and "HOOMD schema" of
// https://gsd.readthedocs.io.
constexpr std::uint64_t gsd_magic = 0x65DF65DF65DF65DF, block_bytes = 64;

struct GsdHeader {
  std::uint64_t magic = gsd_magic;
  std::uint64_t index_location = 0, index_entries = 0;
  std::uint64_t names_location = 0, names_blocks = 0;  ///< blocks of 64 bytes
  std::uint32_t schema_version = 1 << 16 | 4;
  std::uint32_t file_version = 2 << 16;
  char application[64] = {};
  char schema[64] = "hoomd";
  char reserved[80] = {};
};
static_assert(sizeof(GsdHeader) == 256);

struct GsdEntry {
  std::uint64_t frame = 0, rows = 0;
  std::int64_t location = 0;
  std::uint32_t columns = 0;
  std::uint16_t id = 0;
  std::uint8_t type = 0, flags = 0;
};
static_assert(sizeof(GsdEntry) == 32);

enum ElementType : std::uint8_t { uint8 = 1, uint32 = 3, uint64 = 4, float32 = 9, float64 = 10 };

constexpr std::string_view box_chunk = "configuration/box", dimensions_chunk = "configuration/dimensions",
                           count_chunk = "particles/N", diameter_chunk = "particles/diameter",
                           position_chunk = "particles/position";

struct Chunk {
  std::string_view name;
  ElementType type;
  std::uint64_t rows;
  std::uint32_t columns;
  std::string data;
};

/// "1", "2", …: rows of the width of the longest name and its terminator.
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

/// The chunks of one frame, in the order of their names' numbers, as the index requires.
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
  const auto bytes = [](auto numbers) { return std::string(bytes_of(numbers)); };
  return {{"configuration/step", uint64, 1, 1, std::string(8, '\0')},
          {dimensions_chunk, uint8, 1, 1, std::string(1, flat ? '\2' : '\3')},
          {box_chunk, float32, 6, 1, bytes(std::span<const float>(box))},
          {count_chunk, uint32, 1, 1, bytes(std::span(&n, 1))},
          names_of_types(file.type_count),
          {"particles/typeid", uint32, n, 1, bytes(std::span<const std::uint32_t>(types))},
          {diameter_chunk, float32, n, 1, bytes(std::span<const float>(diameters))},
          {position_chunk, float32, n, 3, bytes(std::span<const float>(positions))}};
}

void write_gsd(const Exported& file, StagedFolder& staged) {
  std::vector<Chunk> chunks = chunks_of(file);
  std::erase_if(chunks, [](const Chunk& chunk) { return chunk.data.empty(); });  // if there are no spheres
  std::string names;
  for (const Chunk& chunk : chunks) names.append(chunk.name) += '\0';
  names.resize((names.size() / block_bytes + 1) * block_bytes);  // and the empty name that ends the list

  GsdHeader header;
  // There is no room for the commit.
  const std::string application = fmt::format("bernal {} (packings {}), lengths in {}", version(),
                                              packings_number(), name_of(file.unit()));
  std::memcpy(header.application, application.data(),
              std::min(application.size(), sizeof header.application - 1));
  header.index_location = sizeof header;
  header.index_entries = chunks.size() + 1;  // the last is empty and ends the list
  header.names_location = header.index_location + header.index_entries * sizeof(GsdEntry);
  header.names_blocks = names.size() / block_bytes;

  OutputFile out(staged.add(file.output.file.string()));
  append_bytes(out, header);
  std::uint64_t location = header.names_location + names.size();
  for (std::uint16_t id = 0; id < chunks.size(); ++id) {
    const Chunk& chunk = chunks[id];
    append_bytes(out, GsdEntry{.rows = chunk.rows,
                               .location = static_cast<std::int64_t>(location),
                               .columns = chunk.columns,
                               .id = id,
                               .type = chunk.type});
    location += chunk.data.size();
  }
  append_bytes(out, GsdEntry{});
  out.append(names);
  for (const Chunk& chunk : chunks) out.append(chunk.data);
  out.close();
}

constexpr double default_diameter = 1;  // of the schema
constexpr std::uint64_t most_frames = 1 << 30;

/// A file read by position; every position is checked against its length before anything is allocated.
class GsdFile {
 public:
  explicit GsdFile(const Reading& reading) : reading_(reading), in_(reading.file, std::ios::binary) {
    std::error_code problem;
    size_ = std::filesystem::file_size(reading.file, problem);
    if (!in_ || problem) fail("cannot be read; may its owner and its folder be read?");
    if (get<std::uint64_t>(0) != gsd_magic)
      fail("is no GSD file; name the one that HOOMD wrote, or give ‹format›");
    header_ = get<GsdHeader>(0);
    const std::uint32_t version = header_.file_version >> 16U;
    if (version != 1 && version != 2)
      fail(fmt::format("is a GSD file of version {}, and 1 and 2 are known; write it again with gsd.hoomd",
                       version));
    if (text_in(header_.schema) != "hoomd")
      fail("is a GSD file whose schema is not hoomd; write it with gsd.hoomd");
    read_names(version == 1);
    read_index();
  }

  std::string application() const { return text_in(header_.application); }
  int frames() const { return frames_; }

  /// The chunk of a frame, from 0, else of the first frame; null if neither has it.
  const GsdEntry* chunk(std::string_view name, int frame) const {
    const auto found = chunks_.find(name);
    if (found == chunks_.end()) return nullptr;
    for (const auto key : {static_cast<std::uint64_t>(frame), std::uint64_t{0}})
      if (const auto entry = found->second.find(key); entry != found->second.end()) return &entry->second;
    return nullptr;
  }
  /// Numbers of single or double precision, with this many columns a row.
  std::vector<double> numbers(const GsdEntry& entry, std::uint32_t columns, std::string_view name) {
    if (entry.columns != columns || (entry.type != float32 && entry.type != float64))
      fail(fmt::format("has no numbers of {} columns for {}; write it again with gsd.hoomd", columns, name));
    const auto at = static_cast<std::uint64_t>(entry.location);
    if (entry.rows > size_) fail(fmt::format("has more {} than bytes; was it changed?", name));
    const std::uint64_t count = entry.rows * columns;
    if (entry.type == float64) return many<double>(at, count, name);
    const std::vector<float> values = many<float>(at, count, name);
    return {values.begin(), values.end()};
  }

  template <class T>
  T get(std::int64_t at) {
    return many<T>(static_cast<std::uint64_t>(at), 1).front();
  }
  [[noreturn]] void fail(const std::string& why) const { reading_.fail(why); }

 private:
  template <class T>
  std::vector<T> many(std::uint64_t at, std::uint64_t count, std::string_view what = "what it says it has") {
    if (at > size_ || count > (size_ - at) / sizeof(T))
      fail(fmt::format("ends after {} bytes, in the middle of {}; was it cut off?", size_, what));
    std::vector<T> values(count);
    in_.seekg(static_cast<std::streamoff>(at));
    in_.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
    if (!in_) fail("cannot be read to its end; copy it again");
    return values;
  }
  static std::string text_in(const char (&bytes)[64]) { return {bytes, strnlen(bytes, sizeof bytes)}; }

  /// Names of version 1 have a block each; those of version 2 end with a zero, the list with an empty one.
  void read_names(bool have_blocks) {
    using Block = std::array<char, block_bytes>;
    const std::vector<Block> blocks =
        many<Block>(header_.names_location, header_.names_blocks, "the names of its parts");
    const std::string_view bytes(blocks.empty() ? nullptr : blocks.front().data(),
                                 blocks.size() * block_bytes);
    for (std::size_t from = 0; from < bytes.size() && bytes[from] != '\0';) {
      const std::size_t end = std::min(bytes.find('\0', from), bytes.size());
      names_.emplace_back(bytes.substr(from, end - from));
      from = have_blocks ? from + block_bytes : end + 1;
    }
  }
  void read_index() {
    std::uint64_t last = 0;
    for (const GsdEntry& entry : many<GsdEntry>(header_.index_location, header_.index_entries, "its index")) {
      if (entry.location == 0) break;
      if (entry.id >= names_.size() || entry.location < 0 || entry.frame >= most_frames)
        fail("has an index that does not fit its names; was it cut off or changed?");
      chunks_[names_[entry.id]][entry.frame] = entry;
      last = std::max(last, entry.frame);
    }
    frames_ = chunks_.empty() ? 0 : static_cast<int>(last) + 1;
  }

  const Reading& reading_;
  std::ifstream in_;
  std::uint64_t size_ = 0;
  GsdHeader header_;
  std::vector<std::string> names_;
  std::map<std::string, std::map<std::uint64_t, GsdEntry>, std::less<>> chunks_;
  int frames_ = 0;
};

FileBox box_of_frame(GsdFile& gsd, const Reading& reading, int frame, bool is_flat) {
  std::vector<double> six = {1, 1, 1, 0, 0, 0};  // the schema's default
  if (const GsdEntry* entry = gsd.chunk(box_chunk, frame)) {
    six = gsd.numbers(*entry, 1, box_chunk);
    if (six.size() != 6)
      gsd.fail("has no six numbers for its box; write Lx, Ly, Lz, xy, xz, yz with gsd.hoomd");
  }
  if (six[3] != 0 || (!is_flat && (six[4] != 0 || six[5] != 0))) refuse_skewed(reading);
  FileBox box = FileBox::of_three(AxisEnd::unsaid);
  for (std::size_t k = 0; k < 3; ++k) {
    box.upper[k] = 0.5 * six[k];
    box.lower[k] = -box.upper[k];
  }
  return box;
}

FileContents read_gsd(const Reading& reading) {
  GsdFile gsd(reading);
  if (gsd.frames() == 0)
    gsd.fail("there are no spheres in it; name a file, or a ‹frame›, that has particles");
  const int wanted = frame_of(reading, gsd.frames()), frame = wanted - 1;
  FileContents contents;
  take_unit_of_remark(gsd.application(), contents.unit, {reading.file.string()});
  if (const GsdEntry* entry = gsd.chunk(dimensions_chunk, frame)) {
    const int dimensions = entry->type != uint8 ? 0 : gsd.get<std::uint8_t>(entry->location);
    if (dimensions != 2 && dimensions != 3)
      gsd.fail("has neither two nor three dimensions; write 2 or 3 with gsd.hoomd");
    contents.is_flat = dimensions == 2;
  }
  contents.box = box_of_frame(gsd, reading, frame, contents.is_flat);

  std::uint64_t count = 0;
  if (const GsdEntry* entry = gsd.chunk(count_chunk, frame); entry && entry->type == uint32)
    count = gsd.get<std::uint32_t>(entry->location);
  const GsdEntry* position = gsd.chunk(position_chunk, frame);
  if (count == 0 || !position)
    gsd.fail("there are no spheres in it; name a file, or a ‹frame›, that has particles");
  const std::vector<double> centers = gsd.numbers(*position, 3, position_chunk);
  if (centers.size() != 3 * count)
    gsd.fail(
        fmt::format("says that it has {} particles, and has positions of {}; write it again with gsd.hoomd",
                    count, centers.size() / 3));
  contents.note = fmt::format("frame {} of {}", wanted, gsd.frames());
  NumberTable table;
  table.add(centers, 3, "position");
  SphereColumns columns{.x = {0, 1, 2}, .is_diameter = true, .names = table.names};
  std::vector<double> diameters;
  if (const GsdEntry* entry = gsd.chunk(diameter_chunk, frame)) {
    diameters = gsd.numbers(*entry, 1, diameter_chunk);
    if (diameters.size() != count)
      gsd.fail(
          fmt::format("says that it has {} particles, and has diameters of {}; write it again with gsd.hoomd",
                      count, diameters.size()));
  } else if (!reading.has_size()) {  // writers omit what equals the schema's default
    diameters.assign(count, default_diameter);
    contents.note += fmt::format(
        "; no diameters, which the schema takes for {} each: ‹diameter› says another", default_diameter);
  }
  if (!diameters.empty()) {
    table.add(diameters, 1, "diameter");
    columns.size = 3;
    columns.names.emplace_back("diameter");
  }
  contents.spheres = table.spheres(columns, count, "particle", 0, reading);
  return contents;
}

}  // namespace

Format gsd_format() {
  return {
      .name = "gsd",
      .writes = "GSD, HOOMD schema, for HOOMD-blue and OVITO: single precision, origin in the middle",
      .keys = {"unit", "types"},
      .file = "gsd.gsd",
      .least_dimension = 2,
      .sizes = "diameter",
      .repeated_mesh = true,
      .precision = Precision::as_float,
      .centred = true,
      .write = write_gsd,
      .reads =
          "GSD of the HOOMD schema: HOOMD-blue, OVITO; positions, diameters and the box, whose middle is the "
          "origin; the last frame",
      .unit_from = "\"lengths in mm\" in its header, or ‹unit›",
      .options = {"frame"},
      .recognises = [](const FileBeginning& file) { return file.begins("\xDF\x65\xDF\x65\xDF\x65\xDF\x65"); },
      .read = read_gsd};
}

}  // namespace bernal
