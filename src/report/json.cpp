// report.json and what --json prints.
#include "bernal/report/json.hpp"

#include <sys/resource.h>

#include <optional>
#include <sstream>

#include <nlohmann/json.hpp>

#include "bernal/core/text.hpp"
#include "bernal/domain/domain.hpp"
#include "files/seal.hpp"
#include "report/report.hpp"

using Json = nlohmann::ordered_json;  // writes NaN and infinity as null

template <class T>
struct nlohmann::adl_serializer<std::optional<T>> {
  static void to_json(Json& json, const std::optional<T>& value) { json = value ? Json(*value) : Json(); }
};

namespace bernal {

static void to_json(Json& json, const BondOrder::Count& count) {
  json = {{"spheres", count.spheres}, {"crystalline", count.crystalline}, {"fraction", count.fraction()}};
}

static void to_json(Json& json, const WallProfile::Segregation& segregation) {
  json = {{"spheres", segregation.spheres},
          {"mean_volume_ratio", segregation.volume_ratio},
          {"error", segregation.error}};
}

/// Makes members of a struct keys of their own names. (Those of nlohmann know no ordered_json.)
#define BERNAL_KEYS(Type, ...)                                               \
  static void to_json(Json& nlohmann_json_j, const Type& nlohmann_json_t) {  \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__)) \
  }
BERNAL_KEYS(BedProfile::Core, from, to, porosity)
BERNAL_KEYS(BedProfile::Layer, from, to, packing_fraction)
BERNAL_KEYS(Bounds<3>, lower, upper)
BERNAL_KEYS(BondOrder, all, mean_q6, q6_error, near_wall, core)
BERNAL_KEYS(Certificate::Overlap, pair, ratio)
BERNAL_KEYS(Certificate::Protrusion, sphere, gap)
BERNAL_KEYS(Chambers::Uncovered, radius, share, error)
BERNAL_KEYS(DrawnComparison, missing, scale, largest_deviation, above_largest)
BERNAL_KEYS(LocalPacking::Quantile, share, packing_fraction)
BERNAL_KEYS(Milestone, stage, spheres, packing_fraction, potential, max_overlap, seconds)
BERNAL_KEYS(PoreSizes::Quantile, share, distance)
BERNAL_KEYS(SizeCorrelation::Neighbours, correlation, error, pairs)
BERNAL_KEYS(SizeComparison::Class, radius, asked_share, count)
BERNAL_KEYS(SizeComparison::Share, above, up_to, asked_number, asked_volume, count, number, volume)
BERNAL_KEYS(SizeComparison::Quantile, share, realised, asked)
BERNAL_KEYS(WallProfile::Layer, from, to, share, porosity, error, segregation)
#undef BERNAL_KEYS

static void to_json(Json& json, const SizeCorrelation& sizes) {
  json = {{"mean_diameter", sizes.mean_diameter},
          {"bin_width", sizes.bin_width},
          {"references", sizes.references},
          {"neighbours", sizes.neighbours},
          {"means", Json::array()},
          {"d", sizes.d},
          {"c", sizes.c},
          {"error", sizes.error}};
  for (const auto& [from, to] : size_correlation_ranges)
    if (const auto mean = sizes.mean_between(from, to))
      json["means"].push_back({{"from", from}, {"to", to}, {"c", mean->c}, {"error", mean->error}});
}

/// What is only counted took a part of another effect's time.
static void to_json(Json& json, const Effect& effect) {
  json = {{"name", effect.name}, {"calls", effect.calls}, {"seconds", effect.seconds}};
  if (effect.calls > 0 && effect.seconds == 0) json["seconds"] = nullptr;
}

static void to_json(Json& json, const Contacts& contacts) {
  json = {{"contact_gap", contacts.contact_gap},
          {"coordination", contacts.coordination},
          {"contacts", contacts.pairs},
          {"wall_contacts", contacts.walls},
          {"rattlers", contacts.rattlers},
          {"backbone",
           {{"spheres", contacts.backbone},
            {"contacts", contacts.backbone_pairs},
            {"wall_contacts", contacts.backbone_walls},
            {"coordination", contacts.backbone_coordination},
            {"isostatic_contacts", contacts.isostatic}}}};
}

