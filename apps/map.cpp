#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/figures/figures.hpp"
#include "bernal/io/write_packing.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"

using namespace bernal;

namespace {

struct MapCall {
  MapOptions options;
  std::vector<double> ratios = {1, 10};
  std::filesystem::path folder;
  bool quiet = false;
};

int map(MapCall& call) {
  call.options.least_ratio = call.ratios[0];
  call.options.most_ratio = call.ratios[1];
  check_writable(call.folder);
  watch_for_interrupts(call.quiet);
  ProgressBar bar(call.quiet);
  call.options.monitor.on_progress = [&](const Progress& progress) { bar.show(progress); };
  call.options.monitor.cancelled = interrupted;
  const WrittenMap written = write_map(call.options, call.folder);
  bar.clear();
  if (written.files.empty()) {
    if (!call.quiet) fmt::print(stderr, "bernal: stopped by the user; nothing is written\n");
    return exit_code::not_reached;
  }
  if (!call.quiet)
    fmt::print(stderr,
               "densest    {:.4f} at R {:.4g}, w {:.4g}\nerror      {:.1g} at most, from having {} rods\n",
               written.phi, written.ratio, written.share, written.error,
               grouped(static_cast<std::uint64_t>(call.options.rods)));
  for (const auto& file : written.files) fmt::print("{}\n", file.string());
  return exit_code::done;
}

}  // namespace

void add_map(Command app, int& status) {
  auto call = std::make_shared<MapCall>();
  Command command =
      app.add_subcommand("map", "Map how densely all mixtures of two lognormal populations pack");
  command
      .add_option("SIGMA_A", call->options.sigma_a, "Width of ln(diameter) of population a, 0: equal spheres")
      .required()
      .within(0.0, 3.0);
  command.add_option("SIGMA_B", call->options.sigma_b, "That of b").required().within(0.0, 3.0);
  command.add_option("-o,--output", call->folder, "Folder for map.csv and map.svg; made if it does not exist")
      .required()
      .type_name("DIR");
  command
      .add_option("--ratios", call->ratios,
                  "From which ratio of the mean diameters, b over a, to which; 1,10 if absent")
      .list_of(2)
      .type_name("R,R");
  command.add_option("--points", call->options.points, "Along each axis; 1,000 if absent")
      .within(2, 20'000)
      .type_name("N");
  command.add_option("--rods", call->options.rods, "Rods that stand for the sizes; 2,000 if absent")
      .within(2, 1'000'000)
      .type_name("N");
  command.add_flag("--quiet", call->quiet, "Print nothing but the files and errors");
  command.footer(
      R"(The axes: w, the share of b in the volume of the spheres, from 0 to 1, and R, the ratio of the
volume-weighted mean diameters, on a logarithmic axis. map.csv has a line ratio,share,phi a point.
The rod model is that of bernal predict; its error too.

Examples:
  bernal map 0 0 -o out                         two sizes: where is the optimum?
  bernal map 0.3 0.6 --ratios 0.1,10 -o out     a million mixtures, in the time it takes to fetch coffee
Exit codes: 0 done; 2 bad input; 3 stopped by Ctrl-C, nothing written.)");
  command.callback([call, &status] { status = map(*call); });
}
