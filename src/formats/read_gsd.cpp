#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "formats/binary_file.hpp"
#include "formats/reader.hpp"
#include "formats/sphere_size.hpp"

namespace bernal {
namespace {

static_assert(std::endian::native == std::endian::little, "GSD is little-endian, and read as it lies");

// The file layer and the schema "hoomd" of https://gsd.readthedocs.io, versions 1 and 2.
constexpr std::uint64_t gsd_magic = 0x65DF65DF65DF65DF;
constexpr std::uint64_t entry_bytes = 32, block_bytes = 64, most_frames = 1 << 30;

struct GsdEntry {
  std::uint64_t frame, rows;
  std::int64_t location;
  std::uint32_t columns;
  std::uint16_t id;
  std::uint8_t type, flags;
};
static_assert(sizeof(GsdEntry) == entry_bytes);

constexpr double default_diameter = 1;  // of the schema
constexpr std::uint8_t as_uint8 = 1, as_uint32 = 3, as_float = 9, as_double = 10;

class GsdFile {
 public:
  explicit GsdFile(const std::filesystem::path& path) : file_(path) {
    if (file_.get<std::uint64_t>(0) != gsd_magic) file_.fail("is no GSD file");
    const auto version = file_.get<std::uint32_t>(44);
    if (version >> 16 != 1 && version >> 16 != 2)
      file_.fail(fmt::format("is a GSD file of version {}, and 1 and 2 are known", version >> 16));
    const auto schema = file_.get<std::array<char, 64>>(112);
    if (text_in(schema) != "hoomd")
      file_.fail("is a GSD file whose schema is not hoomd; write it with gsd.hoomd");
    application_ = text_in(file_.get<std::array<char, 64>>(48));
    read_names(version >> 16 == 1);
    read_index();
  }

  BinaryFile& file() { return file_; }
  const std::string& application() const { return application_; }
  int frames() const { return frames_; }

  /// Of a frame, from 0, or of the first where it says nothing; none where neither does.
  const GsdEntry* chunk(const std::string& name, int frame) const {
    const auto found = chunks_.find(name);
    if (found == chunks_.end()) return nullptr;
    for (const auto key : {static_cast<std::uint64_t>(frame), std::uint64_t{0}})
      if (const auto entry = found->second.find(key); entry != found->second.end()) return &entry->second;
    return nullptr;
  }
  /// Numbers of single or double precision, so many columns in each of its rows.
  std::vector<double> numbers(const GsdEntry& entry, std::uint32_t columns, const std::string& name) {
    if (entry.columns != columns || (entry.type != as_float && entry.type != as_double))
      file_.fail(fmt::format("has no numbers of {} columns for {}", columns, name));
    const auto at = static_cast<std::uint64_t>(entry.location);
    if (!file_.holds(at, entry.rows, columns * (entry.type == as_float ? 4U : 8U)))
      file_.fail(
          fmt::format("ends after {} bytes, in the middle of {}; was it cut off?", file_.size(), name));
    const std::uint64_t count = entry.rows * columns;
    if (entry.type == as_double) return file_.many<double>(at, count);
    const std::vector<float> values = file_.many<float>(at, count);
    return {values.begin(), values.end()};
  }

 private:
  static std::string text_in(const std::array<char, 64>& bytes) {
    return {bytes.data(),
            static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), '\0') - bytes.begin())};
  }

  /// Names of version 1 have a block each; of version 2 they end with a zero, the list with an empty one.
  void read_names(bool have_blocks) {
    const auto at = file_.get<std::uint64_t>(24), blocks = file_.get<std::uint64_t>(32);
    if (!file_.holds(at, blocks, block_bytes))
      file_.fail("ends before the names of its parts; was it cut off?");
    const std::vector<char> bytes = file_.many<char>(at, blocks * block_bytes);
    for (std::size_t from = 0; from < bytes.size() && bytes[from] != '\0';) {
      const auto end = static_cast<std::size_t>(
          std::find(bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.end(), '\0') - bytes.begin());
      names_.emplace_back(bytes.data() + from, end - from);
      from = have_blocks ? from + block_bytes : end + 1;
    }
  }
  void read_index() {
    const auto at = file_.get<std::uint64_t>(8), entries = file_.get<std::uint64_t>(16);
    if (!file_.holds(at, entries, entry_bytes)) file_.fail("ends before its index does; was it cut off?");
    std::uint64_t last = 0;
    for (const GsdEntry& entry : file_.many<GsdEntry>(at, entries)) {
      if (entry.location == 0) break;
      if (entry.id >= names_.size() || entry.location < 0 || entry.frame >= most_frames)
        file_.fail("has an index that does not fit its names; was it cut off or changed?");
      chunks_[names_[entry.id]][entry.frame] = entry;
      last = std::max(last, entry.frame);
    }
    frames_ = chunks_.empty() ? 0 : static_cast<int>(last) + 1;
  }

  BinaryFile file_;
  std::string application_;
  std::vector<std::string> names_;
  std::map<std::string, std::map<std::uint64_t, GsdEntry>> chunks_;
  int frames_ = 0;
};

