#include "bernal/formats/import.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "commands.hpp"
#include "measured.hpp"
#include "progress_bar.hpp"
#include "results.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

constexpr std::size_t listed_at_most = 10;

struct ImportCall {
  std::filesystem::path file, folder, radii, container;
  ImportOptions options;
  std::string unit, diameter, radius, box, shift;  // lengths in the file's unit, or with one of their own
  int frame = 0, dimension = 0;
  bool with_mesh = false, no_view = false, quiet = false;
};

/// The options of the library that the command line stands for.
ImportOptions options_of(const ImportCall& call) {
  ImportOptions options = call.options;
  if (!call.unit.empty()) options.unit = unit_named(call.unit);
  if (!call.diameter.empty())
    options.diameter = number_of("--diameter", call.diameter, Quantity::diameter, options.unit);
  if (!call.radius.empty())
    options.radius = number_of("--radius", call.radius, Quantity::length, options.unit);
  if (!call.box.empty()) options.box = lengths_of("--box", call.box, options.unit);
  if (!call.shift.empty()) options.shift = lengths_of("--shift", call.shift, options.unit);
  if (!call.radii.empty()) options.radii = call.radii;
  if (!call.container.empty()) options.container = read_scene(call.container);
  if (call.frame > 0) options.frame = call.frame;
  if (call.dimension > 0) options.dimension = call.dimension;
  return options;
}

void print_imported(const ImportedPacking& imported, const WrittenPacking& written) {
  const Certificate& c = written.certificate;
  for (const ImportNote& note : imported.notes) say(stderr, "{:<10} {}\n", note.about, plain_text(note.text));
  say(stderr, "certified  {}: {}\n", c.certified ? "yes" : "NO", c.statement);
  for (const auto& [pair, ratio] : c.overlaps)
    say(stderr, "overlap    {}, ratio {:.3g}\n", pair_text(pair), ratio);
  for (const auto& [sphere, gap] : c.protrusions)
    say(stderr, "protrudes  {}, gap {:.3g} of its radius\n", sphere, gap);
  say_files(written.files);
}

int import_file(const ImportCall& call) {
  const ImportOptions options = options_of(call);
  ProgressBar bar(call.quiet);
  bar.now("read");
  check_importable(call.file, call.folder);
  const Monitor monitor = bar.monitor();
  const ImportedPacking imported = import_packing(call.file, options, monitor);
  bar.now("certify and measure");
  const WrittenPacking written = write_imported(
      imported.packing, call.file, call.folder,
      {.with_mesh = call.with_mesh, .view = !call.no_view, .list = listed_at_most, .monitor = monitor});
  bar.clear();
  if (!call.quiet) print_imported(imported, written);
  return exit_code::done;
}

/// The list of formats for the help, two lines each.
std::vector<Entry> entries_of_import_formats() {
  std::vector<Entry> entries;
  for (const ImportFormat& format : import_formats()) {
    std::string of;
    for (const std::string& option : format.options) of += " --" + option;
    entries.push_back(
        {format.name, in_words_of_command(fmt::format("{}\nunit: {}{}{}", format.what, format.unit,
                                                      of.empty() ? "" : ";", of))});
  }
  return entries;
}

}  // namespace

Command import_command() {
  const auto call = std::make_shared<ImportCall>();
  ImportOptions& options = call->options;
  return {
      "import",
      "Take over another program's packing, as a result that verify, measure, export and start read",
      {required({"FILE", &call->file, "What the other program wrote", "CSV|DUMP|GSD|…"}),
       folder(required(
           {"-o,--output", &call->folder, "Folder for the result; made if it does not exist", "DIR"})),
       offering({"--from", &options.format,
                 "The format, one of those below; if absent it is told by the file", "FORMAT"},
                names_of(import_formats())),
       {"--columns", &options.columns,
        "Of a table, in its order: coordinates, r for the radius or d for the diameter, - for another "
        "column; or "
        "by number or name, as x=3,y=4,z=5,d=rad",
        "x,y,z,r"},
       measured(
           {"--diameter", &call->diameter,
            "Of every sphere, where the file has no sizes; as all lengths here in the file's unit, or with "
            "one of its own, \"2 mm\", where --unit says that of the file",
            "D"}),
       excludes(measured({"--radius", &call->radius, "The same", "R"}), "--diameter"),
       file({"--radii", &call->radii, "A .npy with the radius of every centre", "FILE.npy"}, {".npy"}),
       with_units({"--unit", &call->unit,
                   "Of the file's lengths, where it does not say it: nm, um, mm, cm, m, in, ft", "UNIT"}),
       {"--box", &call->box,
        "Edges of the box that the spheres lie in, whose corner is at zero: periodic, unless --periodic says "
        "another",
        "a,b,c"},
       offering(
           {"--periodic",
            [&options](const std::string& word) {
              if (word.empty())
                throw Error(ErrorCode::bad_argument,
                            "--periodic names no axis; write xyz or xy, or none for walls all around");
              options.periodic = word;
            },
            "The axes along which the box repeats itself, such as xyz or xy, and along the others has walls; "
            "none: "
            "walls all around",
            "AXES"},
           {"xyz", "xy", "none"}),
       file({"--container", &call->container, "A scene, whose container the spheres lie in", "SCENE.toml"},
            {".toml"}),
       {"--shift", &call->shift, "Added to every centre first", "x,y,z"},
       within({"--frame", &call->frame, "Of a trajectory, from 1; the last if absent", "N"}, 1, 1 << 30),
       {"--level", &options.level,
        "Of a file with spheres inside of spheres, such as core-1-1; the outermost if absent", "NAME"},
       within({"--dimension", &call->dimension, "2: the spheres lie in a plane, and discs are meant", "2|3"},
              2, 3),
       {"--with-mesh", &call->with_mesh,
        "Copy the CAD files of the container beside the spheres too, so that the folder stands for itself"},
       {"--no-view", &call->no_view, "Leave the view to turn out of report.html, which is then smaller"},
       quiet_option(call->quiet, "Print nothing but errors")},
      {.text =
           "The spheres lie in the container of --container, else in --box, else in the file's own container "
           "or box, "
           "else in the bounds of the spheres as walls; the printed lines say which. They come in the order "
           "of their numbers where they have some; indices count from 0.\n\nOverlaps are no reason to "
           "refuse: the result is certified, or not, and the ten worst overlaps and protrusions are "
           "listed, here and in report.json.",
       .lists = {{.title = "Formats",
                  .text = "told by the file's name and its first bytes.",
                  .entries = entries_of_import_formats()}},
       .examples = {{"bernal import bed.csv --columns x,y,z,d --unit mm --box 10,10,20 -o bed",
                     "a table of diameters, in a periodic box"},
                    {"bernal import dump.lammpstrj --unit m --frame 7 -o bed", "one frame of a trajectory"},
                    {"bernal import centers.npy --from openmc --radius 0.0425 --container vessel.toml -o bed",
                     "equal spheres in the container of a scene"},
                    {"bernal verify bed", "exits 1 where spheres overlap"},
                    {"bernal pack bed/scene.toml -o other", "begins from them, pushes them apart"}},
       .exit_codes = {{"0", "imported, certified or not"},
                      {"2", "bad input"},
                      {"3", "stopped by Ctrl-C, nothing written"}}},
      [call] { return all_or_nothing(call->quiet, [&] { return import_file(*call); }); }};
}
