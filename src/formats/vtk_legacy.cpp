#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/lower_case.hpp"
#include "files/csv_headings.hpp"
#include "files/csv_lines.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/vtk.hpp"

namespace bernal {
namespace {

constexpr std::uint64_t most_numbers = std::uint64_t{1} << 40;

/// A text read by words, lines or bytes.
class LegacyText {
 public:
  LegacyText(std::string_view text, const std::filesystem::path& file) : text_(text), file_(file.string()) {}

  std::size_t left() const { return text_.size() - at_; }
  /// The next line, possibly empty.
  std::string_view line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    go_to(std::min(end + 1, text_.size()));
    return stripped(line, vtk_blanks);
  }
  /// The words of the next line that has any. Empty at the end of the file.
  std::vector<std::string_view> words_of_line() {
    skip_blanks();
    line_of_words_ = number_;
    std::vector<std::string_view> words;
    split_at(line(), vtk_blanks, words);
    return words;
  }
  std::string_view word() {
    skip_blanks();
    const std::size_t end = std::min(text_.find_first_of(vtk_blanks, at_), text_.size());
    const std::string_view word = text_.substr(at_, end - at_);
    line_of_words_ = number_;
    go_to(end);
    return word;
  }
  /// Goes back to a word of the text.
  void go_back_to(std::string_view word) { at_ = static_cast<std::size_t>(word.data() - text_.data()); }
  std::string_view bytes(std::uint64_t count) {
    if (count > left())
      fail(fmt::format("{} bytes should follow, and {} are left; was the file cut off?", count, left()));
    const std::string_view bytes = text_.substr(at_, count);
    at_ += count;
    return bytes;
  }
  std::uint64_t whole(std::string_view word) const {
    const std::optional<std::uint64_t> value = whole_number(word);
    if (!value || *value > most_numbers)
      fail(fmt::format("{} is not a number of points, cells or components; save the file again with ParaView",
                       bernal::quoted(word)));
    return *value;
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw Error(ErrorCode::bad_packing, why, {file_, line_of_words_});
  }

 private:
  void skip_blanks() { go_to(std::min(text_.find_first_not_of(vtk_blanks, at_), text_.size())); }
  void go_to(std::size_t end) {
    number_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                           text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
    at_ = end;
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int number_ = 1, line_of_words_ = 1;
};

std::optional<RawNumber> legacy_number(std::string_view type) {
  constexpr std::pair<std::string_view, RawNumber> types[] = {
      {"float", {'f', 4}},          {"double", {'f', 8}},
      {"char", {'i', 1}},           {"signed_char", {'i', 1}},
      {"unsigned_char", {'u', 1}},  {"short", {'i', 2}},
      {"unsigned_short", {'u', 2}}, {"int", {'i', 4}},
      {"unsigned_int", {'u', 4}},   {"long", {'i', 8}},
      {"unsigned_long", {'u', 8}},  {"vtkidtype", {'i', 4}},
      {"vtktypeint64", {'i', 8}},   {"vtktypeuint64", {'u', 8}},
      {"vtktypeint32", {'i', 4}},   {"vtktypeuint32", {'u', 4}},
      {"vtktypefloat32", {'f', 4}}, {"vtktypefloat64", {'f', 8}}};
  const std::string lower = in_lower_case(type);
  for (const auto& [name, number] : types)
    if (name == lower) return RawNumber{number.kind, number.bytes, true};  // the format's byte order
  return {};
}

/// Keywords are case-insensitive.
std::string in_capitals(std::string_view word) {
  std::string capitals(word);
  for (char& c : capitals)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return capitals;
}

/// Decodes "%20" in a name to a blank.
std::string decoded(std::string_view name) {
  std::string plain;
  for (std::size_t k = 0; k < name.size(); ++k) {
    int code = 0;
    const bool is_code =
        name[k] == '%' && k + 2 < name.size() &&
        std::from_chars(name.data() + k + 1, name.data() + k + 3, code, 16).ptr == name.data() + k + 3;
    plain += is_code ? static_cast<char>(code) : name[k];
    if (is_code) k += 2;
  }
  return plain;
}

class LegacyReader {
 public:
  LegacyReader(std::string_view text, const std::filesystem::path& file) : in_(text, file) {}

