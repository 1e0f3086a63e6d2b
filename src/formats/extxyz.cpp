#include <cmath>
#include <map>

#include <fmt/format.h>

#include "bernal/version.hpp"
#include "core/lower_case.hpp"
#include "files/csv_headings.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

/// X is the name of no element, for readers that know elements; so types have a column of their own.
void write_extxyz(const Exported& file, TextFile& out) {
  const Bounds<3> box = file.box();
  const Vector<3> size = box.size();
  const auto [xy, xz, yz] = file.tilt();
  const bool typed = file.type_count > 1;
  out.add(file.size(), "\nLattice=\"", size[0], " 0 0 ", xy, ' ', size[1], " 0 ", xz, ' ', yz, ' ', size[2],
          "\" Origin=\"", row_of(box.lower), "\" pbc=\"", file.periods_as("T", "F"),
          "\" Properties=id:I:1:species:S:1:pos:R:3:radius:R:1", typed ? ":class:I:1" : "",
          " unit=", name_of(file.unit()), " packing_fraction=", file.packing.packing_fraction(),
          " generator=\"bernal ", text_of(this_program()), "\"\n");
  for (std::size_t i = 0; i < file.size(); ++i) {
    out.add(i + 1, " X ", file.coordinate(0, i), ' ', file.coordinate(1, i), ' ', file.coordinate(2, i), ' ',
            file.spheres.r[i]);
    if (typed) out.add(' ', file.types[i]);
    out.add('\n');
  }
}

using Keys = std::map<std::string, std::string, std::less<>>;

/// key=value, key="value" and words without a value, with keys in lower case. Throws for an unclosed
/// quotation mark and for a key with two different values.
Keys keys_in(const ForeignLines& lines) {
  std::string_view line = lines.line();
  Keys keys;
  while (!(line = stripped(line, " \t")).empty()) {
    const std::size_t sign = line.find_first_of("= \t");
    const auto [place, is_new] = keys.try_emplace(in_lower_case(line.substr(0, sign)));
    std::string& value = place->second;
    if (sign == line.npos) break;
    const bool has_value = line[sign] == '=';
    line.remove_prefix(sign + 1);
    if (!has_value) continue;
    const char open = line.empty() ? ' ' : line[0];
    const char close = open == '{' ? '}' : open == '[' ? ']' : open;
    const bool is_quoted = open == '"' || open == '\'' || open == '{' || open == '[';
    const std::size_t from = is_quoted ? 1 : 0;
    const std::size_t end = is_quoted ? line.find(close, 1) : line.find_first_of(" \t");
    if (is_quoted && end == line.npos)
      lines.fail(fmt::format("{} is not closed behind {}; close it, or take it out",
                             bernal::quoted(std::string_view(&open, 1)), bernal::quoted(place->first)));
    const std::string_view said = line.substr(from, end == line.npos ? line.npos : end - from);
    if (!is_new && value != said)
      lines.fail(fmt::format("{} stands twice in this line, with two values", bernal::quoted(place->first)));
    value = said;
    line.remove_prefix(end == line.npos ? line.size() : end + from);
  }
  return keys;
}

std::vector<double> numbers_of(const Keys& keys, std::string_view key, const ForeignLines& lines) {
  std::vector<double> numbers;
  const auto found = keys.find(key);
  if (found == keys.end()) return numbers;
  std::vector<std::string_view> words;
  split_at(found->second, " \t,", words);
  for (const std::string_view word : words) numbers.push_back(lines.number(word, key));
  return numbers;
}

/// Cells that were rotated or made from lengths and angles have such residues instead of 0.
constexpr double rounding_of_edge = 1e-12;

/// From Lattice, Origin and pbc.
std::optional<FileBox> lattice_box(const Keys& keys, const Reading& reading, const ForeignLines& lines) {
  const std::vector<double> lattice = numbers_of(keys, "lattice", lines);
  std::vector<double> origin = numbers_of(keys, "origin", lines);
  const auto pbc = keys.find("pbc");
  if (lattice.empty()) {
    const bool is_asked =
        pbc != keys.end() && in_lower_case(pbc->second).find_first_of("t1") != std::string::npos;
    const ImportOptions& options = reading.options;
    if (is_asked && options.box.empty() && !options.container)
      lines.fail("pbc says that axes repeat themselves, and no Lattice says how long they are; give ‹box›");
    return {};
  }
  if (lattice.size() != 9) lines.fail("Lattice needs nine numbers");
  if (origin.empty()) origin.resize(3);
  if (origin.size() != 3) lines.fail("Origin needs three numbers");
  FileBox box{origin, origin, std::vector<AxisEnd>(3, AxisEnd::period)};  // ASE's default
  for (std::size_t k = 0; k < 9; ++k) {
    if (k % 4 == 0) box.upper[k / 4] += lattice[k];
    const double edge = lattice[k / 3 * 4];
    if (k % 4 == 0 || !(std::abs(lattice[k]) > rounding_of_edge * std::abs(edge))) continue;
    if (k % 3 > k / 3) refuse_skewed(reading, lines.number());
    box.tilt[k == 3 ? 0 : k == 6 ? 1 : 2] = lattice[k];
  }
  if (pbc != keys.end()) {
    std::vector<std::string_view> words;
    split_at(pbc->second, " \t,", words);
    if (words.size() != 3) lines.fail("pbc needs three letters, T or F");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string word = in_lower_case(words[k]);
      const bool is_true = word == "t" || word == "true" || word == "1";
      if (!is_true && word != "f" && word != "false" && word != "0")
        lines.fail(fmt::format("pbc has {}, which is neither T nor F", bernal::quoted(words[k])));
      box.ends[k] = is_true ? AxisEnd::period : AxisEnd::wall;
    }
  }
  return box;
}

