#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "bernal/io/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "commands.hpp"
#include "describe.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"
#include "seed.hpp"
#include "threads.hpp"

using namespace bernal;

namespace {

struct PackCall {
  std::filesystem::path scene;
  std::filesystem::path folder;
  std::optional<std::uint64_t> seed;
  int threads = 0;
  bool quiet = false;
};

/// What was understood: told before the run, so that a wrong unit is seen at once.
void print_plan(const Plan& plan) {
  fmt::print(stderr, "container  {}\n", describe_container(plan));
  if (!plan.container_notes.empty()) fmt::print(stderr, "           {}\n", plan.container_notes);
  fmt::print(stderr, "spheres    {}; {}\n", describe_target(plan), describe_sizes(plan.scene));
}

void print_result(const Packing& packing, const WrittenPacking& written) {
  fmt::print(stderr, "packed     {} spheres, packing fraction {:.4f}, in {:.1f} s\n",
             grouped(packing.spheres.size()), packing.packing_fraction(), packing.seconds);
  fmt::print(stderr, "outcome    {}: {}\n", name_of(packing.outcome), packing.reason);
  fmt::print(stderr, "proof      {}\n", written.certificate.statement);
  for (std::size_t i = 0; i < written.files.size(); ++i)
    fmt::print(stderr, "{:<9}  {}\n", i == 0 ? "files" : "", written.files[i].string());
}

int pack(const PackCall& call) {
  const Plan plan = build(read_scene(call.scene));
  check_writable(call.folder);
  watch_for_interrupts(call.quiet);
  if (!call.quiet) print_plan(plan);

  ProgressBar bar(call.quiet);
  RunOptions options;
  options.seed = call.seed;
  options.threads = call.threads;
  options.monitor.on_progress = [&](const Progress& progress) { bar.show(progress); };
  options.monitor.cancelled = interrupted;
  const Packing packing = run(plan, options);
  const WrittenPacking written = write_packing(packing, call.folder);
  bar.clear();

  if (!call.quiet) print_result(packing, written);
  if (!written.certificate.certified) {
    fmt::print(stderr, "bernal: the result is not certified, which is a bug of bernal: {}\n",
               written.certificate.statement);
    return exit_code::not_reached;
  }
  return packing.outcome == Outcome::converged ? exit_code::done : exit_code::not_reached;
}

}  // namespace

void add_pack(CLI::App& app, int& status) {
  auto call = std::make_shared<PackCall>();
  CLI::App* command =
      app.add_subcommand("pack", "Run a scene and write the packing, its report and its proof");
  command->add_option("SCENE", call->scene, "The scene, a TOML file")->required();
  command->add_option("-o,--output", call->folder, "Folder for the results; made if it does not exist")
      ->required()
      ->type_name("DIR");
  add_seed(*command, "Instead of the scene's; one seed gives one packing, bit for bit",
           [call](std::uint64_t seed) { call->seed = seed; });
  add_threads(*command, call->threads, "the result");
  command->add_flag("--quiet", call->quiet, "Print nothing but errors");
  command->footer(
      "Writes spheres.csv, spheres.vtp, scene.toml, report.json, report.html and, in two and three\n"
      "dimensions, packing.svg: all or none.\n"
      "Ctrl-C ends the run at the next safe point and writes what is there, certified.\n"
      "Exit codes: 0 done; 2 bad input, nothing written; 3 ended without reaching what the scene asks.");
  command->callback([call, &status] { status = pack(*call); });
}
