#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/figures/figures.hpp"
#include "bernal/io/write_packing.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct ReproduceCall {
  std::string name;
  std::filesystem::path folder;
  std::uint64_t seed = 1;
  bool pack = false;
  int spheres = 0;
  bool quiet = false;
};

int reproduce(const ReproduceCall& call) {
  for (const Figure& figure : all_figures()) {
    if (figure.name != call.name) continue;
    if (call.pack && !figure.packs)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("{} has no more packings to show; leave out --pack", call.name));
    if (call.spheres != 0 && !figure.sized)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("{} packs the same number at any time; leave out --spheres", call.name));
  }
  check_writable(call.folder);
  ProgressBar bar(call.quiet);
  const auto files =
      write_figure(call.name, call.folder,
                   {.pack = call.pack, .spheres = call.spheres, .seed = call.seed, .monitor = bar.monitor()});
  bar.clear();
  for (const auto& file : files) say(stdout, "{}\n", plain_text(file.string(), 5000));
  if (files.empty() && !call.quiet) say(stderr, "bernal: stopped by the user; nothing is written\n");
  return files.empty() ? exit_code::not_reached : exit_code::done;
}

}  // namespace

Command reproduce_command() {
  const auto call = std::make_shared<ReproduceCall>();
  std::vector<std::string> names;
  std::vector<Entry> figures;
  for (const Figure& figure : all_figures()) {
    names.emplace_back(figure.name);
    figures.push_back(
        {std::string(figure.name), fmt::format("{}: {}{}{}", figure.what, figure.time,
                                               figure.packs ? " *" : "", figure.sized ? " °" : "")});
  }
  return {
      "reproduce",
      "Compute a published figure, table or paper again: Zhao 2007, Han 2005, Farr 2013",
      {one_of(required({"NAME", &call->name, "Which of those below"}), names),
       folder(required(
           {"-o,--output", &call->folder,
            "Folder for NAME.svg and NAME.csv, of a paper also NAME.md; made if it does not exist", "DIR"})),
       {"--pack", &call->pack, "Also pack more of the sizes in three dimensions: minutes"},
       within({"--spheres", &call->spheres,
               "Packings of at most so many spheres: quick, and rougher than what is published", "N"},
              100, 10'000'000),
       seed_option("Of the packings; 1 if absent",
                   [call = call.get()](std::uint64_t seed) { call->seed = seed; }),
       quiet_option(call->quiet)},
      {.text =
           "A paper's page, NAME.md, puts printed and own values side by side and says where they differ and "
           "why, as far as that is known; it names the CSV and SVG files beside it. All appear together, or "
           "none.",
       .lists =
           {{.title = "Names", .text = "and the time that each takes on two cores.", .entries = figures},
            {.title = "Marks",
             .entries = {{"*",
                          "with --pack more packings; in zhao2007 the published loop with 10,000 spheres "
                          "of all sizes"},
                         {"°",
                          "with --spheres smaller packings: zhao2007 --spheres 1000 takes a minute, "
                          "--spheres 100 four seconds"}}},
            {.title = "Sources",
             .entries =
                 {{"zhao2007, fig1 to fig6 and tables",
                   "Zhao Liang, Li Shuixiang, Liu Yuewu: Numerical simulation of sphere packing with "
                   "arbitrary "
                   "diameter distribution. Chinese Journal of Computational Physics (2007, in Chinese)."},
                  {"han2005",
                   "K. Han, Y. T. Feng, D. R. J. Owen: Sphere packing with a geometric based "
                   "compression algorithm. Powder Technology 155, 33 (2005)."},
                  {"farr2013",
                   "R. S. Farr: Random close packing fractions of lognormal distributions of hard "
                   "spheres. Powder Technology 245, 28 (2013)."}}}},
       .examples = {{"bernal reproduce fig6 -o out", "a figure"},
                    {"bernal reproduce zhao2007 --spheres 1000 -o zhao", "a paper, in a minute"}},
       .exit_codes = {{"0", "done"}, {"2", "bad input"}, {"3", "stopped by Ctrl-C, nothing written"}}},
      [call] { return reproduce(*call); }};
}
