#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/nest.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/slabs/pack_in_slabs.hpp"
#include "commands.hpp"
#include "layer_text.hpp"
#include "mesh_flags.hpp"
#include "progress_bar.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct PackCall {
  std::filesystem::path scene;  ///< or a mesh, where the flags say what is packed into it
  MeshFlags flags;
  std::filesystem::path folder;
  std::optional<std::uint64_t> seed;
  int threads = 0;
  bool with_mesh = false;
  bool no_view = false;
  bool as_array = false;
  bool quiet = false;
  bool resume = false;
  double checkpoint_every = CheckpointOptions().every;  ///< seconds; 0: none
};

/// "1 packing", "1,200 packings".
std::string in_words(std::uint64_t count, std::string_view thing) {
  return fmt::format("{} {}{}", grouped(count), thing, count == 1 ? "" : "s");
}

void print_result(const Packing& packing, std::uint64_t spheres, double packing_fraction,
                  const WrittenPacking& written) {
  speak_of(packing.scene.dimension());
  const std::optional<double> mass = mass_of(packing, packing_fraction);
  say(stderr, "packed     {}{}, packing fraction {:.4f} ({:.3f} was expected), in {:.1f} s\n",
      spheres == 1 ? "1 sphere" : grouped(spheres) + " spheres",
      mass ? fmt::format(", {:.6g} kg", *mass) : std::string(), packing_fraction,
      packing.expected_packing_fraction, packing.seconds);
  print_layers(stderr, packing);
  if (!packing.inside.empty())
    for (const NestLevel& level : levels_of(packing) | std::views::drop(1))
      say(stderr, "inside     {}: {} in {}, {} in all, packing fraction {:.4f} of their balls\n", level.name,
          in_words(level.packings, "packing"), in_words(level.filled, "sphere"),
          in_words(level.spheres, "sphere"), level.packing_fraction);
  const std::string end = fmt::format("{}: {}", name_of(packing.outcome), packing.reason);
  say(stderr, "outcome    {}\n", falls_short(packing.outcome) ? in_amber(stderr, end) : end);
  if (packing.cells) say(stderr, "cells      {}\n", cells_in_words(*packing.cells));
  say(stderr, "proof      {}\n", written.certificate.statement);
  const std::filesystem::path folder = written.files.front().parent_path();
  std::size_t files_inside = 0;
  for (std::size_t i = 0; i < written.files.size(); ++i)
    if (!packing.inside.empty() && *written.files[i].lexically_relative(folder).begin() == "inside")
      ++files_inside;
    else
      say(stderr, "{:<9}  {}\n", i == 0 ? "files" : "", plain_text(written.files[i].string(), 5000));
  if (files_inside > 0)
    say(stderr, "           {} with {} files\n", plain_text((folder / "inside").string(), 5000),
        grouped(files_inside));
  for (std::size_t i = 0; i < written.notes.size(); ++i)
    say(stderr, "output     {}: {}\n", plain_text(packing.scene.outputs[i].file.string(), 5000),
        written.notes[i]);
}

/// Prints a warning if the result is not certified, and returns the exit code of a run that was not stopped.
int concluded(const Packing& packing, const Certificate& certificate) {
  if (!certificate.certified) {
    say(stderr, "bernal: the result is not certified, which is a bug of bernal: {}\n", certificate.statement);
    return exit_code::not_reached;
  }
  return packing.outcome == Outcome::converged ? exit_code::done : exit_code::not_reached;
}

int pack_slabs(const PackCall& call, const Plan& plan, const std::filesystem::path& folder, ProgressBar& bar,
               const Monitor& monitor) {
  if (call.resume && !call.quiet)
    say(stderr, "bernal: slabs have no checkpoints; with keep = true the engine's result is one\n");
  try {
    const PackedInSlabs result =
        pack_in_slabs(plan, folder, {call.seed, call.threads, monitor, folder / "engine"});
    bar.clear();
    if (!call.quiet) {
      print_result(result.packing, result.spheres, result.packing_fraction, result.written);
      say(stderr, "measured   {}\n", result.not_measured);
    }
    return concluded(result.packing, result.written.certificate);
  } catch (const Cancelled&) {
    bar.clear();
    say(stderr, "bernal: stopped by the user; no result is written{}\n",
        plan.scene.engine->process().keep
            ? ", and the same call goes on from what the engine has left, if it has ended"
            : "");
    return exit_code::not_reached;
  }
}

