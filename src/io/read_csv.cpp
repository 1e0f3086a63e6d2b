#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/io/read_packing.hpp"
#include "core/file_kind.hpp"
#include "core/next_line.hpp"
#include "io/write_csv.hpp"

namespace bernal {
namespace {

constexpr std::string_view unit_mark = "# unit:";

/// Text from a file that may hold anything, made fit for one line of a message.
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

/// The lines of a file, one after the other, with CRLF taken for LF.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : file_(file.string()) {
    const FileKind kind = kind_of_file(file);
    if (kind == FileKind::folder) cannot_read("it is a folder");
    if (kind == FileKind::other) cannot_read("it is a pipe or a device");
    errno = 0;
    stream_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    stream_.open(file, std::ios::binary);
    if (!stream_) cannot_read(std::strerror(errno));
  }

  bool next() {
    errno = 0;
    const NextLine next = next_line(stream_, line_);
    if (stream_.bad()) cannot_read(std::strerror(errno));
    if (next == NextLine::none) return false;
    ++number_;
    if (next == NextLine::too_long) fail("this line is too long for a sphere; is it another file?");
    if (stream_.eof()) fail("the file ends in the middle of this line; it was cut off, write it again");
    if (line_.ends_with('\r')) line_.pop_back();
    return true;
  }
  std::string_view line() const { return line_; }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorCode::bad_packing, message, {file_, number_});
  }

 private:
  [[noreturn]] void cannot_read(const std::string& why) const {
    throw Error(ErrorCode::bad_packing, "cannot be read: " + why, {file_});
  }

  std::string file_;
  std::vector<char> buffer_ = std::vector<char>(std::size_t{1} << 18);
  std::ifstream stream_;
  std::string line_;
  int number_ = 0;
};

std::string read_unit(const Lines& lines) {
  std::string_view name = lines.line().substr(unit_mark.size());
  while (name.starts_with(' ')) name.remove_prefix(1);
  const auto known = unit_names();
  if (std::ranges::find(known, name) != known.end()) return std::string(name);
  lines.fail(fmt::format("unknown unit {}; use one of {}", quoted(name), fmt::join(known, ", ")));
}

double read_number(std::string_view field, std::string_view column, const Lines& lines) {
  double value = 0;
  const char* end = field.data() + field.size();
  const auto [stop, problem] = std::from_chars(field.data(), end, value);
  if (problem == std::errc::result_out_of_range) {
    lines.fail(fmt::format("{} = {} is out of the range of a double", column, quoted(field)));
  }
  if (problem != std::errc{} || stop != end) {
    lines.fail(fmt::format("{} = {} is not a number", column, quoted(field)));
  }
  if (!std::isfinite(value)) lines.fail(fmt::format("{} = {} is not finite", column, quoted(field)));
  return value;
}

/// Which dimension has this header.
int dimension_of_header(const Lines& lines) {
  for (int dimension = 1; dimension <= max_dimension; ++dimension)
    if (lines.line() == csv_header(dimension)) return dimension;
  lines.fail(fmt::format("expected the header {} (or {} and so on), found {}", csv_header(3), csv_header(2),
                         quoted(lines.line())));
}

/// One line: the coordinates, then the radius. `columns` are their names.
void read_sphere(const Lines& lines, const std::vector<std::string>& columns, Spheres<dynamic>& spheres) {
  std::string_view rest = lines.line();
  if (rest.empty()) lines.fail("empty line; one sphere a line is expected");
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::size_t comma = rest.find(',');
    const bool last = k + 1 == columns.size();
    if ((comma == std::string_view::npos) != last) {
      const auto fields = 1 + std::count(lines.line().begin(), lines.line().end(), ',');
      lines.fail(fmt::format("{} fields, expected {}: {}", fields, columns.size(), fmt::join(columns, ",")));
    }
    const double value = read_number(rest.substr(0, comma), columns[k], lines);
    if (last && !(value > 0)) lines.fail(fmt::format("the radius {} is not positive", value));
    (last ? spheres.r : spheres.x[k]).push_back(value);
    if (!last) rest.remove_prefix(comma + 1);
  }
}

}  // namespace

SpheresFile read_csv(const std::filesystem::path& file) {
  Lines lines(file);
  std::string unit;

  bool found = lines.next();
  while (found && lines.line().starts_with('#')) {
    if (lines.line().starts_with(unit_mark)) unit = read_unit(lines);
    found = lines.next();
  }
  if (!found) lines.fail(fmt::format("the header {} is missing", csv_header(3)));
  SpheresFile result{Spheres<dynamic>(dimension_of_header(lines)), std::move(unit)};
  const std::vector<std::string> columns = csv_columns(result.spheres.dimension());
  while (lines.next()) read_sphere(lines, columns, result.spheres);
  return result;
}

}  // namespace bernal