  VtkPoints read() {
    const auto first = in_.words_of_line();
    if (first.size() > 4) is_offsets_ = first[4][0] >= '5';
    points_.remarks = in_.line();
    const auto kind = in_.words_of_line();
    const std::string encoding = kind.size() == 1 ? in_capitals(kind[0]) : std::string();
    if (encoding != "ASCII" && encoding != "BINARY")
      in_.fail("the third line has to be ASCII or BINARY; put that word there, or save the file again");
    is_binary_ = encoding == "BINARY";
    const auto set = in_.words_of_line();
    if (set.size() != 2 || in_capitals(set[0]) != "DATASET")
      in_.fail("the line DATASET POLYDATA is expected here; put it there, or save the file again");
    const std::string of = in_capitals(set[1]);
    if (of != "POLYDATA" && of != "UNSTRUCTURED_GRID")
      in_.fail(fmt::format("a VTK {} has no spheres; save points with radii as POLYDATA or UNSTRUCTURED_GRID",
                           bernal::quoted(set[1])));
    points_.kind = fmt::format("{} {}", of == "POLYDATA" ? "PolyData" : "UnstructuredGrid",
                               is_binary_ ? "binary" : "ASCII");
    for (;;) {
      const auto words = in_.words_of_line();
      if (words.empty()) break;
      take(words);
    }
    if (!has_points_) in_.fail("no line POINTS stands in the file; was it cut off?");
    return std::move(points_);
  }

 private:
  void need(const std::vector<std::string_view>& words, std::size_t count) {
    if (words.size() < count)
      in_.fail(fmt::format("{} needs {} words; was the line cut off?", bernal::quoted(words[0]), count));
  }
  std::vector<double> numbers(std::string_view type, std::uint64_t rows, std::uint64_t components) {
    const std::uint64_t count = rows == 0                          ? 0
                                : components > most_numbers / rows ? most_numbers
                                                                   : rows * components;
    std::vector<double> values;
    if (type == "bit" && is_binary_) {  // useless for spheres
      in_.bytes((count + 7) / 8);
      values.assign(count, 0);
      return values;
    }
    const std::optional<RawNumber> number = legacy_number(type);
    if (!number && type != "bit") in_.fail(type_error(type));
    if (is_binary_) {
      const auto bytes = static_cast<std::uint64_t>(number->bytes);
      append_raw_numbers(in_.bytes(count > most_numbers / 8 ? most_numbers : count * bytes), *number, values);
      return values;
    }
    for (std::uint64_t k = 0; k < count; ++k) {
      const std::string_view word = in_.word();
      if (word.empty())
        in_.fail(fmt::format("the file ends after {} of {} numbers; was it cut off?", k, count));
      const std::optional<double> value = number_in_text(word);
      if (!value)
        in_.fail(fmt::format("{} is not a number; correct it, or save the file again", bernal::quoted(word)));
      values.push_back(*value);
    }
    return values;
  }

  void take(const std::vector<std::string_view>& words) {
    const std::string word = in_capitals(words[0]);
    if (word == "POINTS") return take_points(words);
    if (word == "VERTICES" || word == "LINES" || word == "POLYGONS" || word == "TRIANGLE_STRIPS" ||
        word == "CELLS")
      return take_cells(words);
    if (word == "CELL_TYPES") return take_cell_types(words);
    if (word == "POINT_DATA" || word == "CELL_DATA") return take_section(words);
    if (word == "FIELD") return take_field(words);
    if (word == "METADATA") {
      while (!in_.line().empty()) {
      }
      return;
    }
    if (section_ == Section::none)
      in_.fail(fmt::format(
          "{} is not understood; it is no part of a VTK file of points: take it out, or save the file "
          "again with ParaView",
          bernal::quoted(word)));
    take_attribute(words);
  }

  void take_points(const std::vector<std::string_view>& words) {
    need(words, 3);
    if (std::exchange(has_points_, true)) in_.fail("a second section POINTS; leave one of them in the file");
    count_ = in_.whole(words[1]);
    if (words.size() > 3) in_.go_back_to(words[3]);  // all numbers are in one line
    points_.places = numbers(std::string(words[2]), count_, 3);
  }

