#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/cost/bench.hpp"
#include "bernal/io/write_packing.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct BenchCall {
  std::vector<std::string> names;
  std::filesystem::path folder;
  BenchOptions options;
  bool quiet = false;
};

int bench(BenchCall& call) {
  if (!call.folder.empty()) check_writable(call.folder);
  ProgressBar bar(call.quiet);
  call.options.monitor = bar.monitor();
  const std::vector<BenchFile> files = run_benches(call.names, call.options);
  bar.clear();
  if (files.empty()) {
    if (!call.quiet) say(stderr, "bernal: stopped by the user; nothing is written\n");
    return exit_code::not_reached;
  }
  if (call.folder.empty()) {
    for (const BenchFile& file : files)
      if (file.name.ends_with(".md")) say(stdout, "{}", file.text);
    return exit_code::done;
  }
  for (const auto& file : write_benches(files, call.folder))
    say(stdout, "{}\n", plain_text(file.string(), 5000));
  return exit_code::done;
}

}  // namespace

Command bench_command() {
  const auto call = std::make_shared<BenchCall>();
  std::vector<Entry> scenes, tables;
  std::vector<std::string> names;
  for (const Bench& bench : all_benches()) {
    names.emplace_back(bench.name);
    if (bench.has_own_table())
      tables.push_back({std::string(bench.name), fmt::format("{}; {}", bench.what, bench.takes)});
    else
      scenes.push_back({std::string(bench.name), std::string(bench.what)});
  }
  return {
      "bench",
      "Measure what bernal's own work costs",
      {offering({"NAME", &call->names, "Which of those below"}, names),
       folder(
           {"-o,--output", &call->folder,
            "Folder for the tables, their numbers and pictures; without it the tables go to standard output",
            "DIR"}),
       within({"--spheres", &call->options.spheres, "Of every packing; as many as each needs if absent", "N"},
              100, 10'000'000),
       within({"--decisions", &call->options.decisions,
               "Of \"arithmetic\", in all; 1,000,000 if absent, in less than a minute; 10,000,000 take three",
               "N"},
              1000, 1'000'000'000),
       seed_option("The first; 1 if absent",
                   [call = call.get()](std::uint64_t seed) { call->options.seed = seed; }),
       quiet_option(call->quiet)},
      {.text = "Times are of the processor, one thread. What is packed is certified.",
       .lists = {{.title = "Scenes",
                  .text = "lines of one table; all of them where no NAME is given.",
                  .entries = scenes},
                 {.title = "Tables", .text = "of their own, where named.", .entries = tables}},
       .examples = {{"bernal bench", "all scenes, in half a minute"},
                    {"bernal bench relax certify", "two of them"},
                    {"bernal bench methods -o out", "every method on the same spheres, with pictures"}},
       .exit_codes = {{"0", "done"}, {"2", "bad input"}, {"3", "stopped by Ctrl-C, nothing written"}}},
      [call] { return bench(*call); }};
}
