#include "files/csv_lines.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/unit.hpp"
#include "files/csv_headings.hpp"
#include "files/file_kind.hpp"
#include "files/input_file.hpp"
#include "files/next_line.hpp"

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

std::optional<std::string_view> unit_in_remark(std::string_view line) {
  const auto skip = [&](std::string_view some) {
    line.remove_prefix(std::min(line.find_first_not_of(some), line.size()));
  };
  skip(" \t");
  if (!line.starts_with('#')) return std::nullopt;
  skip("# \t");
  constexpr std::string_view word = "unit";
  if (line.size() < word.size()) return std::nullopt;
  for (std::size_t k = 0; k < word.size(); ++k)
    if ((line[k] | 0x20) != word[k]) return std::nullopt;
  line.remove_prefix(word.size());
  if (!line.empty() && (line.front() | 0x20) == 's') line.remove_prefix(1);
  skip(" \t");
  if (!line.starts_with(':')) return std::nullopt;
  line.remove_prefix(1);
  skip(" \t");
  const auto last = line.find_last_not_of(" \t,;\r");
  return line.substr(0, last == line.npos ? 0 : last + 1);
}

std::string complaint_of_unit(std::string_view name) {
  const auto known = unit_names();
  if (std::ranges::find(known, name) != known.end()) return {};
  return fmt::format("unknown unit {}; use one of {}", quoted(name), fmt::join(known, ", "));
}

CsvLines::Bytes::int_type CsvLines::Bytes::underflow() {
  const int_type first = std::filebuf::underflow();
  if (see && !traits_type::eq_int_type(first, traits_type::eof()))
    see({gptr(), static_cast<std::size_t>(egptr() - gptr())});
  return first;
}

CsvLines::CsvLines(const std::filesystem::path& file, CsvReading how)
    : file_(file.string()), last_line_may_lack_feed_(how.last_line_may_lack_feed) {
  const FileKind kind = kind_of_file(file);
  if (kind == FileKind::folder) cannot_read("it is a folder");
  if (kind == FileKind::other) cannot_read("it is a pipe or a device");
  errno = 0;
  bytes_.see = std::move(how.see);
  bytes_.pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  if (!open_to_read(bytes_, file)) cannot_read(std::strerror(errno));
}

bool CsvLines::next() {
  errno = 0;
  const NextLine next = next_line(stream_, line_);
  if (stream_.bad()) cannot_read(std::strerror(errno));
  if (next == NextLine::none) return false;
  ++number_;
  if (next == NextLine::too_long) fail("this line is too long for a sphere; is it another file?");
  if (stream_.eof() && !last_line_may_lack_feed_)
    fail("the file ends in the middle of this line; write it again if it was cut off, else add a line feed");
  if (line_.ends_with('\r')) line_.pop_back();
  if (number_ == 1 && line_.starts_with("\xEF\xBB\xBF")) line_.erase(0, 3);
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

bool CsvLines::says_unit(std::string& unit) const {
  const auto name = unit_in_remark(line_);
  if (name) take_unit(*name, unit);
  return name.has_value();
}

void CsvLines::take_unit(std::string_view name, std::string& unit) const {
  name = unit_in_letters(name);
  if (const std::string complaint = complaint_of_unit(name); !complaint.empty()) fail(complaint);
  if (!unit.empty() && unit != name)
    fail(fmt::format("this line says that the unit is {}, and one before it says {}", name, unit));
  unit = name;
}

void CsvLines::fail(const std::string& message) const {
  throw Error(ErrorCode::bad_packing, message, {file_, number_});
}

void CsvLines::cannot_read(const std::string& why) const {
  throw Error(ErrorCode::bad_packing, "cannot be read: " + why, {file_});
}

}  // namespace bernal
