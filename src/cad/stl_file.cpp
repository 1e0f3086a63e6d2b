#include "cad/stl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "bernal/core/error.hpp"
#include "cad/counted.hpp"
#include "cad/file_facts.hpp"
#include "cad/known_formats.hpp"

namespace bernal::cad {
namespace {

constexpr std::size_t binary_header = 84;
constexpr std::size_t binary_triangle = 50;
/// Longer words are no numbers.
constexpr std::size_t most_digits = 1000;

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

std::string lower(std::string_view text) { return in_lower_case(std::string(text)); }

/// Walks through the words of a text STL, stops at the first that does not belong, and writes those that do
/// anew.
class StlGrammar {
 public:
  StlGrammar(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
    plain_.reserve(text.size());
  }

  void check() {
    for (std::string_view word = next(); !word.empty(); word = next()) {
      if (skipped_comment(word)) continue;
      if (word != "solid") {
        // Padding, a signature, a remark; not a solid whose first line is spoilt.
        if (solids_.empty() || lower(text_.substr(end_)).find("facet") != std::string::npos)
          fail("\"solid\"", word);
        return;
      }
      solids_.push_back({name(), facets_});
      plain_ += "solid\n";
      check_solid();
      end_ = at_;
    }
    end_ = text_.size();
  }

  std::size_t facets() const { return facets_; }
  /// Of what belongs to the format.
  std::size_t end() const { return end_; }
  /// Words that stand behind a statement in its line, a number behind endfacet for instance.
  std::size_t passed_over() const { return passed_over_; }
  std::vector<Solid>& solids() { return solids_; }
  /// As readers know it: in lower case, without names, normals and what is passed over.
  std::string& plain() { return plain_; }

 private:
  void check_solid() {
    for (;;) {
      const std::string_view word = statement({"facet", "endsolid"});
      if (word == "endsolid") {
        plain_ += "endsolid\n";
        return skip_line();
      }
      if (word != "facet") fail("\"facet\" or \"endsolid\"", word);
      expect("normal");
      for (int k = 0; k < 3; ++k)
        if (next().empty()) fail("a number", {});
      expect_statement("outer");
      expect("loop");
      plain_ += "facet normal 0 0 0\nouter loop\n";
      for (int k = 0; k < 3; ++k) {
        k == 0 ? expect_statement("vertex") : expect("vertex");
        plain_ += "vertex";
        for (int axis = 0; axis < 3; ++axis) expect_number();
        plain_ += '\n';
      }
      expect("endloop");
      expect_statement("endfacet");
      plain_ += "endloop\nendfacet\n";
      ++facets_;
    }
  }

  /// The next word, in lower case, until the one after it is asked for.
  std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    word_ = lower(text_.substr(begin, at_ - begin));
    return word_;
  }

  /// The word with which the next statement begins, or what stands in its place: what is left of the line of
  /// the one before is passed over, and so are comments.
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

  /// What is left of the line, up to a facet that begins in it.
  std::string name() {
    const std::size_t begin = at_;
    skip_line();
    const std::string rest = lower(text_.substr(begin, at_ - begin));
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

  void expect_number() {
    next();
    const std::string whole = word_;
    std::ranges::replace(word_, 'd', 'e');  // as Fortran writes exponents
    std::string_view word = word_;
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool parsed = error == std::errc() || error == std::errc::result_out_of_range;
    if (!parsed || end != word.data() + word.size() || !std::isfinite(value) || word.size() > most_digits)
      fail("a finite number", whole);
    plain_ += ' ';
    plain_ += word;
  }

  [[noreturn]] void fail(std::string_view wanted, std::string_view found) {
    const std::string what = found.empty() ? "the end of the file" : fmt::format("\"{:.40}\"", found);
    throw Error(ErrorCode::bad_mesh,
                fmt::format("malformed text STL: expected {}, found {}; export the file again", wanted, what),
                {file_, line_, 0});
  }

  std::string_view text_;
  std::string file_, word_, plain_;
  std::size_t at_ = 0, end_ = 0;
  std::size_t facets_ = 0, passed_over_ = 0;
  std::vector<Solid> solids_;
  int line_ = 1;
};

/// Whether it is text: comments, then the word.
bool begins_as_text(std::string_view content) {
  std::string head = lower(content.substr(0, 1024));
  std::size_t at = head.find_first_not_of(" \t\r\n");
  while (at != std::string::npos && head[at] == '#')
    at = head.find_first_not_of(" \t\r\n", std::min(head.find('\n', at), head.size()));
  if (at == std::string::npos || head.compare(at, 5, "solid") != 0) return false;
  const std::size_t zero = head.find('\0');
  return zero == std::string::npos || head.find("endsolid") < zero;  // padding, behind a small part
}

StlFile checked_text(const std::string& written, const std::string& file) {
  StlGrammar grammar(written, file);
  grammar.check();
  StlFile stl{false, std::move(grammar.plain()), grammar.facets(), std::move(grammar.solids())};
  if (grammar.passed_over() > 0)
    stl.notes.push_back(fmt::format("{} behind statements of the format, of no meaning there, are ignored",
                                    counted(grammar.passed_over(), "word", "words")));
  if (const std::size_t behind = written.size() - grammar.end(); behind > 0)
    stl.notes.push_back(fmt::format("{} bytes after the last solid are ignored", behind));
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