  /// Reads the cells; only vertices are accepted, because faces mean that the points are corners.
  void take_cells(const std::vector<std::string_view>& words) {
    need(words, 3);
    const std::string word = in_capitals(words[0]);
    const std::uint64_t cells = in_.whole(words[1]), numbers_of_cells = in_.whole(words[2]);
    if ((word == "POLYGONS" || word == "TRIANGLE_STRIPS") && cells > 0) in_.fail(faces_error(cells));
    if (!is_offsets_) {
      numbers("int", numbers_of_cells, 1);
      return;
    }
    for (const std::uint64_t count : {cells, numbers_of_cells}) {
      const auto part = in_.words_of_line();
      const std::string what = part.size() == 2 ? in_capitals(part[0]) : std::string();
      if (what != "OFFSETS" && what != "CONNECTIVITY")
        in_.fail(fmt::format(
            "OFFSETS and CONNECTIVITY are expected after {}; save the file again with ParaView", word));
      numbers(std::string(part[1]), count, 1);
    }
  }
  void take_cell_types(const std::vector<std::string_view>& words) {
    need(words, 2);
    const std::vector<double> types = numbers("int", in_.whole(words[1]), 1);
    const auto faces = std::ranges::count_if(types, is_face);
    if (faces > 0) in_.fail(faces_error(static_cast<std::uint64_t>(faces)));
  }
  void take_section(const std::vector<std::string_view>& words) {
    need(words, 2);
    section_ = in_capitals(words[0]) == "POINT_DATA" ? Section::points : Section::cells;
    rows_ = in_.whole(words[1]);
    if (section_ == Section::points && (!has_points_ || rows_ != count_))
      in_.fail(fmt::format("the data are of {} points, and there are {}; was the file put together?", rows_,
                           count_));
  }

  /// Reads a field of several arrays, each with a heading.
  void take_field(const std::vector<std::string_view>& words) {
    need(words, 3);
    for (std::uint64_t k = 0, arrays = in_.whole(words[2]); k < arrays; ++k) {
      auto head = in_.words_of_line();
      if (!head.empty() && in_capitals(head[0]) == "METADATA") {
        take(head);
        head = in_.words_of_line();
      }
      if (head.size() != 4)
        in_.fail("a name, components, rows and a type are expected here; was the file cut off?");
      const std::string name = decoded(head[0]), type(head[3]);
      const std::uint64_t components = in_.whole(head[1]), rows = in_.whole(head[2]);
      if (type == "string" && !is_binary_) {
        for (std::uint64_t line = 0; line < rows && in_.left() > 0; ++line) in_.line();
        continue;
      }
      if (section_ == Section::points && rows != rows_)
        in_.fail(fmt::format(
            "the array {} has {} rows, and there are {} points; take it out, or save the file again",
            bernal::quoted(name), rows, rows_));
      add(name, components, numbers(type, rows, components));
    }
  }

  void take_attribute(const std::vector<std::string_view>& words) {
    need(words, 3);
    const std::string word = in_capitals(words[0]), name = decoded(words[1]), last(words[2]);
    if (word == "SCALARS") {
      const std::uint64_t components = words.size() > 3 ? in_.whole(words[3]) : 1;
      const auto table = in_.words_of_line();
      if (table.size() != 2 || in_capitals(table[0]) != "LOOKUP_TABLE")
        in_.fail(fmt::format(
            "the line LOOKUP_TABLE is expected after SCALARS {}; put \"LOOKUP_TABLE default\" there", name));
      return add(name, components, numbers(last, rows_, components));
    }
    if (word == "VECTORS" || word == "NORMALS") return add(name, 3, numbers(last, rows_, 3));
    if (word == "TENSORS") return add(name, 9, numbers(last, rows_, 9));
    if (word == "TENSORS6") return add(name, 6, numbers(last, rows_, 6));
    if (word == "GLOBAL_IDS" || word == "PEDIGREE_IDS") return add(name, 1, numbers(last, rows_, 1));
    if (word == "TEXTURE_COORDINATES") {
      need(words, 4);
      const std::uint64_t components = in_.whole(words[2]);
      return add(name, components, numbers(std::string(words[3]), rows_, components));
    }
    const std::string of_colours = is_binary_ ? "unsigned_char" : "float";
    if (word == "COLOR_SCALARS")
      return add(name, in_.whole(words[2]), numbers(of_colours, rows_, in_.whole(words[2])));
    if (word == "LOOKUP_TABLE") {
      numbers(of_colours, in_.whole(words[2]), 4);
      return;
    }
    in_.fail(fmt::format("{} is not understood; was the file put together or cut off before it?",
                         bernal::quoted(word)));
  }
  void add(const std::string& name, std::uint64_t components, std::vector<double> values) {
    if (section_ == Section::points) points_.arrays.push_back({name, components, std::move(values)});
  }

  enum class Section : std::uint8_t { none, points, cells };

  LegacyText in_;
  VtkPoints points_;
  bool is_binary_ = false, is_offsets_ = false, has_points_ = false;
  Section section_ = Section::none;
  std::uint64_t count_ = 0, rows_ = 0;
};

}  // namespace

VtkPoints read_vtk_legacy(std::string_view text, const std::filesystem::path& file) {
  return LegacyReader(text, file).read();
}

}  // namespace bernal
