#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "core/csv_headings.hpp"
#include "core/csv_lines.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/reader.hpp"

namespace bernal {

// Each in its own file, src/formats/read_<name>.cpp; openmc in that of npy.
const PackingReader& gsd_reader();
const PackingReader& openmc_reader();
const PackingReader& npy_reader();
const PackingReader& dump_reader();
const PackingReader& lammps_reader();
const PackingReader& yade_reader();
const PackingReader& esys_reader();
const PackingReader& mfix_reader();
const PackingReader& pfc_reader();
const PackingReader& povray_reader();
const PackingReader& extxyz_reader();
const PackingReader& vtk_reader();
const PackingReader& table_reader();

/// A line a format, in the order in which files are held against them: the last takes any.
constexpr std::array all_readers = {gsd_reader,    openmc_reader, npy_reader,  vtk_reader,  dump_reader,
                                    lammps_reader, yade_reader,   esys_reader, mfix_reader, pfc_reader,
                                    povray_reader, extxyz_reader, table_reader};

std::span<const PackingReader* const> packing_readers() {
  static const auto readers = [] {
    std::array<const PackingReader*, all_readers.size()> made;
    for (std::size_t k = 0; k < made.size(); ++k) made[k] = &all_readers[k]();
    return made;
  }();
  return readers;
}

std::vector<ImportFormat> import_formats() {
  std::vector<ImportFormat> all;
  for (const PackingReader* reader : packing_readers()) all.push_back(reader->about);
  return all;
}

namespace {

FileBeginning beginning_of(const std::filesystem::path& file) {
  FileBeginning beginning{file, file.extension().string(), std::string(8192, '\0')};
  for (char& c : beginning.ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  std::ifstream in(file, std::ios::binary);
  in.read(beginning.bytes.data(), static_cast<std::streamsize>(beginning.bytes.size()));
  beginning.bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (beginning.bytes.starts_with("\xEF\xBB\xBF")) beginning.bytes.erase(0, 3);
  return beginning;
}

constexpr std::string_view zero_byte("\0", 1);

/// What other programs pack or write letters into, by its first bytes.
struct Wrapping {
  std::string_view bytes, words;
};
constexpr Wrapping wrappings[] = {
    {"\x1F\x8B", "is compressed by gzip; unpack it first, with gunzip -k"},
    {"\xFD"
     "7zXZ",
     "is compressed by xz; unpack it first, with unxz -k"},
    {"\x28\xB5\x2F\xFD", "is compressed by zstd; unpack it first, with unzstd"},
    {"PK\x03\x04", "is a zip archive or an office document; unpack it, or save the sheet as CSV"},
    {"\xFF\xFE", "is text in UTF-16; save it in UTF-8, with iconv -f UTF-16 -t UTF-8"},
    {"\xFE\xFF", "is text in UTF-16; save it in UTF-8, with iconv -f UTF-16 -t UTF-8"},
};

/// LAMMPS begins a binary dump with the length of this word, which is negative, or with a step.
bool is_binary_dump(std::string_view bytes) {
  std::string start;
  for (const char c : bytes.substr(0, 64))
    start += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return start.find("dumpcustom") != start.npos || start.find("dumpatom") != start.npos;
}

/// Text that is no table, by its first bytes.
constexpr Wrapping no_tables[] = {
    {"<", "is XML or HTML, and none that is known; save a table, such as CSV, or VTK points (.vtp)"},
    {"{", "is JSON, which is not read; save a table, such as CSV"},
    {"solid ", "is a surface (STL), and no packing; as a container it is for bernal inspect and for scenes"},
    {"ply\n", "is a surface or points in PLY, which is not read; save a table, such as CSV"},
    {"OFF\n", "is a surface (OFF), and no packing; as a container it is for bernal inspect and for scenes"},
};

void require_readable(const FileBeginning& file) {
  const auto refuse = [&](std::string_view words) {
    throw Error(ErrorCode::bad_packing, std::string(words), {file.file.string()});
  };
  for (const Wrapping& wrapping : wrappings)
    if (file.begins(wrapping.bytes)) refuse(wrapping.words);
  if (file.has(zero_byte)) {
    if (is_binary_dump(file.bytes))
      refuse(
          "is a binary dump of LAMMPS; dump it as text, under a name that does not end in .bin, or turn it "
          "into text with LAMMPS's binary2txt");
    return;
  }
  const std::size_t turn = file.bytes.find('\r');
  if (turn < file.bytes.size() - 1 && !file.has("\n"))
    refuse(
        "ends its lines in CR alone, as text of old Macs does; write it with line feeds, with tr '\\r' "
        "'\\n'");
}

const PackingReader& reader_named(const std::string& name) {
  std::vector<std::string_view> names;
  for (const PackingReader* reader : packing_readers()) {
    if (reader->about.name == name) return *reader;
    names.emplace_back(reader->about.name);
  }
  throw Error(ErrorCode::bad_argument,
              fmt::format("unknown format \"{}\"{}", plain_text(name), remedy(name, names)));
}

void require_option(const PackingReader& reader, const std::string& option) {
  const auto has = [&](const PackingReader& of) {
    return std::ranges::find(of.about.options, option) != of.about.options.end();
  };
  if (has(reader)) return;
  std::vector<std::string_view> others;
  for (const PackingReader* other : packing_readers())
    if (has(*other)) others.emplace_back(other->about.name);
  throw Error(ErrorCode::bad_argument,
              fmt::format("the format {} takes no --{}; these do: {}; --from says which the file is",
                          reader.about.name, option, fmt::join(others, ", ")));
}

}  // namespace

const PackingReader& reader_of(const std::filesystem::path& file, const ImportOptions& options) {
  const FileBeginning beginning = beginning_of(file);
  require_readable(beginning);
  const PackingReader* reader = nullptr;
  if (!options.format.empty()) {
    reader = &reader_named(options.format);
  } else {
    reader = *std::ranges::find_if(packing_readers(),
                                   [&](const PackingReader* one) { return one->recognises(beginning); });
    if (reader == packing_readers().back() && beginning.has(zero_byte))
      throw Error(
          ErrorCode::bad_packing,
          "holds bytes that are no text, and is of no binary format that is known; write it as text, such as "
          "a CSV or a text dump",
          {file.string()});
    for (const Wrapping& other : no_tables)
      if (reader == packing_readers().back() && beginning.begins(other.bytes))
        throw Error(ErrorCode::bad_packing, std::string(other.words), {file.string()});
  }
  if (!options.columns.empty()) require_option(*reader, "columns");
  if (options.frame) require_option(*reader, "frame");
  if (options.radii) require_option(*reader, "radii");
  return *reader;
}

std::vector<std::string_view> clauses_of(std::string_view remark) {
  std::vector<std::string_view> clauses;
  constexpr std::string_view between = ";,\n", around = " \t\r#%!/.";
  for (std::size_t at = 0; (at = remark.find_first_not_of(between, at)) != remark.npos;) {
    const std::size_t end = std::min(remark.find_first_of(between, at), remark.size());
    if (const std::string_view clause = stripped(remark.substr(at, end - at), around); !clause.empty())
      clauses.push_back(clause);
    at = end;
  }
  return clauses;
}

std::optional<std::string_view> unit_in_clause(std::string_view clause) {
  for (const std::string_view mark : {"lengths in ", "unit: ", "units: "}) {
    if (!clause.starts_with(mark)) continue;
    const std::string_view rest = stripped(clause.substr(mark.size()), " \t");
    const bool is_text = rest.find_first_of(" \t") != rest.npos && !is_number(rest);
    if (!is_text) return rest;
  }
  return {};
}

void take_unit_of_remark(std::string_view remark, std::optional<Unit>& unit, const Location& where) {
  for (const std::string_view clause : clauses_of(remark)) {
    const auto word = unit_in_clause(clause);
    if (!word) continue;
    const std::string_view name = unit_in_letters(*word);
    if (const std::string complaint = complaint_of_unit(name); !complaint.empty())
      throw Error(ErrorCode::bad_packing,
                  complaint + "; convert the file, or take this remark out and give --unit", where);
    if (unit && *unit != unit_named(name))
      throw Error(
          ErrorCode::bad_packing,
          fmt::format("this line says that the unit is {}, and one before it says {}", name, name_of(*unit)),
          where);
    unit = unit_named(name);
  }
}

void refuse_skewed(const std::filesystem::path& file, int line) {
  throw Error(
      ErrorCode::bad_packing,
      "the box is skewed (triclinic), and only upright ones are known; write the packing in an upright "
      "box",
      {file.string(), line});
}

int frame_of(const Reading& reading, int frames) {
  const int wanted = reading.options.frame.value_or(frames);
  if (wanted < 1 || wanted > frames)
    throw Error(ErrorCode::bad_argument,
                fmt::format("there is no frame {}; the file has {}, and the first is 1", wanted, frames),
                {reading.file.string()});
  return wanted;
}

}  // namespace bernal
