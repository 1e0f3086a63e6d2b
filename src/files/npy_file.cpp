#include "files/npy_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "files/csv_lines.hpp"
#include "files/file_kind.hpp"
#include "files/npy_header.hpp"

namespace bernal {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 20;
/// Structures of more members, and longer headers, are no spheres.
constexpr std::size_t most_members = 64, longest_header = 1 << 16;

}  // namespace

bool is_npy_file(const std::filesystem::path& file) {
  if (kind_of_file(file) != FileKind::regular) return false;
  InputFile in(file);
  char begin[npy_magic.size()] = {};
  return in.read(begin, sizeof begin) && std::string_view(begin, sizeof begin) == npy_magic;
}

std::string npy_header(std::size_t rows, std::size_t columns) {
  std::vector<std::size_t> shape{rows};
  if (columns > 0) shape.push_back(columns);
  return npy_header("<f8", shape);
}

std::string npy_header(std::string_view type, std::span<const std::size_t> shape) {
  std::string sizes;
  for (const std::size_t size : shape) sizes += fmt::format("{}{},", sizes.empty() ? "" : " ", size);
  if (shape.size() > 1) sizes.pop_back();
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, sizes);
  constexpr std::size_t lead = 10, alignment = 64;  // magic, version and length of the header stand before it
  header.resize((lead + header.size() + 1 + alignment - 1) / alignment * alignment - lead - 1, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string whole(npy_magic);
  whole += {'\x01', '\0', static_cast<char>(length & 0xFF), static_cast<char>(length >> 8)};
  return whole + header;
}

NpyFile::NpyFile(const std::filesystem::path& file, std::function<void(std::string_view)> see, Takes takes)
    : name_(file.string()), see_(std::move(see)) {
  const FileKind kind = kind_of_file(file);
  if (kind == FileKind::folder) fail("cannot be read: it is a folder");
  if (kind == FileKind::other) fail("cannot be read: it is a pipe or a device");
  errno = 0;
  stream_.open(file);
  if (!stream_) fail(fmt::format("cannot be read: {}", std::strerror(errno)));
  read_header(takes);
  begin_ = static_cast<std::uintmax_t>(stream_.tellg());
  const std::uintmax_t there = std::filesystem::file_size(file) - begin_;
  if (row_bytes_ > 0 && rows_ > there / row_bytes_)
    fail(fmt::format("ends after {} of {} rows: it was cut off", there / row_bytes_, rows_));
  if (const std::uintmax_t left = there - rows_ * row_bytes_; left > 0)
    fail(fmt::format(
        "holds something else too, {} bytes behind its {} rows; save one array alone, with np.save", left,
        rows_));
}

std::optional<std::uintmax_t> NpyFile::doubles_from() const {
  const bool are_doubles = std::ranges::all_of(
      fields_, [](const Field& f) { return f.number.kind == 'f' && f.bytes() == 8 && !f.number.is_swapped; });
  if (!are_doubles || !names_.empty() || by_columns_) return std::nullopt;
  return begin_;
}

void NpyFile::read_header(Takes takes) {
  char lead[8];
  read_bytes(lead, sizeof lead);
  if (std::string_view(lead, npy_magic.size()) != npy_magic) fail("is no .npy file");
  const int version = static_cast<unsigned char>(lead[6]);
  if (version < 1 || version > 3) fail(fmt::format("is an .npy of version {}, which is unknown", version));
  unsigned char length_bytes[4] = {};
  read_bytes(reinterpret_cast<char*>(length_bytes), version == 1 ? 2 : 4);
  std::size_t length = 0;
  for (int k = 3; k >= 0; --k) length = length << 8 | length_bytes[k];
  if (length > longest_header)
    fail(fmt::format("has a header of {} bytes, which is none of spheres", length));
  std::string text(length, '\0');
  read_bytes(text.data(), length);
  const auto header = npy_header_in(text);
  if (!header)
    fail(fmt::format("has a header that is not understood: {}; save an array of floats or doubles",
                     bernal::quoted(text)));
  const std::vector<std::uint64_t>& shape = header->shape;
  is_list_ = takes == Takes::any_numbers && !header->is_structure && shape.size() == 1;
  if (shape.size() != (header->is_structure || is_list_ ? 1 : 2))
    fail(fmt::format("is an array of shape ({}), not a table with a row for each sphere",
                     fmt::join(shape, ", ")));
  const std::uint64_t columns = header->is_structure ? header->members.size() : is_list_ ? 1 : shape[1];
  if (columns > (takes == Takes::any_numbers ? 4096 : most_members))
    fail(fmt::format("has {} columns, which are none of spheres", columns));
  rows_ = shape[0];
  by_columns_ = header->fortran_order && !header->is_structure;
  for (std::size_t k = 0; k < columns; ++k) {
    const auto& [name, type] = header->members[header->is_structure ? k : 0];
    if (header->is_structure) names_.push_back(name);
    const RawNumber number{type.size() == 3 ? type[1] : '?', type.size() == 3 ? type[2] - '0' : 0,
                           type[0] == '>'};
    const bool is_taken = std::string_view("<>=|").find(type[0]) != std::string_view::npos &&
                          number.is_known() && (number.kind == 'f' || takes == Takes::any_numbers);
    if (!is_taken)
      fail(
          fmt::format("holds numbers of type {}; save it as float64, \"<f8\": np.save(file, a.astype(float))",
                      bernal::quoted(type)));
    fields_.push_back({row_bytes_, number});
    row_bytes_ += fields_.back().bytes();
  }
}

void NpyFile::read_bytes(char* to, std::size_t count) {
  errno = 0;
  if (!stream_.read(to, static_cast<std::streamsize>(count)))
    fail(stream_.bad() || errno != 0 ? fmt::format("cannot be read: {}", std::strerror(errno))
                                     : "ends before its header says so: it was cut off");
  if (see_) see_({to, count});
}

void NpyFile::read(const Visit& visit) {
  if (fields_.empty() || rows_ == 0) return;
  by_columns_ ? read_columns(visit) : read_rows(visit);
}

void NpyFile::read_rows(const Visit& visit) {
  const std::size_t at_once = std::max<std::size_t>(1, piece_bytes / row_bytes_);
  std::vector<char> bytes(at_once * row_bytes_);
  std::vector<double> values(at_once);
  for (std::size_t first = 0; first < rows_; first += at_once) {
    const std::size_t count = std::min(at_once, rows_ - first);
    read_bytes(bytes.data(), count * row_bytes_);
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      const char* at = bytes.data() + fields_[k].offset;
      for (std::size_t i = 0; i < count; ++i, at += row_bytes_) values[i] = raw_number(at, fields_[k].number);
      visit(k, first, std::span(values).first(count));
    }
  }
}

void NpyFile::read_columns(const Visit& visit) {
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const std::size_t width = fields_[k].bytes(), at_once = piece_bytes / width;
    std::vector<char> bytes(at_once * width);
    std::vector<double> values(at_once);
    for (std::size_t first = 0; first < rows_; first += at_once) {
      const std::size_t count = std::min(at_once, rows_ - first);
      read_bytes(bytes.data(), count * width);
      for (std::size_t i = 0; i < count; ++i)
        values[i] = raw_number(bytes.data() + i * width, fields_[k].number);
      visit(k, first, std::span(values).first(count));
    }
  }
}

void NpyFile::fail_at(std::size_t row, const std::string& message) const {
  throw Error(ErrorCode::bad_packing, fmt::format("row {}: {}", row + 1, message), {name_});
}
void NpyFile::fail(const std::string& message) const {
  throw Error(ErrorCode::bad_packing, message, {name_});
}

}  // namespace bernal
