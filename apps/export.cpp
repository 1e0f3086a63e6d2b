#include "bernal/formats/export.hpp"

#include <algorithm>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/scene_reference.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "results.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct ExportCall {
  std::filesystem::path folder, file;
  std::string format;
  std::map<std::string, std::string> words;  ///< of the format's keys
  bool quiet = false;
};

int export_result(const ExportCall& call) {
  const Output output = output_of(call.format, call.words);  // before a large packing is read
  require_named_file(call.file);
  ProgressBar bar(call.quiet);
  const Monitor monitor = bar.monitor();
  bar.now("read");
  const Packing packing = read_result(call.folder);
  if (interrupted()) throw Cancelled();
  bar.now("write");
  const WrittenExport written = write_export(packing, output, call.file, monitor);
  bar.clear();
  if (!call.quiet) say_written(call.format, written.note, written.files);
  return exit_code::done;
}

std::string dimensions_in_words(const ExportFormat& format) {
  if (format.least_dimension == format.most_dimensions) return fmt::format("{}", format.least_dimension);
  return fmt::format("{} {} {}", format.least_dimension,
                     format.most_dimensions == format.least_dimension + 1 ? "or" : "to",
                     format.most_dimensions);
}

/// The list of formats for the help, two lines each.
std::vector<Entry> entries_of_formats() {
  std::vector<Entry> entries;
  for (const ExportFormat& format : export_formats()) {
    std::string options;
    for (const std::string& key : format.keys) options += fmt::format(" {}", option_of_key(key));
    entries.push_back(
        {format.name, fmt::format("{}\nlengths in {}{}, {}; {} dimensions;{}", format.what, format.unit,
                                  format.unit == "the scene's" ? " unit" : "",
                                  format.sizes == "radius"     ? "radii"
                                  : format.sizes == "diameter" ? "diameters"
                                                               : format.sizes,
                                  dimensions_in_words(format), options.empty() ? " no options" : options)});
  }
  return entries;
}

/// All words that a key takes in any format.
std::vector<std::string> words_of(const std::string& key) {
  std::set<std::string> words;
  for (const ReferenceGroup& group : scene_reference())
    if (group.name == "output")
      for (const ReferenceTable& table : group.tables)
        for (const ReferenceKey& known : table.keys)
          if (known.name == key) words.insert(known.words.begin(), known.words.end());
  return {words.begin(), words.end()};
}

/// The formats that have a key: "gmsh, step", or "all but yade" where that is shorter.
std::string formats_with(const std::string& key) {
  std::vector<std::string> with, without;
  for (const ExportFormat& format : export_formats())
    (std::ranges::find(format.keys, key) != format.keys.end() ? with : without).push_back(format.name);
  return without.empty()                ? "all"
         : without.size() < with.size() ? fmt::format("all but {}", fmt::join(without, ", "))
                                        : fmt::format("{}", fmt::join(with, ", "));
}

}  // namespace

Command export_command() {
  const auto call = std::make_shared<ExportCall>();
  Command command{
      "export",
      "Write a result as other programs read it",
      {folder(required(
           {"RESULT", &call->folder, "What bernal pack wrote: its spheres and scene.toml are read", "DIR"})),
       offering(required({"--to", &call->format, "The format, one of those below", "FORMAT"}),
                names_of(export_formats())),
       required({"-o,--output", &call->file, "The file; those that go with it stand beside it", "FILE"})},
      {.text =
           "The line that is printed says unit, sizes, density, types and the largest overlap that "
           "rounding to another unit or to single precision made. A scene writes the same with its result, "
           "if it has a table [[output]] with a line format = \"lammps\" and the options below as keys. "
           "bernal import goes the other way.",
       .lists = {{.title = "Formats", .entries = entries_of_formats()}},
       .examples = {{"bernal export out --to lammps -o bed.data --material-density 2650 --types 3",
                     "atoms of three types by size"},
                    {"bernal export out --to nrrd -o bed.nrrd --resolution 512 --values labels",
                     "an image: which sphere is where"},
                    {"bernal export out --to gmsh -o rve.py --contact gap && python3 rve.py",
                     "a mesh of tetrahedra"},
                    {"bernal export out --to povray -o bed.pov && povray +A +W1200 +H900 bed.pov",
                     "a picture"}},
       .exit_codes = {{"0", "done"}, {"2", "bad input"}, {"3", "stopped by Ctrl-C, nothing written"}}},
      [call] { return all_or_nothing(call->quiet, [&] { return export_result(*call); }); }};
  for (const ExportKey& key : export_keys()) {
    std::string placeholder = key.name;
    for (char& c : placeholder) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    command.options.push_back(
        offering({option_of_key(key.name),
                  [call = call.get(), name = key.name](const std::string& word) { call->words[name] = word; },
                  fmt::format("{} ({})", key.what, formats_with(key.name)), placeholder},
                 words_of(key.name)));
  }
  command.options.push_back(quiet_option(call->quiet, "Print nothing but errors"));
  return command;
}
