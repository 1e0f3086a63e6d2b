#include <algorithm>
#include <charconv>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/formats/export.hpp"
#include "core/lower_case.hpp"
#include "formats/format.hpp"

namespace bernal {

// Each is in the file of its name. Files are tested by the readers in this order; the last accepts any.
Format vtk_format();
Format dump_format();
Format lammps_format();
Format liggghts_format();
Format yade_format();
Format esys_format();
Format extxyz_format();
Format gsd_format();
Format pfc_format();
Format mfix_format();
Format openmc_format();
Format serpent_format();
Format scone_format();
Format mcnp_format();
Format povray_format();
Format npy_format();
Format gmsh_format();
Format step_format();  // in cad.cpp, with brep
Format brep_format();
Format stl_format();
Format obj_format();
Format ply_format();
Format threemf_format();
Format gltf_format();
Format snappy_format();
Format nrrd_format();  // in images.cpp, with the next three
Format vti_format();
Format tiff_format();
Format raw_format();
Format flat_format();
Format table_format();

namespace {

const std::vector<Format>& formats() {
  static const std::vector<Format> all = {
      vtk_format(),    dump_format(), lammps_format(), liggghts_format(), yade_format(),    esys_format(),
      extxyz_format(), gsd_format(),  pfc_format(),    mfix_format(),     openmc_format(),  serpent_format(),
      scone_format(),  mcnp_format(), povray_format(), npy_format(),      gmsh_format(),    step_format(),
      brep_format(),   stl_format(),  obj_format(),    ply_format(),      threemf_format(), gltf_format(),
      snappy_format(), nrrd_format(), vti_format(),    tiff_format(),     raw_format(),     flat_format(),
      table_format()};
  return all;
}

/// The readers, in the order in which they are tried on a file.
const std::vector<const Format*>& readers() {
  static const auto all = [] {
    std::vector<const Format*> made;
    for (const Format& format : formats())
      if (format.read) made.push_back(&format);
    return made;
  }();
  return all;
}

OutputTable table_for(const Format& format) {
  OutputTable made{.keys = output_entry(format.name, format.writes, format.keys),
                   .file = format.file,
                   .endings = format.endings,
                   .alone = format.alone,
                   .least_dimension = format.least_dimension,
                   .most_dimensions = format.most_dimensions,
                   .unit = format.unit,
                   .sizes = format.sizes,
                   .is_folder = format.is_folder,
                   .tilted = format.tilted,
                   .repeated_mesh = format.repeated_mesh};
  made.keys.choices.insert(made.keys.choices.end(), format.choices.begin(), format.choices.end());
  made.keys.rule = format.rule;
  return made;
}

/// A word of a command line as a value; absent if it is not of that type.
std::optional<schema::Value> value_of_word(const schema::Key& key, const std::string& word) {
  const auto number = [&](auto value) -> std::optional<schema::Value> {
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (problem != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return value;
  };
  switch (key.type) {
    case schema::Type::integer:
      return number(std::int64_t{});
    case schema::Type::number:
    case schema::Type::length:
      return number(double{});
    case schema::Type::flag:
      if (word == "true" || word == "false") return word == "true";
      return std::nullopt;
    default:
      return word;
  }
}

[[noreturn]] void refuse_word(const std::string& what) { throw Error(ErrorCode::bad_argument, what); }

/// The entry with this name in a list of formats or tables.
template <class List, class Name>
const auto& named(const List& all, std::string_view name, const Name& name_of) {
  std::vector<std::string_view> names;
  for (const auto* one : all) {
    if (name_of(*one) == name) return *one;
    names.push_back(name_of(*one));
  }
  refuse_word(fmt::format("unknown format \"{}\"{}", plain_text(name), remedy(name, names)));
}

FileBeginning beginning_of(const std::filesystem::path& file) {
  FileBeginning beginning{file, in_lower_case(file.extension().string()), std::string(8192, '\0')};
  std::ifstream in(file, std::ios::binary);
  in.read(beginning.bytes.data(), static_cast<std::streamsize>(beginning.bytes.size()));
  beginning.bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (beginning.bytes.starts_with("\xEF\xBB\xBF")) beginning.bytes.erase(0, 3);
  return beginning;
}

/// Contents that no format has, by their first bytes, with the remedy.
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
/// Text that is not a table.
constexpr Wrapping no_tables[] = {
    {"<", "is XML or HTML, and none that is known; save a table, such as CSV, or VTK points (.vtp)"},
    {"{", "is JSON, which is not read; save a table, such as CSV"},
    {"solid ", "is a surface (STL), and no packing; as a container it is for bernal inspect and for scenes"},
    {"ply\n", "is a surface or points in PLY, which is not read; save a table, such as CSV"},
    {"OFF\n", "is a surface (OFF), and no packing; as a container it is for bernal inspect and for scenes"},
};

void refuse_wrapped(const FileBeginning& file, std::span<const Wrapping> kinds) {
  for (const Wrapping& kind : kinds)
    if (file.begins(kind.bytes))
      throw Error(ErrorCode::bad_packing, std::string(kind.words), {file.file.string()});
}

bool has_zero_byte(const FileBeginning& file) { return file.has(std::string_view("\0", 1)); }

/// LAMMPS begins a binary dump with the length of this word, negative, or with a step.
bool is_binary_dump(std::string_view bytes) {
  const std::string start = in_lower_case(bytes.substr(0, 64));
  return start.find("dumpcustom") != start.npos || start.find("dumpatom") != start.npos;
}

void require_text(const FileBeginning& file) {
  const auto refuse = [&](const char* words) {
    throw Error(ErrorCode::bad_packing, words, {file.file.string()});
  };
  if (has_zero_byte(file)) {
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

const Format& reader_for(const FileBeginning& file) {
  const Format* const reader =
      *std::ranges::find_if(readers(), [&](const Format* one) { return one->recognises(file); });
  if (reader != readers().back()) return *reader;
  if (has_zero_byte(file))
    throw Error(
        ErrorCode::bad_packing,
        "holds bytes that are no text, and is of no binary format that is known; write it as text, such as "
        "a CSV or a text dump",
        {file.file.string()});
  refuse_wrapped(file, no_tables);
  return *reader;
}

void require_option(const Format& reader, const std::string& option) {
  const auto has = [&](const Format* of) {
    return std::ranges::find(of->options, option) != of->options.end();
  };
  if (has(&reader)) return;
  std::vector<std::string_view> others;
  for (const Format* other : readers())
    if (has(other)) others.emplace_back(other->name);
  refuse_word(fmt::format("the format {} takes no ‹{}›; these do: {}; ‹format› says which the file is",
                          reader.name, option, fmt::join(others, ", ")));
}

}  // namespace

std::span<const OutputTable* const> output_tables() {
  static const auto tables = [] {
    std::vector<OutputTable> made;
    for (const Format& format : formats())
      if (!format.writes.empty()) made.push_back(table_for(format));
    return made;
  }();
  static const auto pointers = [] {
    std::vector<const OutputTable*> made;
    for (const OutputTable& table : tables) made.push_back(&table);
    return made;
  }();
  return pointers;
}

const Format& format_of(const Output& output) {
  const std::string_view name = table_of(output).name();
  return *std::ranges::find(formats(), name, &Format::name);
}

std::vector<ExportFormat> export_formats() {
  std::vector<ExportFormat> all;
  for (const OutputTable* table : output_tables()) {
    ExportFormat& made =
        all.emplace_back(ExportFormat{std::string(table->name()),
                                      std::string(table->keys.help),
                                      std::string(table->file),
                                      table->unit ? std::string(name_of(*table->unit)) : "the scene's",
                                      std::string(table->sizes),
                                      table->least_dimension,
                                      table->most_dimensions,
                                      {}});
    for (const schema::Key& key : table->keys.keys)
      if (key.name != "file") made.keys.emplace_back(key.name);
  }
  return all;
}

std::vector<ExportKey> export_keys() {
  std::vector<ExportKey> all;
  for (const schema::Key& key : output_keys())
    if (key.name != "file") all.push_back({std::string(key.name), std::string(key.help)});
  return all;
}

Output output_of(std::string_view format, const std::map<std::string, std::string>& words) {
  if (format == "vtk" || format == "vtp" || format == "vtu")
    refuse_word(fmt::format(
        "unknown format \"{}\": a result has its spheres as spheres.vtp already, and vti is a grid "
        "of voxels",
        format));
  const OutputTable& table =
      named(output_tables(), format, [](const OutputTable& one) { return one.name(); });
  Output output{.format = std::string(format)};
  for (const auto& [name, word] : words) {
    const schema::Key* key = name == "file" ? nullptr : table.keys.find(name);
    if (!key) {
      std::vector<std::string_view> others;
      for (const OutputTable* other : output_tables())
        if (other->keys.find(name)) others.push_back(other->name());
      refuse_word(fmt::format(
          "the format {} takes no {}; {}", format, name,
          others.empty() ? "no format does" : fmt::format("these do: {}", fmt::join(others, ", "))));
    }
    const std::optional<schema::Value> value = value_of_word(*key, word);
    if (!value || !schema::accepts(*key, *value))
      refuse_word(
          fmt::format("{} must be {}, not \"{}\"", name, schema::expectation(*key, value), plain_text(word)));
    key->member.set(&output, *value);
  }
  for (const auto& [name, word] : words)
    if (const auto users = contacts_that_use(*table.keys.find(name), output); !users.empty())
      refuse_word(fmt::format("{} acts where contact is {} only; say so or leave it out", name, users));
  return output;
}

std::vector<ImportFormat> import_formats() {
  std::vector<ImportFormat> all;
  for (const Format* format : readers())
    all.push_back({std::string(format->name), std::string(format->reads), std::string(format->unit_from),
                   format->options});
  return all;
}

const Format& format_of(const std::filesystem::path& file, const ImportOptions& options) {
  const FileBeginning beginning = beginning_of(file);
  refuse_wrapped(beginning, wrappings);
  require_text(beginning);
  const Format& reader = options.format.empty()
                             ? reader_for(beginning)
                             : named(readers(), options.format, [](const Format& one) { return one.name; });
  if (!options.columns.empty()) require_option(reader, "columns");
  if (options.frame) require_option(reader, "frame");
  if (!options.level.empty()) require_option(reader, "level");
  if (options.radii) require_option(reader, "radii");
  return reader;
}

}  // namespace bernal
