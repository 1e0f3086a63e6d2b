#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "import/reader.hpp"

namespace bernal {

// Each in its own file, src/import/read_<name>.cpp; openmc in that of npy.
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
const PackingReader& table_reader();

/// A line a format, in the order in which files are held against them: the last takes any.
constexpr std::array all_readers = {gsd_reader,    openmc_reader, npy_reader,    dump_reader,
                                    lammps_reader, yade_reader,   esys_reader,   mfix_reader,
                                    pfc_reader,    povray_reader, extxyz_reader, table_reader};

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
  const PackingReader* reader = nullptr;
  if (!options.format.empty()) {
    reader = &reader_named(options.format);
  } else {
    const FileBeginning beginning = beginning_of(file);
    reader = *std::ranges::find_if(packing_readers(),
                                   [&](const PackingReader* one) { return one->recognises(beginning); });
  }
  if (!options.columns.empty()) require_option(*reader, "columns");
  if (options.frame) require_option(*reader, "frame");
  if (options.radii) require_option(*reader, "radii");
  return *reader;
}

std::optional<Unit> unit_in_title(std::string_view text) {
  constexpr std::string_view mark = "lengths in ";
  const std::size_t at = text.find(mark);
  if (at == text.npos) return {};
  text.remove_prefix(at + mark.size());
  text = text.substr(0, text.find_first_not_of("abcdefghijklmnopqrstuvwxyz"));
  const auto known = unit_names();
  if (std::ranges::find(known, text) == known.end()) return {};
  return unit_named(text);
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
