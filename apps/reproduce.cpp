#include <filesystem>
#include <memory>
#include <string>

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
  bool quiet = false;
};

int reproduce(const ReproduceCall& call) {
  for (const Figure& figure : all_figures())
    if (figure.name == call.name && call.pack && !figure.packs)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("{} has no packings to show; leave out --pack", call.name));
  check_writable(call.folder);
  ProgressBar bar(call.quiet);
  const auto files =
      write_figure(call.name, call.folder, {.pack = call.pack, .seed = call.seed, .monitor = bar.monitor()});
  bar.clear();
  for (const auto& file : files) say(stdout, "{}\n", plain_text(file.string(), 5000));
  if (files.empty() && !call.quiet) say(stderr, "bernal: stopped by the user; nothing is written\n");
  return files.empty() ? exit_code::not_reached : exit_code::done;
}

}  // namespace

Command reproduce_command() {
  const auto call = std::make_shared<ReproduceCall>();
  std::vector<std::string> names;
  std::string footer = "Figures and tables:\n";
  for (const Figure& figure : all_figures()) {
    names.emplace_back(figure.name);
    footer += fmt::format("  {:<8}{}{}\n", figure.name, figure.what, figure.packs ? " *" : "");
  }
  return {"reproduce",
          "Compute a figure or table of Farr (2013) again",
          {one_of(required({"NAME", &call->name, "Which of those below"}), names),
           required({"-o,--output", &call->folder,
                     "Folder for NAME.svg and NAME.csv; made if it does not exist", "DIR"}),
           {"--pack", &call->pack, "Also pack some of the sizes in three dimensions: minutes"},
           seed_option("Of the packings; 1 if absent",
                       [call = call.get()](std::uint64_t seed) { call->seed = seed; }),
           quiet_option(call->quiet)},
          footer + R"(  * with --pack also packings of its own

R. S. Farr: Random close packing fractions of lognormal distributions of hard spheres. Powder
Technology 245, 28 (2013). KTS packings are printed there; all else is computed.
Exit codes: 0 done; 2 bad input; 3 stopped by Ctrl-C, nothing written.)",
          [call] { return reproduce(*call); }};
}
