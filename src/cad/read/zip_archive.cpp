#include "cad/read/zip_archive.hpp"

#include <fmt/format.h>
#include <minizip/unzip.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "bernal/core/error.hpp"
#include "core/lower_case.hpp"

namespace bernal::cad {
namespace {

constexpr std::size_t most_entries = 10'000;
/// Deflate's largest ratio is 1,032.
constexpr std::uint64_t most_of_a_byte = 1032, some_bytes = 64;
constexpr std::uint64_t most_unpacked = std::uint64_t{4} << 30U;

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::bad_mesh, why); }
[[noreturn]] void refuse_cut() { refuse("a zip archive that is cut short or damaged"); }

bool has_possible_size(const unz_file_info64& info) {
  constexpr std::uint64_t stored = 0, deflated = 8;
  const bool known = info.compression_method == stored || info.compression_method == deflated;
  return known && info.uncompressed_size <= most_unpacked &&
         info.uncompressed_size <= most_of_a_byte * info.compressed_size + some_bytes;
}

std::string comparable(std::string_view name) {
  std::string plain = in_lower_case(name);
  std::ranges::replace(plain, '\\', '/');
  plain.erase(0, std::min(plain.find_first_not_of('/'), plain.size()));
  return plain;
}

struct Visited {
  std::string name;
  unz_file_info64 info;
};

/// Calls visit(name, info) with the archive positioned at each entry in turn.
template <typename Visit>
void for_each_entry(unzFile zip, const Visit& visit) {
  std::size_t count = 0;
  int next = unzGoToFirstFile(zip);
  for (; next == UNZ_OK; next = unzGoToNextFile(zip)) {
    if (++count > most_entries) refuse("an archive of more than 10,000 entries");
    unz_file_info64 info;
    char name[512];
    if (unzGetCurrentFileInfo64(zip, &info, name, sizeof name, nullptr, 0, nullptr, 0) != UNZ_OK)
      refuse_cut();
    name[sizeof name - 1] = '\0';
    visit(std::string(name), info);
  }
  if (next != UNZ_END_OF_LIST_OF_FILE) refuse_cut();
}

/// Bytes of an archive as little-endian numbers.
class Bytes {
 public:
  explicit Bytes(std::string& bytes) : bytes_(bytes) {}
  bool hold(std::size_t at, std::size_t size) const {
    return at <= bytes_.size() && size <= bytes_.size() - at;
  }
  std::uint64_t number(std::size_t at, int size) const {
    std::uint64_t value = 0;
    for (int k = size; k-- > 0;)
      value = value << 8U | static_cast<unsigned char>(bytes_[at + std::size_t(k)]);
    return value;
  }
  void put(std::size_t at, int size, std::uint64_t value) {
    for (int k = 0; k < size; ++k, value >>= 8U) bytes_[at + std::size_t(k)] = static_cast<char>(value);
  }

 private:
  std::string& bytes_;
};

constexpr std::uint64_t elsewhere = 0xFFFFFFFF;  // in a 32-bit field: the number is in a 64-bit field

/// Moves the 64-bit numbers of a directory entry at `at` into its 32-bit fields, if they fit, and renames the
/// 64-bit field to an unknown one.
void shorten_numbers(std::string& archive, std::size_t at) {
  constexpr std::size_t header = 46;
  constexpr std::uint64_t signature = 0x02014b50, of_64_bits = 0x0001, unknown = 0x6e62;
  Bytes bytes(archive);
  if (!bytes.hold(at, header) || bytes.number(at, 4) != signature) return;
  std::size_t extra = at + header + bytes.number(at + 28, 2);
  const std::size_t end = extra + bytes.number(at + 30, 2);
  if (end > archive.size()) return;
  for (std::size_t size = 0; extra + 4 <= end; extra += 4 + size) {
    size = bytes.number(extra + 2, 2);
    if (bytes.number(extra, 2) != of_64_bits || extra + 4 + size > end) continue;
    std::size_t from = extra + 4;
    for (const std::size_t field : {at + 24, at + 20, at + 42}) {  // in this order: unpacked, packed, offset
      if (bytes.number(field, 4) != elsewhere) continue;
      if (from + 8 > extra + 4 + size) return;
      const std::uint64_t number = bytes.number(from, 8);
      if (number < elsewhere) bytes.put(field, 4, number);
      from += 8;
    }
    bytes.put(extra, 2, unknown);
  }
}

