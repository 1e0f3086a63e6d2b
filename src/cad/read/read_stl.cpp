#include "cad/read/polygon_soup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "bernal/core/error.hpp"
#include "cad/diagnose/counted.hpp"
#include "cad/read/file_facts.hpp"
#include "cad/read/known_formats.hpp"
#include "core/lower_case.hpp"
#include "core/parallel.hpp"
#include "geometry/point_numbers.hpp"

namespace bernal::cad {
namespace {

constexpr std::size_t binary_header = 84;
constexpr std::size_t binary_triangle = 50;
constexpr std::size_t facets_between_looks = 1 << 16;  // between polls of the monitor

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// Parses the words of a text STL and stops at the first that does not belong.
class StlText {
 public:
  StlText(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  ReadAttempt read() && {
    read_solids();
    if (passed_over_ > 0)
      read_.facts.notes.push_back(
          fmt::format("{} behind statements of the format, of no meaning there, are ignored",
                      counted(passed_over_, "word", "words")));
    if (const std::size_t behind = text_.size() - end_; behind > 0)
      read_.facts.notes.push_back(fmt::format("{} bytes after the last solid are ignored", behind));
    read_.soup.points = std::move(points_.points);
    if (read_.soup.solids.size() == 1 && read_.soup.solids.front().name.empty()) read_.soup.solids.clear();
    return std::move(read_);
  }

 private:
  void read_solids() {
    for (std::string_view word = next(); !word.empty(); word = next()) {
      if (skipped_comment(word)) continue;
      if (word != "solid") {
        // Trailing padding or a signature is ignored, but not a solid with a broken first line.
        if (read_.soup.solids.empty() || in_lower_case(text_.substr(end_)).find("facet") != std::string::npos)
          fail("\"solid\"", word);
        return;
      }
      std::string own = name();
      read_.soup.solids.push_back({std::move(own), read_.soup.polygons.size()});
      read_facets();
      end_ = at_;
    }
    end_ = text_.size();
  }

  void read_facets() {
    for (;;) {
      const std::string_view word = statement({"facet", "endsolid"});
      if (word == "endsolid") return skip_line();
      if (word != "facet") fail("\"facet\" or \"endsolid\"", word);
      expect("normal");
      for (int k = 0; k < 3; ++k)
        if (next().empty()) fail("a number", {});
      expect_statement("outer");
      expect("loop");
      std::vector<std::uint32_t>& corners = read_.soup.polygons.emplace_back(3);
      for (std::size_t k = 0; k < 3; ++k) {
        k == 0 ? expect_statement("vertex") : expect("vertex");
        Vector<3> p;
        for (double& coordinate : p) coordinate = expect_number();
        corners[k] = points_.of(p);
      }
      expect("endloop");
      expect_statement("endfacet");
      if (read_.soup.polygons.size() % facets_between_looks == 0) throw_if_interrupted();
    }
  }

  /// The next word, in lower case, valid until the next call.
  std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    word_ = in_lower_case(text_.substr(begin, at_ - begin));
    return word_;
  }

  /// The first word of the next statement, or what is in its place; skips comments and the rest of the
  /// previous statement's line.
  std::string_view statement(std::initializer_list<std::string_view> wanted) {
    const int before = line_;
    for (;;) {
      const std::string_view word = next();
      if (word.empty() || std::ranges::find(wanted, word) != wanted.end()) return word;
      if (skipped_comment(word)) continue;
      if (line_ > before) return word;
      ++passed_over_;
    }
  }

  bool skipped_comment(std::string_view word) {
    if (!word.starts_with('#') && !word.starts_with("//")) return false;
    skip_line();
    return true;
  }

  /// The rest of the line, up to a facet that begins in it.
  std::string name() {
    const std::size_t begin = at_;
    skip_line();
    const std::string rest = in_lower_case(text_.substr(begin, at_ - begin));
    if (const std::size_t facet = rest.find(" facet normal "); facet != std::string::npos)
      at_ = begin + facet;
    return std::string(trimmed(text_.substr(begin, at_ - begin)));
  }

  void skip_line() { at_ = std::min(text_.find_first_of("\r\n", at_), text_.size()); }

