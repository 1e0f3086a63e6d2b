#include "cad/zip_archive.hpp"

#include <minizip/unzip.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <vector>

#include "cad/known_formats.hpp"

namespace bernal::cad {
namespace {

constexpr int most_entries = 10'000;
/// Deflate makes no more than 1,032 bytes of one.
constexpr std::uint64_t most_of_a_byte = 1032, some_bytes = 64;
constexpr std::uint64_t most_unpacked = std::uint64_t{4} << 30U;

constexpr const char* cut_archive = "a zip archive that is cut short or damaged";

bool is_as_it_says(const unz_file_info64& info) {
  constexpr std::uint64_t stored = 0, deflated = 8;
  const bool known = info.compression_method == stored || info.compression_method == deflated;
  return known && info.uncompressed_size <= most_unpacked &&
         info.uncompressed_size <= most_of_a_byte * info.compressed_size + some_bytes;
}

/// The entry that the archive stands at.
ZipEntry read_entry(unzFile zip, const unz_file_info64& info) {
  if (unzOpenCurrentFile(zip) != UNZ_OK) return {{}, cut_archive};
  ZipEntry entry;
  std::vector<char> piece(1U << 16U);
  int read = 0;
  while ((read = unzReadCurrentFile(zip, piece.data(), static_cast<unsigned>(piece.size()))) > 0 &&
         entry.content.size() <= info.uncompressed_size)
    entry.content.append(piece.data(), static_cast<std::size_t>(read));
  const bool whole = read == 0 && entry.content.size() == info.uncompressed_size;
  if (unzCloseCurrentFile(zip) != UNZ_OK || !whole) return {{}, cut_archive};
  return entry;
}

}  // namespace

bool is_zip(const std::filesystem::path& file) {
  char head[4] = {};
  std::ifstream(file, std::ios::binary).read(head, sizeof head);
  return std::string_view(head, sizeof head) == "PK\x03\x04";
}

ZipEntry zip_entry(const std::filesystem::path& archive, std::string_view ending) {
  const std::unique_ptr<void, int (*)(unzFile)> zip(unzOpen64(archive.c_str()), unzClose);
  if (!zip) return {{}, cut_archive};
  ZipEntry found{{}, "an archive without an entry that ends in " + std::string(ending)};
  bool any = false;
  int count = 0, next = unzGoToFirstFile(zip.get());
  for (; next == UNZ_OK; next = unzGoToNextFile(zip.get())) {
    if (++count > most_entries) return {{}, "an archive of more than 10,000 entries"};
    unz_file_info64 info;
    char name[512];
    if (unzGetCurrentFileInfo64(zip.get(), &info, name, sizeof name, nullptr, 0, nullptr, 0) != UNZ_OK)
      return {{}, cut_archive};
    name[sizeof name - 1] = '\0';
    if (!is_as_it_says(info)) return {{}, "an archive whose directory cannot be true"};
    if (any || !in_lower_case(name).ends_with(ending)) continue;
    any = true;
    found = read_entry(zip.get(), info);
    if (!found.trouble.empty()) return found;
  }
  return next == UNZ_END_OF_LIST_OF_FILE ? found : ZipEntry{{}, cut_archive};
}

}  // namespace bernal::cad