using Handle = std::unique_ptr<void, int (*)(void*)>;

Handle opened(const char* name) { return {unzOpen64(name), unzClose}; }

/// minizip 1.1 compares 32-bit fields with the largest 64-bit number, so that it never reads the 64-bit
/// fields. If there are any, it gets a copy of the archive with 32-bit numbers.
Handle open_archive(const std::filesystem::path& file) {
  Handle zip = opened(file.c_str());
  if (!zip) refuse_cut();
  std::vector<std::size_t> places;
  for_each_entry(zip.get(), [&](const std::string&, const unz_file_info64& info) {
    if (info.size_file_extra > 0) places.push_back(unzGetOffset64(zip.get()));
  });
  if (places.empty()) return zip;
  std::ifstream in(file, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  const std::string before = bytes;
  for (const std::size_t place : places) shorten_numbers(bytes, place);
  if (bytes == before) return zip;
  const int copy = memfd_create("bernal", MFD_CLOEXEC);
  if (copy < 0) throw std::bad_alloc();
  const std::string name = fmt::format("/proc/self/fd/{}", copy);
  std::ofstream(name, std::ios::binary) << bytes;
  Handle shortened = opened(name.c_str());
  close(copy);
  if (!shortened) refuse_cut();
  return shortened;
}

}  // namespace

bool is_zip(const std::filesystem::path& file) {
  char head[4] = {};
  std::ifstream(file, std::ios::binary).read(head, sizeof head);
  return std::string_view(head, sizeof head) == "PK\x03\x04";
}

ZipArchive::ZipArchive(const std::filesystem::path& file) : zip_(open_archive(file)) {
  for_each_entry(zip_.get(), [&](std::string name, const unz_file_info64&) {
    unz64_file_pos place;
    if (unzGetFilePos64(zip_.get(), &place) != UNZ_OK) refuse_cut();
    if (name.ends_with('/') || name.starts_with("__MACOSX/")) return;
    entries_.emplace(comparable(name), Entry{names_.size(), place.pos_in_zip_directory, place.num_of_file});
    names_.push_back(std::move(name));
  });
}

const std::string* ZipArchive::find(std::string_view name) const {
  const auto found = entries_.find(comparable(name));
  return found == entries_.end() ? nullptr : &names_[found->second.name];
}

std::string ZipArchive::read(const std::string& name) {
  const Entry& entry = entries_.at(comparable(name));
  unz64_file_pos place{entry.place, entry.number};
  unz_file_info64 info;
  if (unzGoToFilePos64(zip_.get(), &place) != UNZ_OK ||
      unzGetCurrentFileInfo64(zip_.get(), &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
    refuse_cut();
  constexpr unsigned long encrypted = 1;
  if ((info.flag & encrypted) != 0) refuse(fmt::format("{} is encrypted; save it without a password", name));
  if (!has_possible_size(info)) refuse("an archive whose directory cannot be true");
  unpacked_ += info.uncompressed_size;
  if (unpacked_ > most_unpacked) refuse("an archive of more than 4 GiB unpacked");
  if (unzOpenCurrentFile(zip_.get()) != UNZ_OK) refuse_cut();
  std::string content;
  std::vector<char> piece(1U << 16U);
  int read = 0;
  while ((read = unzReadCurrentFile(zip_.get(), piece.data(), static_cast<unsigned>(piece.size()))) > 0 &&
         content.size() <= info.uncompressed_size)
    content.append(piece.data(), static_cast<std::size_t>(read));
  const bool whole = read == 0 && content.size() == info.uncompressed_size;
  if (unzCloseCurrentFile(zip_.get()) != UNZ_OK || !whole) refuse_cut();
  return content;
}

}  // namespace bernal::cad
