#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/io/read_packing.hpp"

namespace bernal {
namespace {

constexpr std::string_view header = "x,y,z,r";
constexpr std::string_view unit_mark = "# unit:";
constexpr std::array<std::string_view, 4> columns = {"x", "y", "z", "r"};

std::string read_whole(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& why) -> Error {
    return {ErrorCode::bad_packing, "cannot be read: " + why, {file.string()}};
  };
  if (std::filesystem::is_directory(file)) throw fail("it is a folder");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw fail(std::strerror(errno));
  std::string text;
  while (stream) {
    constexpr std::size_t block = std::size_t{1} << 20;
    const std::size_t before = text.size();
    text.resize(before + block);
    stream.read(text.data() + before, block);
    text.resize(before + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw fail(std::strerror(errno));
  return text;
}

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

/// The lines of a text, one after the other, with CRLF taken for LF.
class Lines {
 public:
  Lines(std::string_view text, const std::filesystem::path& file) : rest_(text), file_(file.string()) {}

  bool next() {
    if (rest_.empty()) return false;
    ++number_;
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) {
      fail("the file ends in the middle of this line; it was cut off, write it again");
    }
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    return true;
  }
  std::string_view line() const { return line_; }
  std::string_view rest() const { return rest_; }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorCode::bad_packing, message, {file_, number_});
  }

 private:
  std::string_view rest_;
  std::string_view line_;
  std::string file_;
  int number_ = 0;
};

std::string read_unit(const Lines& lines) {
  std::string_view name = lines.line().substr(unit_mark.size());
  while (name.starts_with(' ')) name.remove_prefix(1);
  std::string known;
  for (const Unit& unit : units()) {
    if (unit.name == name) return std::string(name);
    known += (known.empty() ? "" : ", ") + std::string(unit.name);
  }
  lines.fail(fmt::format("unknown unit {}; use one of {}", quoted(name), known));
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

std::array<double, 4> read_sphere(const Lines& lines) {
  std::array<double, 4> values{};
  std::string_view rest = lines.line();
  if (rest.empty()) lines.fail("empty line; one sphere a line is expected");
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::size_t comma = rest.find(',');
    const bool last = k + 1 == columns.size();
    if ((comma == std::string_view::npos) != last) {
      const auto fields = 1 + std::count(lines.line().begin(), lines.line().end(), ',');
      lines.fail(fmt::format("{} fields, expected 4: {}", fields, header));
    }
    values[k] = read_number(rest.substr(0, comma), columns[k], lines);
    if (!last) rest.remove_prefix(comma + 1);
  }
  if (!(values[3] > 0)) lines.fail(fmt::format("the radius {} is not positive", values[3]));
  return values;
}

}  // namespace

SpheresFile read_csv(const std::filesystem::path& file) {
  const std::string text = read_whole(file);
  Lines lines(text, file);
  SpheresFile result;

  bool found = lines.next();
  while (found && lines.line().starts_with('#')) {
    if (lines.line().starts_with(unit_mark)) result.unit = read_unit(lines);
    found = lines.next();
  }
  if (!found) lines.fail(fmt::format("the header {} is missing", header));
  if (lines.line() != header) {
    lines.fail(fmt::format("expected the header {}, found {}", header, quoted(lines.line())));
  }
  result.spheres.reserve(
      static_cast<std::size_t>(std::count(lines.rest().begin(), lines.rest().end(), '\n')));
  while (lines.next()) {
    const auto [x, y, z, r] = read_sphere(lines);
    result.spheres.push_back({x, y, z}, r);
  }
  return result;
}

}  // namespace bernal
