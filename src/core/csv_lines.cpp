#include "core/csv_lines.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/unit.hpp"
#include "core/file_kind.hpp"
#include "core/next_line.hpp"

namespace bernal {

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string out = "\"";
  for (const char c : text.substr(0, longest)) {
    if (c >= 0x20 && c < 0x7f) {
      out += c;
    } else {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  return out + (text.size() > longest ? "…\"" : "\"");
}

CsvLines::CsvLines(const std::filesystem::path& file) : file_(file.string()) {
  const FileKind kind = kind_of_file(file);
  if (kind == FileKind::folder) cannot_read("it is a folder");
  if (kind == FileKind::other) cannot_read("it is a pipe or a device");
  errno = 0;
  stream_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  stream_.open(file, std::ios::binary);
  if (!stream_) cannot_read(std::strerror(errno));
}

bool CsvLines::next() {
  errno = 0;
  const NextLine next = next_line(stream_, line_);
  if (stream_.bad()) cannot_read(std::strerror(errno));
  if (next == NextLine::none) return false;
  ++number_;
  if (next == NextLine::too_long) fail("this line is too long for a sphere; is it another file?");
  if (stream_.eof())
    fail("the file ends in the middle of this line; write it again if it was cut off, else add a line feed");
  if (line_.ends_with('\r')) line_.pop_back();
  return true;
}

double CsvLines::read_number(std::string_view field, std::string_view column) const {
  double value = 0;
  const char* end = field.data() + field.size();
  const auto [stop, problem] = std::from_chars(field.data(), end, value);
  if (problem == std::errc::result_out_of_range)
    fail(fmt::format("{} = {} is out of the range of a double", column, quoted(field)));
  if (problem != std::errc{} || stop != end)
    fail(fmt::format("{} = {} is not a number", column, quoted(field)));
  if (!std::isfinite(value)) fail(fmt::format("{} = {} is not finite", column, quoted(field)));
  return value;
}

std::string CsvLines::unit() const {
  constexpr std::string_view mark = "# unit:";
  if (!line_.starts_with(mark)) return {};
  std::string_view name = line().substr(mark.size());
  while (name.starts_with(' ')) name.remove_prefix(1);
  const auto known = unit_names();
  if (std::ranges::find(known, name) != known.end()) return std::string(name);
  fail(fmt::format("unknown unit {}; use one of {}", quoted(name), fmt::join(known, ", ")));
}

void CsvLines::fail(const std::string& message) const {
  throw Error(ErrorCode::bad_packing, message, {file_, number_});
}

void CsvLines::cannot_read(const std::string& why) const {
  throw Error(ErrorCode::bad_packing, "cannot be read: " + why, {file_});
}

}  // namespace bernal
