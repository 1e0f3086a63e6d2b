#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "commands.hpp"
#include "describe.hpp"
#include "progress_bar.hpp"

using namespace bernal;

namespace {

struct ExplainCall {
  std::filesystem::path scene;
  bool json = false;
};

void print(const Plan& plan) {
  const Scene& scene = plan.scene;
  fmt::print("{}", describe(plan));
  fmt::print("accuracy   walls {}, overlap {}\n", name_of(scene.walls), scene.overlap);
  fmt::print("expected   about {:.3g} spheres, packing fraction {:.3f}, {:.3g} MB of memory\n\n",
             plan.expected_count, plan.expected_packing_fraction, plan.expected_memory_bytes / 1e6);

  std::size_t name_width = 0, what_width = 0;
  for (const PlanItem& item : plan.items) {
    name_width = std::max(name_width, item.name.size());
    what_width = std::max(what_width, item.what.size());
  }
  fmt::print("What would run:\n");
  for (const PlanItem& item : plan.items)
    fmt::print("  {:<{}}  {:<{}}  {}\n", item.name, name_width, item.what, what_width, item.cost);
  if (!plan.absent.empty()) fmt::print("\nNot called for, not built: {}.\n", fmt::join(plan.absent, ", "));
  if (scene.stages_are_default)
    fmt::print("\nThe scene names no stages. This protocol runs; paste it to change it:\n\n{}",
               stages_as_toml(scene));
}

nlohmann::ordered_json as_json(const Plan& plan) {
  using nlohmann::ordered_json;
  ordered_json container = {{"kind", kind_of(plan.domain)}, {"volume", volume_of(plan.domain)}};
  if (!plan.scene.is_periodic()) {
    const Bounds<3> bounds = bounds_of(plan.domain);
    container["bounds"] = {bounds.lower, bounds.upper};
  } else {
    const Vector<dynamic> edges = bounds_of<dynamic>(plan.domain).size();
    container["edges"] = std::vector<double>(edges.begin(), edges.end());
    container["scalable"] = plan.box_follows;
  }
  container["notes"] = plan.container_notes;
  ordered_json items = ordered_json::array();
  for (const PlanItem& item : plan.items)
    items.push_back({{"name", item.name}, {"what", item.what}, {"cost", item.cost}});
  return {{"unit", name_of(plan.scene.unit)},
          {"container", container},
          {"spheres", {{"target", describe_target(plan)}, {"sizes", describe_sizes(plan.scene)}}},
          {"accuracy", {{"walls", name_of(plan.scene.walls)}, {"overlap", plan.scene.overlap}}},
          {"expected",
           {{"count", plan.expected_count},
            {"packing_fraction", plan.expected_packing_fraction},
            {"memory_bytes", plan.expected_memory_bytes}}},
          {"items", items},
          {"absent", plan.absent},
          {"stages_are_default", plan.scene.stages_are_default},
          {"stages", stages_as_toml(plan.scene)}};
}

int explain(const ExplainCall& call) {
  ProgressBar bar(call.json);
  bar.now("estimate");
  const Plan plan = build(read_scene(call.scene));
  bar.clear();
  if (call.json)
    fmt::print("{}\n", as_json(plan).dump(2));
  else
    print(plan);
  return exit_code::done;
}

}  // namespace

Command explain_command() {
  const auto call = std::make_shared<ExplainCall>();
  return {"explain",
          "Say what a scene would run and cost; run nothing",
          {required({"SCENE", &call->scene, "The scene, a TOML file"}), json_option(call->json)},
          "Prints what was understood, what would run, how many spheres to expect and, where the scene "
          "names\n"
          "no stages, those that run, with all their defaults.\n"
          "Exit codes: 0 done; 2 bad input.",
          [call] { return explain(*call); }};
}
