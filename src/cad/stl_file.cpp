#include "cad/stl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "bernal/core/error.hpp"
#include "cad/file_facts.hpp"

namespace bernal::cad {
namespace {

constexpr std::size_t binary_header = 84;
constexpr std::size_t binary_triangle = 50;

/// Walks through the words of a lower-case text STL and stops at the first that does not belong.
class StlGrammar {
 public:
  StlGrammar(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  /// Where the names of solids stand in the text, and the facets before each.
  struct Part {
    std::size_t begin, end, first;
  };

  void check() {
    for (std::string_view word = next(); !word.empty(); word = next()) {
      if (word != "solid") {
        // Padding, a signature, a remark; not a solid whose first line is spoilt.
        if (parts_.empty() || text_.substr(end_).find("facet") != std::string_view::npos)
          fail("\"solid\"", word);
        return;
      }
      const std::size_t begin = at_;
      skip_line();
      parts_.push_back({begin, at_, facets_});
      check_solid();
      end_ = at_;
    }
    end_ = text_.size();
  }

  std::size_t facets() const { return facets_; }
  /// Of what belongs to the format.
  std::size_t end() const { return end_; }
  const std::vector<Part>& parts() const { return parts_; }

 private:
  void check_solid() {
    for (;;) {
      const std::string_view word = next();
      if (word == "endsolid") return skip_line();
      if (word != "facet") fail("\"facet\" or \"endsolid\"", word);
      expect("normal");
      for (int k = 0; k < 3; ++k)
        if (next().empty()) fail("a number", {});
      expect("outer");
      expect("loop");
      for (int k = 0; k < 3; ++k) {
        expect("vertex");
        for (int axis = 0; axis < 3; ++axis) expect_number();
      }
      expect("endloop");
      expect("endfacet");
      ++facets_;
    }
  }

  std::string_view next() {
    const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }

  void expect(std::string_view wanted) {
    const std::string_view word = next();
    if (word != wanted) fail(fmt::format("\"{}\"", wanted), word);
  }

  void expect_number() {
    std::string_view word = next();
    const std::string_view whole = word;
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool parsed = error == std::errc() || error == std::errc::result_out_of_range;
    if (!parsed || end != word.data() + word.size() || !std::isfinite(value)) fail("a finite number", whole);
  }

  [[noreturn]] void fail(std::string_view wanted, std::string_view found) {
    const std::string what = found.empty() ? "the end of the file" : fmt::format("\"{:.40}\"", found);
    throw Error(ErrorCode::bad_mesh,
                fmt::format("malformed text STL: expected {}, found {}; export the file again", wanted, what),
                {file_, line_, 0});
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0, end_ = 0;
  std::size_t facets_ = 0;
  std::vector<Part> parts_;
  int line_ = 1;
};

char lower_without_tab(unsigned char c) { return c == '\t' ? ' ' : static_cast<char>(std::tolower(c)); }

bool begins_as_text(std::string_view content) {
  std::string head(content.substr(0, 1024));
  std::transform(head.begin(), head.end(), head.begin(), lower_without_tab);
  const std::size_t first = head.find_first_not_of(" \r\n"), zero = head.find('\0');
  if (first == std::string::npos || head.compare(first, 5, "solid") != 0) return false;
  return zero == std::string::npos || head.find("endsolid") < zero;  // padding, behind a small part
}

std::string trimmed_name(std::string_view name) {
  const std::size_t first = name.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(name.substr(first, name.find_last_not_of(" \t\r") - first + 1));
}

StlFile checked_text(const std::string& written, const std::string& file) {
  StlFile stl{false, written};
  std::transform(stl.content.begin(), stl.content.end(), stl.content.begin(), lower_without_tab);
  StlGrammar grammar(stl.content, file);
  grammar.check();
  if (const std::size_t behind = written.size() - grammar.end(); behind > 0) {
    stl.content.resize(grammar.end());
    stl.notes.push_back(fmt::format("{} bytes after the last solid are ignored", behind));
  }
  stl.facets = grammar.facets();
  for (const auto& [begin, end, first] : grammar.parts())
    stl.solids.push_back({trimmed_name(std::string_view(written).substr(begin, end - begin)), first});
  if (stl.solids.size() == 1 && stl.solids.front().name.empty()) stl.solids.clear();
  return stl;
}

}  // namespace

StlFile read_stl_file(const std::filesystem::path& file) {
  StlFile stl{true, text_without_mark(file)};

  std::uint32_t triangles = 0;
  const std::size_t size = stl.content.size();
  if (size >= binary_header) std::memcpy(&triangles, stl.content.data() + binary_header - 4, 4);
  const std::size_t promised = binary_header + binary_triangle * std::size_t{triangles};
  stl.facets = triangles;
  if (size >= binary_header && size == promised) return stl;
  if (begins_as_text(stl.content)) return checked_text(stl.content, file.string());

  const std::size_t behind = size > promised ? size - promised : 0;
  if (size >= binary_header && triangles > 0 && behind % binary_triangle != 0) {
    stl.content.resize(promised);
    stl.notes.push_back(fmt::format("{} bytes after the last triangle are ignored", behind));
    return stl;
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

void tell_parts(const StlFile& stl, ReadAttempt& attempt) {
  if (!attempt.ok()) return;
  attempt.facts.notes.insert(attempt.facts.notes.end(), stl.notes.begin(), stl.notes.end());
  attempt.soup.solids.clear();
  if (attempt.soup.polygons.size() == stl.facets) attempt.soup.solids = stl.solids;
}

}  // namespace bernal::cad
