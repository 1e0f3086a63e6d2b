#include <nlohmann/json.hpp>

#include "bernal/core/text.hpp"
#include "bernal/plan/layer_shares.hpp"
#include "bernal/report/json.hpp"
#include "bernal/scene/read_scene.hpp"
#include "report/describe.hpp"
#include "report/measured_json.hpp"
#include "report/size_summary.hpp"
#include "scene/scene_entries.hpp"

namespace bernal {

/// What lies inside spheres, a level below each other.
static nlohmann::ordered_json insides_of(const Plan& plan) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const PlannedInside& inside : plan.insides)
    all.push_back({{"class", inside.name},
                   {"ball", inside.ball},
                   {"filled", inside.filled},
                   {"packings", inside.packings()},
                   {"count", inside.plan.expected_count},
                   {"packing_fraction", inside.plan.expected_packing_fraction},
                   {"unit", name_of(inside.plan.scene.unit)},
                   {"inside", insides_of(inside.plan)}});
  return all;
}

static nlohmann::ordered_json mesh_of(const Plan& plan) {
  const std::optional<MeshPrice> mesh = price_of_mesh(plan);
  if (!mesh) return {};
  return {{"tetrahedra", mesh->tetrahedra}, {"seconds", mesh->seconds}, {"memory_bytes", mesh->bytes}};
}

std::string plan_as_json(const Plan& plan) {
  using nlohmann::ordered_json;
  ordered_json container = {{"kind", schema::word_of(plan.scene.container, plan.domain)},
                            {"volume", volume_of(plan.domain)}};
  if (!plan.scene.is_periodic()) {
    const Bounds<3> bounds = bounds_of(plan.domain);
    container["bounds"] = {bounds.lower, bounds.upper};
    if (const auto* mesh = std::get_if<Mesh>(&plan.domain); mesh && mesh->surface)
      container["true_surface"] = surface_json(*mesh->surface);
  } else {
    const Vector<dynamic> edges = bounds_of<dynamic>(plan.domain).size();
    container["edges"] = std::vector<double>(edges.begin(), edges.end());
    container["scalable"] = plan.box_follows;
  }
  container["notes"] = plan.container_notes;
  ordered_json bed;
  if (plan.expected_bed)
    bed = {{"porosity", plan.expected_bed->porosity}, {"height", plan.expected_bed->height}};
  ordered_json items = ordered_json::array();
  for (const PlanItem& item : plan.items)
    items.push_back({{"name", item.name},
                     {"what", item.what},
                     {"cost", item.cost},
                     {"seconds", item.seconds},
                     {"bytes", item.bytes},
                     {"part", item.part},
                     {"if_needed", item.if_needed}});
  ordered_json outputs = ordered_json::array();
  for (const Output& output : plan.scene.outputs)
    outputs.push_back({{"format", output.format},
                       {"file", plain_text(output.file.string())},
                       {"unit", name_of(output.unit.value_or(Unit::m))}});
  const SizeSummary summary = summary_of(plan.scene, *plan.radii);
  ordered_json shares = ordered_json::array(), percentiles = ordered_json::array(),
               law = ordered_json::array();
  for (const SizeSummary::Share& share : summary.shares)
    shares.push_back({{"size", share.size},
                      {"name", share.name.empty() ? ordered_json() : ordered_json(share.name)},
                      {"number", share.number},
                      {"volume", share.volume},
                      {"mass", share.mass ? ordered_json(*share.mass) : ordered_json()}});
  for (const auto& [share, by_number, by_volume] : summary.percentiles)
    percentiles.push_back({{"share", share}, {"by_number", by_number}, {"by_volume", by_volume}});
  for (const auto& [name, share, given, fitted] : summary.fit)
    law.push_back({{"name", name}, {"share", share}, {"given", given}, {"fitted", fitted}});
  const std::optional<double> mass = plan.insides.empty() ? std::nullopt : expected_mass(plan);
  const ordered_json json = {
      {"unit", name_of(plan.scene.unit)},
      {"container", container},
      {"spheres",
       {{"target", describe_target(plan)},
        {"sizes", describe_sizes(plan.scene)},
        {"shares", shares},
        {"percentiles", percentiles},
        {"law", law},
        {"gap", plan.scene.gap},
        {"wall_gap", plan.scene.wall_gap}}},
      {"accuracy", {{"walls", name_of(plan.scene.walls)}, {"overlap", plan.scene.overlap}}},
      {"expected",
       {{"count", plan.expected_count},
        {"packing_fraction", plan.expected_packing_fraction},
        {"bed", bed},
        {"seconds", plan.expected_seconds},
        {"memory_bytes", plan.expected_memory_bytes},
        {"count_of_all_levels", expected_count_of_all_levels(plan)},
        {"mass", mass ? ordered_json(*mass) : ordered_json()},
        {"inside", insides_of(plan)},
        {"mesh", mesh_of(plan)}}},
      {"caution", plan.caution.empty() ? ordered_json() : ordered_json(plan.caution)},
      {"notes", plan.hints},
      {"outputs", outputs},
      {"items", items},
      {"absent", plan.absent},
      {"stages_are_default", plan.scene.stages_are_default},
      {"stages", stages_as_toml(plan.scene)}};
  return json.dump(2) + '\n';
}

}  // namespace bernal
