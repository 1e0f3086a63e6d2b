#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "bernal/cells/write_cells.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "results.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct CellsCall {
  std::filesystem::path folder, file, table;
  CellFileOptions options;
  int threads = 0, resolution = 0;
  bool json = false, quiet = false;
};

void print_moments(const char* name, const CellStatistics::Moments& of) {
  fmt::print("{:<16}{:>12.6g} {:>12.6g} {:>10.4f} {:>10.4f} {:>12.6g} {:>12.6g}\n", name, of.mean,
             of.deviation, of.skewness, of.kurtosis, of.least, of.most);
}

void print_statistics(const Packing& packing, const Cells& cells, const CellStatistics& found) {
  const bool flat = cells.dimension == 2;
  fmt::print("cells             {}", grouped(found.cells));
  if (found.empty > 0) fmt::print("; {} spheres have none: they are hidden in others", grouped(found.empty));
  fmt::print("\nvolume            {:.9g} {}^{}, the domain's within {:.1g}\n", found.volume,
             name_of(packing.scene.unit), cells.dimension, found.volume_error);
  if (cells.deviation > 0)
    fmt::print("walls             round ones are made of flat pieces, off by up to {:.2g} {}\n",
               cells.deviation, name_of(packing.scene.unit));
  fmt::print("of the whole      {} corners, {} edges", grouped(found.corners), grouped(found.edges));
  if (!flat) fmt::print(", {} faces", grouped(found.faces));
  fmt::print("; Euler {} ({} of its cells are not closed)\n\n", found.euler, found.not_euler);
  fmt::print("{:<16}{:>12} {:>12} {:>10} {:>10} {:>12} {:>12}\n", "a cell", "mean", "deviation", "skewness",
             "kurtosis", "least", "most");
  print_moments(flat ? "area" : "volume", found.volumes);
  print_moments("diameter", found.diameters);
  print_moments(flat ? "sides" : "faces", found.faces_a_cell);
  if (!flat) print_moments("edges of a face", found.edges_a_face);
  print_moments("sphericity", found.sphericity);
  print_moments("aspect", found.aspect);
}

/// Statistics, and the table if one is asked for.
void look_at_cells(const Packing& packing, const ShapedCells& made, const CellsCall& call) {
  if (!call.table.empty()) write_cell_table(packing, made, call.table);
  if (!call.json && call.quiet) return;
  const CellStatistics found = statistics_of(made.cells, made.shapes);
  if (call.json)
    fmt::print("{}", cell_statistics_as_json(packing, made.cells, found));
  else
    print_statistics(packing, made.cells, found);
}

int write_cells_of(CellsCall call) {
  if (call.file.empty() != call.options.format.empty())
    throw Error(ErrorCode::bad_argument, "a file of cells needs both --to, its format, and -o, its name");
  if (call.resolution > 0) call.options.resolution = call.resolution;
  require_named_file(call.file);
  if (!call.file.empty() && call.table.lexically_normal() == call.file.lexically_normal())
    throw Error(ErrorCode::bad_argument, "-o and --table name the same file; give each its own",
                {call.file.string()});
  const auto limit = limited_to(call.threads);
  ProgressBar bar(call.quiet || call.json);
  bar.now("read");
  const Packing packing = read_result(call.folder);
  if (!call.options.format.empty()) require_cell_format(call.options, packing.spheres.dimension());
  std::optional<ShapedCells> made;
  if (call.options.format.empty() || call.json || !call.table.empty()) {
    bar.now("cells");
    made = shaped_cells_of(packing, call.options.cells);
    bar.clear();
    look_at_cells(packing, *made, call);
  }
  if (call.options.format.empty()) return exit_code::done;
  bar.now("write");
  const WrittenCells written =
      write_cells(packing, call.options, call.file, bar.monitor(), made ? &*made : nullptr);
  bar.clear();
  if (!call.quiet) say_written(call.options.format, written.note, written.files);
  return exit_code::done;
}

std::vector<Entry> entries_of_cell_formats() {
  std::vector<Entry> entries;
  for (const CellFormat& format : cell_formats())
    entries.push_back({format.name, fmt::format("{}; {}{}", format.what, format.ending,
                                                format.least_dimension == 2 ? "" : "; three dimensions")});
  return entries;
}

}  // namespace

Command cells_command() {
  const auto call = std::make_shared<CellsCall>();
  CellFileOptions& options = call->options;
  return {
      "cells",
      "The cells around spheres as polyhedra: grains, foams, statistics",
      {folder(required({"RESULT", &call->folder, "What bernal pack wrote", "DIR"})),
       offering(
           {"--to", &options.format, "The format, one of those below; else statistics are printed", "FORMAT"},
           names_of(cell_formats())),
       {"-o,--output", &call->file, "The file; those that go with it stand beside it", "FILE"},
       within({"--sides", &options.cells.sides, "Flat walls around a round one; 64 if absent", "N"}, 8, 1024),
       {"--radius", &options.strut_radius, "Of the struts of a foam", "R"},
       {"--density", &options.strut_density,
        "Their share of the volume, in place of a radius; 0.05 if both are absent", "SHARE"},
       within({"--resolution", &call->resolution, "Voxels along the longest edge of an image; 100 if absent",
               "N"},
              1, 1 << 20),
       {"--voxel", &options.voxel, "Edge of a voxel, in place of a number", "LENGTH"},
       file({"--table", &call->table,
             "Write volume, surface, sphericity and faces of every cell into this table", "FILE.csv"},
            {".csv"}),
       threads_option(call->threads, "the cells"),
       json_option(call->json),
       quiet_option(call->quiet, "Print nothing but errors")},
      {.text =
           "The cell of a sphere is what is nearer to it than to any other, by the squared distance less the "
           "squared radius: the Laguerre cell, for equal spheres that of Voronoi, and the one that bernal "
           "measure has. Cells are periodic, or cut by the walls; round walls are cut flat. Corners, edges "
           "and faces that cells share are one in all files.\n\nLengths are in the unit of the scene, and "
           "cells have the numbers of their spheres.",
       .lists = {{.title = "Formats", .entries = entries_of_cell_formats()}},
       .examples = {{"bernal cells out", "statistics: volumes, faces, sphericity"},
                    {"bernal cells out --to vtu -o cells.vtu", "for ParaView"},
                    {"bernal cells out --to neper -o grains.tess", "for Neper"},
                    {"bernal cells out --to gmsh -o grains.geo && gmsh -3 grains.geo", "a mesh of grains"},
                    {"bernal cells out --to struts --density 0.03 -o foam.vtp", "an open foam"},
                    {"bernal cells out --to nrrd --resolution 200 -o grains.nrrd", "an image of grains"}},
       .exit_codes = {{"0", "done"}, {"2", "bad input"}, {"3", "stopped by Ctrl-C, nothing written"}}},
      [call] { return all_or_nothing(call->quiet, [&] { return write_cells_of(*call); }); }};
}