  void expect(std::string_view wanted) {
    const std::string_view word = next();
    if (word != wanted) fail(fmt::format("\"{}\"", wanted), word);
  }
  void expect_statement(std::string_view wanted) {
    const std::string_view word = statement({wanted});
    if (word != wanted) fail(fmt::format("\"{}\"", wanted), word);
  }

  double expect_number() {
    next();
    const std::string whole = word_;
    std::ranges::replace(word_, 'd', 'e');  // Fortran's exponents
    const std::optional<double> number = finite_number(word_);
    if (!number) fail("a finite number", whole);
    return *number;
  }

  [[noreturn]] void fail(std::string_view wanted, std::string_view found) {
    const std::string what = found.empty() ? "the end of the file" : fmt::format("\"{:.40}\"", found);
    throw Error(ErrorCode::bad_mesh,
                fmt::format("malformed text STL: expected {}, found {}; export the file again", wanted, what),
                {file_, line_, 0});
  }

  std::string_view text_;
  std::string file_, word_;
  std::size_t at_ = 0, end_ = 0;  ///< position, and end of the last solid
  std::size_t passed_over_ =
      0;  ///< words behind a statement in its line, a number behind endfacet for instance
  int line_ = 1;
  ReadAttempt read_{.reader = "bernal, double precision"};
  PointNumbers<Vector<3>> points_;
};

/// Whether the file is text: comments, then the word "solid".
bool begins_as_text(std::string_view content) {
  std::string head = in_lower_case(content.substr(0, 1024));
  std::size_t at = head.find_first_not_of(" \t\r\n");
  while (at != std::string::npos && head[at] == '#')
    at = head.find_first_not_of(" \t\r\n", std::min(head.find('\n', at), head.size()));
  if (at == std::string::npos || head.compare(at, 5, "solid") != 0) return false;
  const std::size_t zero = head.find('\0');
  return zero == std::string::npos || head.find("endsolid") < zero;  // zero padding may follow a small part
}

ReadAttempt read_binary(std::string_view content, std::size_t triangles) {
  ReadAttempt read{.reader = "bernal (binary STL holds single precision)"};
  read.soup.points.reserve(3 * triangles);
  read.soup.polygons.reserve(triangles);
  for (std::size_t t = 0; t < triangles; ++t) {
    if (t % facets_between_looks == 0) throw_if_interrupted();
    float numbers[12];  // the normal and the corners
    std::memcpy(numbers, content.data() + binary_header + t * binary_triangle, sizeof numbers);
    const auto first = static_cast<std::uint32_t>(read.soup.points.size());
    for (int k = 3; k < 12; k += 3) {
      read.soup.points.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
      if (!read.soup.points.back().allFinite()) read.failure = "a coordinate is not finite";
    }
    read.soup.polygons.push_back({first, first + 1, first + 2});
  }
  return read;
}

}  // namespace

ReadAttempt read_stl(const std::filesystem::path& file) {
  const std::string content = text_without_mark(file);
  std::uint32_t triangles = 0;
  const std::size_t size = content.size();
  if (size >= binary_header) std::memcpy(&triangles, content.data() + binary_header - 4, 4);
  const std::size_t promised = binary_header + binary_triangle * std::size_t{triangles};
  if (size >= binary_header && size == promised) return read_binary(content, triangles);
  if (begins_as_text(content)) return StlText(content, file.string()).read();

  const std::size_t behind = size > promised ? size - promised : 0;
  if (size >= binary_header && triangles > 0 && behind % binary_triangle != 0) {
    ReadAttempt read = read_binary(content, triangles);
    read.facts.notes.push_back(fmt::format("{} bytes after the last triangle are ignored", behind));
    return read;
  }
  const std::string message =
      size < binary_header
          ? fmt::format("not an STL file: {} bytes, neither text nor a binary header", size)
          : fmt::format(
                "{} binary STL: its header promises {} triangles, so {} bytes, but it has {}; "
                "export the file again",
                size < promised ? "truncated" : "malformed", triangles, promised, size);
  throw Error(ErrorCode::bad_mesh, message, {file.string()});
}

}  // namespace bernal::cad
