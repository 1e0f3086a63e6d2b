#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "report/write_image.hpp"

namespace bernal {
namespace {

/// Numbers in TIFF or BigTIFF encoding.
class TiffBytes {
 public:
  explicit TiffBytes(bool big) : big_(big) {}

  std::uint64_t offset_bytes() const { return big_ ? 8 : 4; }
  /// Size of a directory with this many tags.
  std::uint64_t directory_bytes(std::uint64_t tags) const {
    return count_bytes() + tags * (4 + 2 * offset_bytes()) + offset_bytes();
  }

  void put(std::uint64_t value, std::uint64_t bytes) {
    for (std::uint64_t k = 0; k < bytes; ++k) out += static_cast<char>(value >> 8 * k & 0xFF);
  }
  void put_offset(std::uint64_t value) { put(value, offset_bytes()); }
  void put_count(std::uint64_t tags) { put(tags, count_bytes()); }
  /// A tag with its value, or the position of the value if it is too long.
  void put_tag(std::uint64_t number, std::uint64_t type, std::uint64_t count, std::uint64_t value) {
    put(number, 2);
    put(type, 2);
    put_offset(count);
    put_offset(value);
  }
  void pad_to(std::uint64_t size) { out.resize(size, '\0'); }

  std::string out;

 private:
  std::uint64_t count_bytes() const { return big_ ? 8 : 2; }
  bool big_;
};

/// The quotient of two 32-bit numbers nearest to a value, with the numerator in the first half of the 64
/// bits: the last convergent of its continued fraction that fits, or an intermediate fraction. Absent if it
/// is more than 1e-9 off: beyond 2^32, and below its inverse.
std::optional<std::uint64_t> rational(double value) {
  constexpr double most = 4294967295.0, enough = 1e-9;
  if (!(value > 0) || !std::isfinite(value)) return std::nullopt;
  double p0 = 0, q0 = 1, p = 1, q = 0, best_p = 0, best_q = 1, x = value;
  const auto try_part = [&](double part) {
    const double next_p = part * p + p0, next_q = part * q + q0;
    if (next_q > 0 && std::abs(next_p / next_q - value) < std::abs(best_p / best_q - value)) {
      best_p = next_p;
      best_q = next_q;
    }
    return std::pair(next_p, next_q);
  };
  for (;;) {
    double part = std::floor(x);
    const bool fits = part * p + p0 <= most && part * q + q0 <= most;
    if (!fits) part = std::floor(std::min(p > 0 ? (most - p0) / p : part, q > 0 ? (most - q0) / q : part));
    const auto [next_p, next_q] = try_part(part);
    if (!fits || x == part) break;
    p0 = std::exchange(p, next_p);
    q0 = std::exchange(q, next_q);
    x = 1 / (x - part);
  }
  if (!(best_p > 0) || std::abs(best_p / best_q - value) > enough * value) return std::nullopt;
  return static_cast<std::uint64_t>(best_p) | static_cast<std::uint64_t>(best_q) << 32;
}

/// Voxels per unit of length along x and y.
using Resolutions = std::array<std::optional<std::uint64_t>, 2>;
Resolutions resolutions_of(const VoxelGrid& grid) {
  return {rational(1 / grid.spacing[0]), rational(1 / grid.spacing[1])};
}

constexpr std::uint64_t multiple_of_16(std::uint64_t value) { return (value + 15) / 16 * 16; }

/// What ImageJ reads besides the tags: the distance of layers, the unit, and the display range.
std::string description_of(const VoxelImage& image) {
  const double white = image.values == VoxelValues::binary     ? 2
                       : image.values == VoxelValues::fraction ? 1
                       : image.values == VoxelValues::labels   ? static_cast<double>(image.spheres.size())
                                                               : static_cast<double>(image.names.size());
  const std::string scale = has_scale_in_tiff(image.grid)
                                ? fmt::format("unit={}\nspacing={}\n", image.unit, image.grid.spacing[2])
                                : fmt::format("voxels of {} x {} x {} {}\n", image.grid.spacing[0],
                                              image.grid.spacing[1], image.grid.spacing[2], image.unit);
  return fmt::format("ImageJ=1.53t\nimages={0}\nslices={0}\n{1}min=0\nmax={2}\n{3}; {4}\n",
                     image.grid.count[2], scale, white, plain_text(image.title), meaning_of(image));
}

}  // namespace

bool has_scale_in_tiff(const VoxelGrid& grid) {
  const Resolutions found = resolutions_of(grid);
  return found[0] && found[1];
}

void write_tiff_directories(OutputFile& file, const VoxelImage& image) {
  const VoxelGrid& grid = image.grid;
  const auto pages = static_cast<std::uint64_t>(grid.count[2]),
             width = static_cast<std::uint64_t>(grid.count[0]),
             height = static_cast<std::uint64_t>(grid.count[1]);
  const auto sample = static_cast<std::uint64_t>(bytes_per_voxel(image.values));
  const std::uint64_t page_bytes = width * height * sample;
  const Resolutions resolved = resolutions_of(grid);
  const bool has_scale = resolved[0] && resolved[1];
  const std::uint64_t tags = has_scale ? 15 : 13;
  constexpr std::uint64_t room_for_text = 4096;
  const std::string description = description_of(image);

  const bool big =
      pages * (page_bytes + TiffBytes(true).directory_bytes(tags)) + room_for_text >= std::uint64_t{1} << 32;
  TiffBytes head(big);
  head.out = big ? std::string("II\x2b\0\x08\0\0\0", 8) : std::string("II\x2a\0", 4);
  // The header ends with the position of the first directory; before that come values too long for its tags.
  const std::uint64_t resolutions = head.out.size() + head.offset_bytes(), text = resolutions + 16,
                      directories = multiple_of_16(text + description.size() + 1),
                      voxels = multiple_of_16(directories + pages * head.directory_bytes(tags));
  const std::uint64_t across[2] = {resolved[0].value_or(0), resolved[1].value_or(0)};
  head.put_offset(directories);
  for (const std::uint64_t value : across) head.put(value, 8);
  head.out += description;
  head.pad_to(directories);
  file.append(head.out);

  constexpr std::uint64_t ascii = 2, word = 3, dword = 4, quotient = 5;
  const std::uint64_t address = big ? 16 : dword;
  for (std::uint64_t page = 0; page < pages; ++page) {
    TiffBytes directory(big);
    directory.put_count(tags);
    directory.put_tag(254, dword, 1, pages > 1 ? 2 : 0);  // one page of several
    directory.put_tag(256, dword, 1, width);
    directory.put_tag(257, dword, 1, height);
    directory.put_tag(258, word, 1, 8 * sample);
    directory.put_tag(259, word, 1, 1);  // no compression
    directory.put_tag(262, word, 1, 1);  // 0 is black
    directory.put_tag(270, ascii, description.size() + 1, text);
    directory.put_tag(273, address, 1, voxels + page * page_bytes);
    directory.put_tag(277, word, 1, 1);  // one sample a pixel
    directory.put_tag(278, dword, 1, height);
    directory.put_tag(279, address, 1, page_bytes);
    if (has_scale) {
      directory.put_tag(282, quotient, 1, big ? across[0] : resolutions);
      directory.put_tag(283, quotient, 1, big ? across[1] : resolutions + 8);
    }
    directory.put_tag(296, word, 1, 1);  // no unit that TIFF can encode
    directory.put_tag(339, word, 1, image.values == VoxelValues::fraction ? 3 : 1);
    directory.put_offset(page + 1 < pages ? directories + (page + 1) * head.directory_bytes(tags) : 0);
    file.append(directory.out);
  }
  file.append(std::string(voxels - directories - pages * head.directory_bytes(tags), '\0'));
}

void write_tiff(OutputFile& file, const VoxelImage& image, const Monitor& monitor) {
  write_tiff_directories(file, image);
  write_raw(file, image, monitor);
}

}  // namespace bernal
