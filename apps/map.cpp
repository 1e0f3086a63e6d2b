#include <cstdint>
#include <memory>

#include "bernal/core/text.hpp"
#include "bernal/map/map.hpp"
#include "bernal/result/write_packing.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "say.hpp"

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
  ProgressBar bar(call.quiet);
  call.options.monitor = bar.monitor();
  const WrittenMap written = write_map(call.options, call.folder);
  bar.clear();
  if (written.files.empty()) {
    if (!call.quiet) say(stderr, "bernal: stopped by the user; nothing is written\n");
    return exit_code::not_reached;
  }
  if (!call.quiet)
    say(stderr, "densest    {:.4f} at R {:.4g}, w {:.4g}\nerror      {:.1g} at most, from having {} rods\n",
        written.phi, written.ratio, written.share, written.error,
        grouped(static_cast<std::uint64_t>(call.options.rods)));
  for (const auto& file : written.files) say(stdout, "{}\n", plain_text(file.string(), 5000));
  return exit_code::done;
}

}  // namespace

Command map_command() {
  const auto call = std::make_shared<MapCall>();
  return {
      "map",
      "Map how densely all mixtures of two lognormal populations pack",
      {within(required({"SIGMA_A", &call->options.sigma_a,
                        "Width of ln(diameter) of population a, 0: equal spheres"}),
              0.0, 3.0),
       within(required({"SIGMA_B", &call->options.sigma_b, "That of b"}), 0.0, 3.0),
       folder(required({"-o,--output", &call->folder,
                        "Folder for map.csv and map.svg; made if it does not exist", "DIR"})),
       list_of(2, {"--ratios", &call->ratios,
                   "From which ratio of the mean diameters, b over a, to which; 1,10 if absent", "R,R"}),
       within({"--points", &call->options.points, "Along each axis; 1,000 if absent", "N"}, 2, 20'000),
       rods_option(call->options.rods, 2, 1'000'000), quiet_option(call->quiet)},
      {.text = "The axes: w, the share of b in the volume of the spheres, from 0 to 1, and R, the ratio of "
               "the volume-weighted mean diameters, on a logarithmic axis. map.csv has a line "
               "ratio,share,phi a point. The rod model is that of bernal predict; its error too.",
       .examples = {{"bernal map 0 0 -o out", "two sizes: where is the optimum?"},
                    {"bernal map 0.3 0.6 --ratios 0.1,10 -o out",
                     "a million mixtures, in the time it takes to fetch coffee"}},
       .exit_codes = {{"0", "done"}, {"2", "bad input"}, {"3", "stopped by Ctrl-C, nothing written"}}},
      [call] { return map(*call); }};
}
