// report.json and the output of --json.
#include "bernal/report/json.hpp"

#include <sys/resource.h>

#include "files/seal.hpp"
#include "report/class_amounts.hpp"
#include "report/measured_json.hpp"
#include "report/nest_levels.hpp"
#include "report/report.hpp"
#include "scene/scene_entries.hpp"

namespace bernal {

BERNAL_KEYS(Certificate::Overlap, pair, ratio)
BERNAL_KEYS(Certificate::Protrusion, sphere, gap)
BERNAL_KEYS(Certificate::Level, name, packings, packed, filled, spheres, pairs_tested, walls_tested,
            decided_double, decided_exact, overlapping_pairs, protruding_spheres, misplaced)
BERNAL_KEYS(Packing::BulkDensity, asked, reached)
BERNAL_KEYS(PackedCells::Quantile, share, wanted, by_radii, reached)
BERNAL_KEYS(Milestone, stage, spheres, packing_fraction, potential, max_overlap, seconds)

static void to_json(Json& json, const PackedCells& cells) {
  json = {{"scale", cells.scale},
          {"quantiles", cells.quantiles},
          {"kolmogorov_by_radii", cells.distance_by_radii},
          {"kolmogorov", cells.distance},
          {"largest_deviation", cells.error},
          {"mean_sphericity", cells.mean_sphericity},
          {"rounds", cells.rounds},
          {"newton_steps", cells.steps}};
}

/// An effect that is only counted is timed within another.
static void to_json(Json& json, const Effect& effect) {
  json = {{"name", effect.name}, {"calls", effect.calls}, {"seconds", effect.seconds}};
  if (effect.calls > 0 && effect.seconds == 0) json["seconds"] = nullptr;
}

static void to_json(Json& json, const Certificate& c) {
  json = {{"certified", c.certified},
          {"statement", c.statement},
          {"allowed_overlap", c.allowed_overlap},
          {"cancelled", c.cancelled},
          {"spheres", c.spheres},
          {"pairs_tested", c.pairs_tested},
          {"walls_tested", c.walls_tested},
          {"centers_tested", c.centers_tested},
          {"decided_double", c.decided_double},
          {"decided_exact", c.decided_exact},
          {"overlapping_pairs", c.overlapping_pairs},
          {"protruding_spheres", c.protruding_spheres},
          {"worst_pair", c.worst_pair},
          {"max_overlap", c.max_overlap},
          {"worst_wall", c.worst_wall},
          {"min_wall_gap", c.worst_wall ? Json(c.min_wall_gap) : Json()},
          {"gap", c.gap},
          {"wall_gap", c.wall_gap},
          {"least_distance", c.least_distance},
          {"least_wall_distance", c.least_wall_distance}};
  if (!c.overlaps.empty()) json["overlaps"] = c.overlaps;
  if (!c.protrusions.empty()) json["protrusions"] = c.protrusions;
  if (!c.levels.empty()) {
    json["levels"] = c.levels;
    json["spheres_of_all_levels"] = c.spheres_of_all_levels;
  }
  json["seconds"] = c.seconds;
}

std::string certificate_as_json(const Certificate& c, const std::optional<ZonesInPlace>& zones,
                                const std::optional<Rest>& rest, const Spheres<dynamic>& spheres) {
  Json json = c;
  if (zones) json["misplaced"] = zones->misplaced;
  if (rest) {
    json["settled"] = {{"at_rest", rest->unsettled == 0},
                       {"unsettled", rest->unsettled},
                       {"held_by_friction", rest->held_by_friction},
                       {"angle_of_friction", rest->friction},
                       {"hanging", rest->hanging},
                       {"farthest_fall", rest->farthest}};
    for (const auto& [sphere, slope, fall] : rest->list)
      json["settled"]["list"].push_back({{"sphere", sphere},
                                         {"center", spheres.center(static_cast<std::size_t>(sphere))},
                                         {"radius", spheres.r[static_cast<std::size_t>(sphere)]},
                                         {"hangs", fall > 0},
                                         {"fall", fall},
                                         {"slope", slope}});
  }
  return text_of(json);
}

std::map<std::string, std::string> manifest_in(const std::string& report) {
  const Json json = Json::parse(report, nullptr, false);
  std::map<std::string, std::string> files;
  if (!json.is_object() || !json.contains("certificate") || !json.contains("hash")) return files;
  if (!json.contains("files"))  // an early format of version 0.1
    return {{"spheres.csv", ""}, {"spheres.vtp", ""}, {"scene.toml", ""},   {"report.json", ""},
            {"report.html", ""}, {"packing.svg", ""}, {"container.off", ""}};
  for (const auto& [name, sha256] : json.at("files").items())
    files[name] = sha256.is_string() ? sha256.get<std::string>() : "";
  return files;
}

std::vector<std::string> sources_in(const std::string& report) {
  const Json json = Json::parse(report, nullptr, false);
  std::vector<std::string> files;
  if (!json.is_object() || !json.contains("certificate") || !json.contains("made_from")) return files;
  for (const Json& file : json.at("made_from"))
    if (file.is_string()) files.push_back(file.get<std::string>());
  return files;
}

namespace {

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * static_cast<std::uint64_t>(usage.ru_maxrss);
}

Json classes_json(const Packing& packing) {
  Json all = Json::array();
  for (const ClassAmount& amount : class_amounts(packing))
    all.push_back({{"name", amount.of.name},
                   {"material", amount.of.material.empty() ? Json() : Json(amount.of.material)},
                   {"material_density", amount.of.material_density},
                   {"spheres", amount.spheres},
                   {"packing_fraction", amount.packing_fraction},
                   {"mass", amount.mass}});
  return all;
}

Json run_json(const Packing& packing, std::uint64_t spheres, double packing_fraction,
              const LayerAmounts& layers) {
  const std::optional<double> mass = mass_of(packing, packing_fraction);
  Json json = {{"version", packing.program.version},
               {"commit", packing.program.commit},
               {"packings_number", packing.program.packings_number},
               {"seed", packing.seed},
               {"threads", packing.threads},
               {"outcome", name_of(packing.outcome)},
               {"reason", packing.reason},
               {"n", spheres},
               {"dimension", packing.spheres.dimension()},
               {"unit", name_of(packing.scene.unit)},
               {"phi", packing_fraction},
               {"mass", mass ? Json(*mass) : Json()},
               {"classes", classes_json(packing)},
               {"bulk_density", packing.bulk_density},
               {"cells", packing.cells},
               {"expected_phi", packing.expected_packing_fraction},
               {"expected_phi_of_sizes", packing.expected_of_sizes},
               {"caution", packing.caution.empty() ? Json() : Json(packing.caution)},
               {"notes", packing.hints},
               {"size_scale", packing.size_scale}};
  json.update(layers_json(layers));
  json["levels"] = packing.inside.empty() ? Json::array() : levels_json(packing);
  return json;
}

/// The part after the measurements, common to both kinds of report.
template <class AnyReport>
void add_proof(Json& json, const AnyReport& report) {
  const Packing& packing = report.packing;
  const Certificate& certificate = report.certificate;
  const Json of_certificate = certificate;
  json.update({{"max_overlap", certificate.max_overlap},
               {"min_wall_gap", of_certificate.at("min_wall_gap")},
               {"gap", certificate.gap},
               {"wall_gap", certificate.wall_gap},
               {"least_distance", certificate.least_distance},
               {"least_wall_distance", certificate.least_wall_distance},
               {"certified", certificate.certified},
               {"certificate", of_certificate},
               domain_json(packing.domain),
               {"hash", report.hash},
               {"effects", packing.effects},
               {"history", packing.history},
               {"seconds", packing.seconds},
               {"resumed", packing.resumed},
               {"peak_memory_bytes", peak_memory_bytes()}});
  json["made_from"] = report.made_from;
  for (const auto& [name, sha256] : report.files)
    json["files"][name] = sha256.empty() ? Json() : Json(sha256);
  if (json.contains("container"))
    json["container"]["kind"] = schema::word_of(packing.scene.container, packing.domain);
  if (const auto* mesh = std::get_if<MeshFile>(&packing.scene.container))
    json["container"].update({{"file", mesh->file.filename().string()}, {"sha256", mesh->sha256}});
}

/// Adds a seal as the last key, which shows later changes to the others.
std::string sealed_text_of(const Json& json) {
  constexpr std::string_view end = "\n}\n";
  std::string text = text_of(json);
  text.resize(text.size() - end.size());
  return sealed(std::move(text), ",\n  \"seal\": \"", std::string("\"").append(end));
}

}  // namespace

std::string json_of(const Report& report) {
  const Packing& packing = report.packing;
  Json json = run_json(packing, packing.spheres.size(), packing.packing_fraction(), report.layers);
  if (!report.cell.empty()) json["cell"] = report.cell;
  json.update(measured_figures(report.measured));
  add_proof(json, report);
  return sealed_text_of(json);
}

std::string json_of(const StreamedReport& report) {
  Json json = run_json(report.packing, report.spheres, report.packing_fraction, report.layers);
  json["not_measured"] = report.not_measured;
  add_proof(json, report);
  return sealed_text_of(json);
}

}  // namespace bernal