/// A count of rattlers stands only where it says something.
static Json contacts_json(const Measurements& measured, const Contacts& contacts) {
  Json json = contacts;
  if (!measured.holds(contacts)) json["rattlers"] = nullptr;
  return json;
}

static void to_json(Json& json, const Chambers::Chamber& chamber) {
  json = {{"n", chamber.spheres},
          {"share", chamber.share},
          {"share_error", chamber.share_error},
          {"phi", chamber.packing_fraction},
          {"position", chamber.position},
          {"clearance", chamber.clearance}};
}

static void to_json(Json& json, const Chambers& found) {
  json = {{"radius", found.radius},
          {"resolution", found.resolution},
          {"misplaced", found.misplaced},
          {"uncovered", {{"smallest", found.by_smallest}, {"mean", found.by_mean}}},
          {"list", found.chambers}};
}

/// Without its layers.
static void to_json(Json& json, const BedProfile& bed) {
  json = {{"direction", bed.direction},
          {"mean_diameter", bed.mean_diameter},
          {"height", bed.height},
          {"highest", bed.highest},
          {"roughness", bed.roughness},
          {"covered", bed.covered},
          {"porosity", bed.porosity},
          {"porosity_error", bed.porosity_error},
          {"core", bed.core},
          {"level", bed.level},
          {"unsettled", bed.rest.unsettled},
          {"hanging", bed.rest.hanging},
          {"farthest_fall", bed.rest.farthest},
          {"held_by_friction", bed.rest.held_by_friction},
          {"angle_of_friction", bed.rest.friction}};
}

/// Without its layers.
static void to_json(Json& json, const WallProfile& profile) {
  const auto& least = profile.first_minimum;
  const auto& segregation = profile.segregation;
  json = {{"mean_diameter", profile.mean_diameter},
          {"mean_porosity", profile.mean_porosity},
          {"near_wall_phi", profile.near_wall_packing_fraction},
          {"core_phi", profile.core_packing_fraction},
          {"core_phi_error", profile.core_packing_error},
          {"core_from", profile.core_from},
          {"has_core", profile.has_core},
          {"first_minimum", least ? Json{{"z", least->z},
                                         {"z_over_diameter", least->z / profile.mean_diameter},
                                         {"porosity", least->porosity}}
                                  : Json()},
          {"segregation", segregation ? Json{{"spheres_near_wall", segregation->spheres},
                                             {"mean_volume_ratio", segregation->volume_ratio},
                                             {"error", segregation->error}}
                                      : Json()}};
}

static void to_json(Json& json, const RadialDistribution& radial) {
  Json peaks = Json::array();
  for (const auto& peak : radial.peaks)
    peaks.push_back({{"r", peak.r},
                     {"r_over_diameter", peak.r / radial.mean_diameter},
                     {"g", peak.g},
                     {"error", peak.error}});
  json = {{"mean_diameter", radial.mean_diameter},
          {"radius_spread", radial.radius_spread},
          {"bin_width", radial.bin_width},
          {"references", radial.references},
          {"peaks", peaks},
          {"r", radial.r},
          {"g", radial.g},
          {"error", radial.error}};
}

/// Without what every single sphere has.
static void to_json(Json& json, const LocalPacking& local) {
  json = {{"mean", local.mean},
          {"mean_error", local.mean_error},
          {"deviation", local.deviation},
          {"quantiles", local.quantiles},
          {"mean_neighbours", local.mean_neighbours},
          {"looked_at", local.cell_volume.size()},
          {"empty_cells", local.empty},
          {"volume", local.volume},
          {"volume_error", local.volume_error}};  // null where it is no number
}