/// From the key "unit" or "units".
std::optional<Unit> unit_of_keys(const Keys& keys, const ForeignLines& lines) {
  std::optional<Unit> unit;
  for (const std::string_view key : {"unit", "units"}) {
    const auto said = keys.find(key);
    if (said == keys.end()) continue;
    take_unit(said->second, "the key", unit, {lines.file(), lines.number()});
  }
  return unit;
}

/// The columns listed by "species:S:1:pos:R:3:radius:R:1".
std::vector<std::string> property_columns(const Keys& keys, const ForeignLines& lines) {
  const auto said = keys.find("properties");
  if (said == keys.end()) return {"species", "x", "y", "z"};
  constexpr std::size_t most_columns = 1000;
  std::vector<std::string_view> parts;
  split_at(said->second, ":", parts);
  if (parts.size() % 3 != 0)
    lines.fail("Properties must be name:type:columns, and again: species:S:1:pos:R:3:radius:R:1");
  std::vector<std::string> columns;
  for (std::size_t k = 0; k < parts.size(); k += 3) {
    const std::uint64_t count = lines.whole(parts[k + 2], "columns");
    if (count > most_columns - columns.size())
      lines.fail(fmt::format("Properties has more than {} columns", most_columns));
    const std::string name = in_lower_case(parts[k]);
    for (std::uint64_t c = 0; c < count; ++c)
      columns.push_back(name == "pos" && count == 3 ? std::string(1, "xyz"[c])
                        : count == 1                ? name
                                                    : fmt::format("{}[{}]", name, c));
  }
  return columns;
}

/// The line with the number of atoms in a frame; false at the end of the file.
bool read_count(ForeignLines& lines, std::uint64_t& count) {
  while (lines.next()) {
    const auto words = lines.words();
    if (words.empty()) continue;
    if (words.size() > 1) lines.fail("a frame begins with the number of its atoms alone on a line");
    count = lines.whole(words[0], "the number of atoms");
    return true;
  }
  return false;
}

int count_xyz_frames(const Reading& reading) {
  ForeignLines lines(reading);
  int frames = 0;
  for (std::uint64_t count = 0; read_count(lines, count); ++frames)
    for (std::uint64_t k = 0; k <= count; ++k)
      if (!lines.next()) {
        if (frames > 0 && reading.options.frame && *reading.options.frame <= frames) return frames;
        lines.fail(fmt::format("the file ends in its frame {}, after {} of {} atoms{}", frames + 1,
                               k > 0 ? k - 1 : 0, count,
                               frames > 0 ? fmt::format("; ‹frame={}› is whole", frames) : ""));
      }
  if (frames == 0) lines.refuse_empty();
  return frames;
}

FileContents read_extxyz(const Reading& reading) {
  const int frames = count_xyz_frames(reading), wanted = frame_of(reading, frames);
  ForeignLines lines(reading);
  std::uint64_t count = 0;
  for (int frame = 1; read_count(lines, count) && frame < wanted; ++frame)
    for (std::uint64_t k = 0; k <= count; ++k) lines.next();
  lines.require_next("the line that says what the columns are");
  FileContents contents;
  const Keys keys = keys_in(lines);
  contents.unit = unit_of_keys(keys, lines);
  contents.box = lattice_box(keys, reading, lines);
  const std::vector<std::string> names = property_columns(keys, lines);
  const SphereColumns columns = sphere_columns({}, names, lines);
  contents.spheres = columns.no_spheres();
  for (std::uint64_t k = 0; k < count; ++k) {
    lines.require_next("an atom");
    const auto row = lines.words();
    if (row.size() < names.size() || (row.size() > names.size() && keys.contains("properties")))
      lines.fail(fmt::format("{} columns, but Properties names {}", row.size(), names.size()));
    add_row(lines, columns, row, contents.spheres);
  }
  contents.note = fmt::format("frame {} of {}", wanted, frames);
  return contents;
}

/// A number alone in the first line, and keys in the second; or the file's name.
bool is_extxyz(const FileBeginning& file) {
  const std::string_view bytes = file.bytes;
  const std::size_t end = bytes.find('\n');
  const std::string_view first = stripped(bytes.substr(0, end), " \t\r");
  if (first.empty() || first.find_first_not_of("0123456789") != first.npos) return false;
  if (file.ending == ".xyz" || file.ending == ".extxyz") return true;
  const std::string_view second =
      end == bytes.npos ? std::string_view() : bytes.substr(end + 1, bytes.find('\n', end + 1) - end - 1);
  return second.find("Properties=") != second.npos || second.find("Lattice=") != second.npos;
}

}  // namespace

Format extxyz_format() {
  return {
      .name = "extxyz",
      .writes = "extended XYZ, for OVITO and ASE",
      .keys = {"unit", "types"},
      .file = "extxyz.xyz",
      .least_dimension = 2,
      .tilted = true,
      .repeated_mesh = true,
      .write_text = write_extxyz,
      .reads =
          "extended XYZ of OVITO and ASE: Lattice, pbc, Properties with radius or diameter; the last frame",
      .unit_from = "unit=mm among its keys, or ‹unit›",
      .options = {"frame"},
      .recognises = is_extxyz,
      .read = read_extxyz};
}

}  // namespace bernal