int pack(const PackCall& call) {
  ProgressBar bar(call.quiet);
  bar.now("read");
  Scene scene = scene_of(call.scene, call.flags);
  if (call.seed && scene.target.mass) scene.seed = *call.seed;  // of whose radii it is the mass
  const Plan plan = build(scene);
  const std::filesystem::path folder = call.folder.empty() ? call.scene.stem() : call.folder;
  const Monitor monitor = bar.monitor();  // from here on a signal ends what is in the folder in order
  check_writable(folder, scene, {.with_mesh = call.with_mesh});
  bar.clear();
  if (!call.quiet && scene.file.empty()) say(stdout, "{}", scene_as_toml(scene));
  if (!call.quiet) say(stderr, "{}", describe(plan));  // a wrong unit is seen at once
  bar.now("prepare");
  if (is_in_slabs(plan.scene)) return pack_slabs(call, plan, folder, bar, monitor);
  CheckpointOptions checkpoints;
  if (call.checkpoint_every > 0 || call.resume) checkpoints.folder = folder;
  checkpoints.every =
      call.checkpoint_every > 0 ? call.checkpoint_every : std::numeric_limits<double>::infinity();
  checkpoints.resume = call.resume;
  checkpoints.tell = [&](const std::string& what) {
    bar.clear();
    if (!call.quiet) say(stderr, "bernal: {}\n", plain_text(what, 5000));
  };
  const Packing packing = run(plan, {call.seed, call.threads, monitor, checkpoints, folder / "engine"});
  bar.now("measure");
  // A run that was stopped is written whole, with the quick measurements; a second interrupt kills the
  // process.
  const bool stopped = packing.outcome == Outcome::cancelled;
  const auto at_once = [end = std::chrono::steady_clock::now() + std::chrono::milliseconds(300)] {
    return std::chrono::steady_clock::now() > end;
  };
  const WrittenPacking written = write_packing(packing, folder,
                                               {.with_mesh = call.with_mesh,
                                                .view = !call.no_view,
                                                .as_array = call.as_array,
                                                .monitor = stopped ? Monitor{{}, at_once} : monitor});
  bar.clear();
  if (!stopped && interrupted())
    say(stderr, "bernal: measuring was stopped; bernal measure {} makes up for it\n",
        plain_text(folder.string(), 5000));

  if (!stopped) remove_checkpoints(folder);

  if (!call.quiet) print_result(packing, packing.spheres.size(), packing.packing_fraction(), written);
  return concluded(packing, written.certificate);
}

}  // namespace

Command pack_command() {
  const auto call = std::make_shared<PackCall>();
  return {
      "pack",
      "Run a scene and write the packing, its report and its proof",
      joined(
          {scene_or_mesh(call->scene),
           folder({"-o,--output", &call->folder,
                   "Folder for the results; made if it does not exist; named after the scene if absent",
                   "DIR"})},
          options_of(call->flags),
          {{"--with-mesh", &call->with_mesh,
            "Copy the CAD files, and what the scene starts from, beside the spheres too, so that the folder "
            "stands for itself"},
           {"--no-view", &call->no_view,
            "Leave the view to turn out of report.html, which is then smaller: a picture and plots"},
           {"--binary", &call->as_array,
            "Write spheres.npy, an array of doubles, in the place of spheres.csv and spheres.vtp, as more "
            "than "
            "5 million spheres are"},
           seed_option("Instead of the scene's; one seed gives one packing, bit for bit",
                       [call = call.get()](std::uint64_t seed) { call->seed = seed; }),
           threads_option(call->threads, "the result"),
           {"--resume", &call->resume,
            "Go on from the checkpoint in DIR, to the very result of a run that nothing ended; start anew "
            "where "
            "there is none"},
           within({"--checkpoint-every", &call->checkpoint_every,
                   "Seconds between two checkpoints in DIR, 60 if absent; 0: none", "SECONDS"},
                  0.0, 1e9),
           quiet_option(call->quiet, "Print nothing but errors")}),
      {.text =
           "Ctrl-C and SIGTERM end the run at the next safe point: it keeps a checkpoint and writes what is "
           "there, certified; --resume goes on from there, and after a SIGKILL from the last checkpoint. For "
           "a "
           "mesh, prints the scene that the flags stand for, ready to be kept and changed. What would "
           "run bernal explain says before; the "
           "result is for bernal verify, bernal measure and bernal export.",
       .lists = {{.title = "Files",
                  .text = "what is written into DIR, all or none, with what the scene's [[output]] tables "
                          "ask for.",
                  .entries = {{"spheres.csv", "the spheres, in the scene's unit"},
                              {"spheres.vtp", "the same for ParaView"},
                              {"spheres.npy", "in the place of both, see --binary"},
                              {"weights.npy", "of the cells, where the scene asks for their volumes"},
                              {"scene.toml",
                               "the scene with every default, which verify, measure and "
                               "export read beside the spheres"},
                              {"report.json", "how it went, what was measured, the certificate"},
                              {"report.html", "the same to look at"},
                              {"packing.svg", "a picture, in two and three dimensions"},
                              {"nest.json",
                               "of packings inside of spheres: the tree of them, their counts and folders"},
                              {"inside/CLASS/",
                               "in it a folder with a result for each of them, and rotations.csv: which of "
                               "them each sphere holds, and the unit quaternion by which it is turned"}}}},
       .examples = {{"bernal pack data/scenes/hopper.toml", "results in hopper/"},
                    {"bernal pack bracket.stl --unit mm --diameter 2",
                     "no scene needed; results in bracket/"},
                    {"bernal pack bracket.stl --unit mm --lognormal 2,0.3", "median 2 mm, sigma 0.3"},
                    {"bernal pack bracket.stl --unit mm --radius 1 --count 500", "500 of them"},
                    {"bernal pack bracket.step --diameter 2 --fill",
                     "as many as can be made to fit; the file says its unit"}},
       .exit_codes = {{"0", "done"},
                      {"2", "bad input, nothing written"},
                      {"3",
                       "ended without reaching what the scene asks: the outcome is full, hit_limit, "
                       "cancelled, or loose: all spheres are there, but jammed more than 0.05 below "
                       "random close packing of their sizes; its reason says by how much, and the "
                       "likely why. Or the scene's engine is missing, failed or is left to Slurm: nothing "
                       "but the engine's folder is written"}}},
      [call] { return pack(*call); }};
}