/// Without the values at all wave numbers.
static void to_json(Json& json, const StructureFactor& factor) {
  const auto value = [&](double k, double s, double error) {
    return Json{{"k", k}, {"k_times_diameter", k * factor.mean_diameter}, {"s", s}, {"error", error}};
  };
  const auto peak = factor.peak();
  json = {{"mean_diameter", factor.mean_diameter},
          {"wave_vectors", factor.references},
          {"peak", peak ? value(peak->k, peak->s, peak->error) : Json()},
          {"smallest_k", value(factor.k.front(), factor.s.front(), factor.error.front())}};
}

/// Without the density.
static void to_json(Json& json, const PoreSizes& pores) {
  json = {{"points", pores.points},
          {"in_pores", pores.in_pores},
          {"porosity", pores.porosity},
          {"porosity_error", pores.porosity_error},
          {"mean", pores.mean},
          {"mean_error", pores.mean_error},
          {"second_moment", pores.second_moment},
          {"second_moment_error", pores.second_moment_error},
          {"largest", pores.largest},
          {"quantiles", pores.quantiles}};
}

static void to_json(Json& json, const SizeComparison& sizes) {
  json = {{"ks_statistic", sizes.ks_statistic},
          {"ks_p_value", sizes.ks_p_value},
          {"chi_squared", sizes.classes.empty() ? Json() : Json(sizes.chi_squared)},
          {"chi_squared_p_value", sizes.chi_squared_p_value},
          {"mean_radius", {{"realised", sizes.mean_radius}, {"asked", sizes.asked_mean_radius}}},
          {"mean_volume_ratio", sizes.volume_ratio},
          {"mean_volume_ratio_error", sizes.volume_ratio_error},
          {"drawn", sizes.drawn},
          {"shares", sizes.shares},
          {"quantiles", sizes.quantiles},
          {"classes", sizes.classes}};
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
  json["seconds"] = c.seconds;
}

namespace {

/// The key `box` with edges, axes that have walls and volume of a box that repeats itself or has not three
/// dimensions; or `container` with kind, volume and bounds, and the periods of one that repeats itself, 0
/// along open axes.
Json::object_t::value_type domain_json(const Domain& domain) {
  const Box* box = std::get_if<Box>(&domain);
  if (box && (box->repeats() || box->dimension() != 3)) {
    std::vector<int> walls;
    for (int k = 0; k < box->dimension(); ++k)
      if (box->has_wall(k)) walls.push_back(k);
    return {"box", {{"edges", box->size}, {"walls", walls}, {"volume", volume_of(domain)}}};
  }
  Json container = {{"kind", kind_of(domain)}, {"volume", volume_of(domain)}, {"bounds", bounds_of(domain)}};
  if (is_periodic(domain)) container["periods"] = boundary_of<3>(domain).edges;
  return {"container", container};
}

/// The figures; the tables are in the answer of `bernal measure`.
Json figures_of(const std::optional<SizeComparison>& sizes) {
  if (!sizes) return {};
  return {{"ks_statistic", sizes->ks_statistic},
          {"ks_p_value", sizes->ks_p_value},
          {"chi_squared_p_value", sizes->chi_squared_p_value},
          {"mean_volume_ratio", sizes->volume_ratio},
          {"shares", sizes->shares},
          {"drawn", sizes->drawn}};
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * static_cast<std::uint64_t>(usage.ru_maxrss);
}

/// Names may hold any bytes; a report that is not valid UTF-8 would be worse than a replaced character.
std::string text_of(const Json& json) {
  std::istringstream lines(json.dump(2, ' ', false, Json::error_handler_t::replace));
  std::string text;
  for (std::string line; std::getline(lines, line);) text += with_escaped_controls(line) + '\n';
  return text;
}

}  // namespace