FileBox box_of_frame(GsdFile& gsd, const Reading& reading, int frame, bool is_flat) {
  std::vector<double> six = {1, 1, 1, 0, 0, 0};  // of the schema, where nothing is said
  if (const GsdEntry* entry = gsd.chunk("configuration/box", frame)) {
    six = gsd.numbers(*entry, 1, "configuration/box");
    if (six.size() != 6) gsd.file().fail("has no six numbers for its box");
  }
  if (six[3] != 0 || (!is_flat && (six[4] != 0 || six[5] != 0))) refuse_skewed(reading.file, 0);
  FileBox box{{}, {}, std::vector<AxisEnd>(3, AxisEnd::unsaid)};
  for (std::size_t k = 0; k < 3; ++k) {
    box.lower.push_back(-0.5 * six[k]);
    box.upper.push_back(0.5 * six[k]);
  }
  return box;
}

FileContents read_gsd(const Reading& reading) {
  GsdFile gsd(reading.file);
  if (gsd.frames() == 0) gsd.file().fail("there are no spheres in it");
  const int wanted = frame_of(reading, gsd.frames()), frame = wanted - 1;
  FileContents contents;
  take_unit_of_remark(gsd.application(), contents.unit, {reading.file.string()});
  if (const GsdEntry* entry = gsd.chunk("configuration/dimensions", frame)) {
    const int dimensions = entry->type != as_uint8
                               ? 0
                               : gsd.file().get<std::uint8_t>(static_cast<std::uint64_t>(entry->location));
    if (dimensions != 2 && dimensions != 3) gsd.file().fail("has neither two nor three dimensions");
    contents.is_flat = dimensions == 2;
  }
  contents.box = box_of_frame(gsd, reading, frame, contents.is_flat);

  std::uint64_t count = 0;
  if (const GsdEntry* entry = gsd.chunk("particles/N", frame); entry && entry->type == as_uint32)
    count = gsd.file().get<std::uint32_t>(static_cast<std::uint64_t>(entry->location));
  const GsdEntry* position = gsd.chunk("particles/position", frame);
  if (count == 0 || !position) gsd.file().fail("there are no spheres in it");
  const std::vector<double> centers = gsd.numbers(*position, 3, "particles/position");
  if (centers.size() != 3 * count)
    gsd.file().fail(
        fmt::format("says that it has {} particles, and has positions of {}", count, centers.size() / 3));
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < count; ++i) {
      const double x = centers[3 * i + k];
      if (!(std::abs(x) <= farthest_place))
        gsd.file().fail(fmt::format("has no finite position for particle {}", i));
      contents.spheres.x[k].push_back(x);
    }
  contents.note = fmt::format("frame {} of {}", wanted, gsd.frames());
  const GsdEntry* diameter = gsd.chunk("particles/diameter", frame);
  if (!diameter) {  // writers leave out what equals the schema's default
    if (reading.options.diameter || reading.options.radius) return contents;
    contents.spheres.r.assign(count, 0.5 * default_diameter);
    contents.note += fmt::format(
        "; no diameters, which the schema takes for {} each: --diameter says another", default_diameter);
    return contents;
  }
  for (const double d : gsd.numbers(*diameter, 1, "particles/diameter")) {
    if (!is_size(d))
      gsd.file().fail(fmt::format("particle {}: {}", contents.spheres.r.size(), complaint_of_size(d, true)));
    contents.spheres.r.push_back(0.5 * d);
  }
  if (contents.spheres.r.size() != count)
    gsd.file().fail(fmt::format("says that it has {} particles, and has diameters of {}", count,
                                contents.spheres.r.size()));
  return contents;
}

}  // namespace

const PackingReader& gsd_reader() {
  static const PackingReader reader{
      .about = {"gsd",
                "GSD of the HOOMD schema: HOOMD-blue, OVITO; positions, diameters and the box, whose middle "
                "is the "
                "origin; the last frame",
                "\"lengths in mm\" in its header, or --unit",
                {"frame"}},
      .recognises = [](const FileBeginning& file) { return file.begins("\xDF\x65\xDF\x65\xDF\x65\xDF\x65"); },
      .read = read_gsd};
  return reader;
}

}  // namespace bernal
