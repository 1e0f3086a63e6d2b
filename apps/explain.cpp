#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "bernal/report/describe.hpp"
#include "bernal/report/json.hpp"
#include "bernal/run/run.hpp"
#include "bernal/slabs/pack_in_slabs.hpp"
#include "commands.hpp"
#include "mesh_flags.hpp"
#include "progress_bar.hpp"

using namespace bernal;

namespace {

struct ExplainCall {
  std::filesystem::path scene;  ///< or a mesh, as for pack
  MeshFlags flags;
  bool json = false;
};

int explain(const ExplainCall& call) {
  ProgressBar bar(call.json);
  bar.now("estimate");
  const Plan plan = build(scene_of(call.scene, call.flags));
  if (is_in_slabs(plan.scene)) check_slabs(plan);
  check_start(plan);
  bar.clear();
  fmt::print("{}", call.json ? plan_as_json(plan) : bernal::explain(plan));
  return exit_code::done;
}

}  // namespace

Command explain_command() {
  const auto call = std::make_shared<ExplainCall>();
  return {
      "explain",
      "Say what a scene would run and cost; run nothing",
      joined({scene_or_mesh(call->scene)}, options_of(call->flags), {json_option(call->json)}),
      {.text = "Prints what was understood, what would run, how many spheres to expect and, where the scene "
               "names no stages, those that run, with all their defaults. Times are those of packing on "
               "one core; with the memory they are estimates by each stage's own model: of the 32 scenes "
               "that were measured 27 took between half and twice the time expected, the worst a fourth of "
               "it or five times as long.",
       .examples = {{"bernal explain data/scenes/hopper.toml", "what would run, and what it would cost"},
                    {"bernal explain bracket.stl --unit mm --diameter 2", "the same of a mesh"}},
       .exit_codes = {{"0", "done"}, {"2", "bad input"}}},
      [call] { return explain(*call); }};
}