std::string certificate_as_json(const Certificate& c, const std::optional<Rest>& rest,
                                const Spheres<dynamic>& spheres) {
  Json json = c;
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

std::string measurements_as_json(const Packing& packing, const Measurements& measured) {
  Json json = {{"n", packing.spheres.size()},
               {"dimension", packing.spheres.dimension()},
               {"unit", name_of(packing.scene.unit)},
               {"phi", measured.packing_fraction},
               domain_json(packing.domain)};
  json.update(contacts_json(measured, measured.contacts));
  json["held_from_gap"] = measured.held_from;
  json["by_gap"] = Json::array();
  for (const Contacts& contacts : measured.by_gap)
    json["by_gap"].push_back(contacts_json(measured, contacts));
  json["g_r"] = measured.radial;
  json["size_correlation"] = measured.size_correlation;
  json["crystalline"] = measured.order;
  json["chambers"] = measured.chambers;
  json["bed"] = measured.bed;
  if (measured.bed) json["bed"]["layers"] = measured.bed->layers;
  json["walls"] = measured.walls;
  if (measured.walls) json["walls"]["layers"] = measured.walls->layers;
  json["local_packing"] = measured.local;
  json["structure_factor"] = measured.structure;
  if (const auto& factor = measured.structure)
    json["structure_factor"].update({{"bin_width", factor->bin_width},
                                     {"k", factor->k},
                                     {"s", factor->s},
                                     {"error", factor->error},
                                     {"vectors", factor->vectors}});
  json["pores"] = measured.pores;
  if (const auto& pores = measured.pores)
    json["pores"].update({{"bin_width", pores->bin_width},
                          {"d", pores->d},
                          {"density", pores->density},
                          {"error", pores->error}});
  json["sizes"] = measured.sizes;
  json["hash"] = hash_of(packing.spheres);
  return text_of(json);
}

std::map<std::string, std::string> manifest_in(const std::string& report) {
  const Json json = Json::parse(report, nullptr, false);
  std::map<std::string, std::string> files;
  if (!json.is_object() || !json.contains("certificate") || !json.contains("hash")) return files;
  if (!json.contains("files"))  // as bernal 0.1 wrote it at first
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

Json run_json(const Packing& packing, std::uint64_t spheres, double packing_fraction) {
  return {{"version", packing.version},
          {"seed", packing.seed},
          {"threads", packing.threads},
          {"outcome", name_of(packing.outcome)},
          {"reason", packing.reason},
          {"n", spheres},
          {"dimension", packing.spheres.dimension()},
          {"unit", name_of(packing.scene.unit)},
          {"phi", packing_fraction},
          {"expected_phi", packing.expected_packing_fraction},
          {"expected_phi_of_sizes", packing.expected_of_sizes},
          {"caution", packing.caution.empty() ? Json() : Json(packing.caution)},
          {"size_scale", packing.size_scale}};
}

/// What comes behind all that is measured, of either kind of report.
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
  if (const auto* mesh = std::get_if<MeshFile>(&packing.scene.container))
    json["container"].update({{"file", mesh->file.filename().string()}, {"sha256", mesh->sha256}});
}

/// With a last key that tells whether anybody has changed any of the others.
std::string sealed_text_of(const Json& json) {
  constexpr std::string_view end = "\n}\n";
  std::string text = text_of(json);
  text.resize(text.size() - end.size());
  return sealed(std::move(text), ",\n  \"seal\": \"", std::string("\"").append(end));
}

}  // namespace

std::string json_of(const Report& report) {
  const Packing& packing = report.packing;
  Json json = run_json(packing, packing.spheres.size(), packing.packing_fraction());
  if (!report.cell.empty()) json["cell"] = report.cell;
  json.update(contacts_json(report.measured, report.measured.contacts));
  json.update({{"held_from_gap", report.measured.held_from},
               {"crystalline", report.measured.order},
               {"size_correlation", report.measured.size_correlation},
               {"chambers", report.measured.chambers},
               {"bed", report.measured.bed},
               {"walls", report.measured.walls},
               {"local_packing", report.measured.local},
               {"structure_factor", report.measured.structure},
               {"pores", report.measured.pores},
               {"sizes", figures_of(report.measured.sizes)}});
  add_proof(json, report);
  return sealed_text_of(json);
}

std::string json_of(const StreamedReport& report) {
  Json json = run_json(report.packing, report.spheres, report.packing_fraction);
  json["not_measured"] = report.not_measured;
  add_proof(json, report);
  return sealed_text_of(json);
}

}  // namespace bernal
