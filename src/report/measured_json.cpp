#include "report/measured_json.hpp"

#include <sstream>

#include "bernal/core/text.hpp"
#include "bernal/report/json.hpp"
#include "geometry/surface_kinds.hpp"

namespace bernal {

static void to_json(Json& json, const BondOrder::Count& count) {
  json = {{"spheres", count.spheres}, {"crystalline", count.crystalline}, {"fraction", count.fraction()}};
}

static void to_json(Json& json, const WallProfile::Segregation& segregation) {
  json = {{"spheres", segregation.spheres},
          {"mean_volume_ratio", segregation.volume_ratio},
          {"error", segregation.error}};
}

BERNAL_KEYS(BedProfile::Core, from, to, porosity)
BERNAL_KEYS(BedProfile::Layer, from, to, packing_fraction)
BERNAL_KEYS(Bounds<3>, lower, upper)
BERNAL_KEYS(BondOrder, all, mean_q6, q6_error, near_wall, core)
BERNAL_KEYS(Chambers::Uncovered, radius, share, error)
BERNAL_KEYS(ColumnProfile::Layer, from, to, porosity)
BERNAL_KEYS(ContactsOfSome::At, contact_gap, coordination)
BERNAL_KEYS(DrawnComparison, missing, scale, largest_deviation, above_largest)
BERNAL_KEYS(LayerAmount, of_class, name, material, material_density, spheres, volume, packing_fraction, mass)
BERNAL_KEYS(MaterialAmount, name, volume, packing_fraction, mass)
BERNAL_KEYS(LocalPacking::Quantile, share, packing_fraction)
BERNAL_KEYS(PoreSizes::Quantile, share, distance)
BERNAL_KEYS(SizeCorrelation::Neighbours, correlation, error, pairs)
BERNAL_KEYS(SizeComparison::Class, radius, asked_share, count)
BERNAL_KEYS(SizeComparison::Share, above, up_to, asked_number, asked_volume, count, number, volume)
BERNAL_KEYS(SizeComparison::Quantile, share, realised, asked)
BERNAL_KEYS(WallProfile::Layer, from, to, share, porosity, error, segregation)

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

/// At the gap that counts, without the others.
static void to_json(Json& json, const ContactsOfSome& some) {
  json = {{"spheres", some.spheres}, {"coordination", some.by_gap.back().coordination}};
}

/// Rattlers only if their number is meaningful.
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

static Json minimum_json(const std::optional<WallProfile::Minimum>& least, double diameter) {
  if (!least) return {};
  return {{"z", least->z}, {"z_over_diameter", least->z / diameter}, {"porosity", least->porosity}};
}

/// Without its layers.
static void to_json(Json& json, const WallProfile& profile) {
  const auto& segregation = profile.segregation;
  json = {{"mean_diameter", profile.mean_diameter},
          {"mean_porosity", profile.mean_porosity},
          {"near_wall_phi", profile.near_wall_packing_fraction},
          {"core_phi", profile.core_packing_fraction},
          {"core_phi_error", profile.core_packing_error},
          {"core_from", profile.core_from},
          {"has_core", profile.has_core},
          {"first_minimum", minimum_json(profile.first_minimum, profile.mean_diameter)},
          {"segregation", segregation ? Json{{"spheres_near_wall", segregation->spheres},
                                             {"mean_volume_ratio", segregation->volume_ratio},
                                             {"error", segregation->error}}
                                      : Json()}};
}

/// Without its layers and those of the side.
static void to_json(Json& json, const ColumnProfile& column) {
  const double d = column.mean_diameter;
  json = {{"axis", column.axis},
          {"mean_diameter", d},
          {"top", column.top},
          {"has_lid", column.has_lid},
          {"floor_minimum", minimum_json(column.floor_minimum, d)},
          {"lid_minimum", minimum_json(column.lid_minimum, d)},
          {"side", Json()}};
  if (const auto& side = column.side)
    json["side"] = {{"from", side->from}, {"to", side->to}, {"profile", side->profile}};
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
          {"error", radial.error},
          {"share", radial.share}};
}

/// Without per-sphere data.
static void to_json(Json& json, const LocalPacking& local) {
  json = {{"mean", local.mean},
          {"mean_error", local.mean_error},
          {"deviation", local.deviation},
          {"quantiles", local.quantiles},
          {"mean_neighbours", local.mean_neighbours},
          {"looked_at", local.cell_volume.size()},
          {"empty_cells", local.empty},
          {"volume", local.volume},
          {"volume_error", local.volume_error}};  // null if NaN
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
          {"volume_quantiles", sizes.volume_quantiles},
          {"classes", sizes.classes}};
}

namespace {

/// The figures without the tables, which `bernal measure` returns.
Json figures_of(const std::optional<SizeComparison>& sizes) {
  if (!sizes) return {};
  return {{"ks_statistic", sizes->ks_statistic},
          {"ks_p_value", sizes->ks_p_value},
          {"chi_squared_p_value", sizes->chi_squared_p_value},
          {"mean_volume_ratio", sizes->volume_ratio},
          {"shares", sizes->shares},
          {"volume_quantiles", sizes->volume_quantiles},
          {"drawn", sizes->drawn}};
}

}  // namespace

Json surface_json(const TrueSurface& surface) {
  const TrueSurface::Face& worst = surface.worst_face();
  Json kinds = Json::array();
  for (const SurfaceKind& kind : kinds_of(surface))
    kinds.push_back({{"kind", kind.name}, {"faces", kind.faces}, {"share_of_area", kind.share}});
  return {{"bound", worst.apart},
          {"face", worst.number},
          {"kind", worst.kind},
          {"at", worst.worst},
          {"edges_known_to", surface.largest(&TrueSurface::Face::tolerance)},
          {"kinds", kinds}};
}

Json::object_t::value_type domain_json(const Domain& domain) {
  const Box* box = std::get_if<Box>(&domain);
  if (box && (box->repeats() || box->dimension() != 3)) {
    std::vector<int> walls;
    for (int k = 0; k < box->dimension(); ++k)
      if (box->has_wall(k)) walls.push_back(k);
    Json made = {{"edges", box->size}, {"walls", walls}, {"volume", volume_of(domain)}};
    if (box->is_tilted())
      made["tilt"] = std::vector(box->tilt.begin(), box->tilt.begin() + (box->dimension() == 3 ? 3 : 1));
    return {"box", made};
  }
  Json container = {{"kind", kind_of(domain)}, {"volume", volume_of(domain)}, {"bounds", bounds_of(domain)}};
  if (is_periodic(domain)) container["periods"] = boundary_of<3>(domain).edges;
  if (const auto* mesh = std::get_if<Mesh>(&domain); mesh && mesh->surface)
    container["true_surface"] = surface_json(*mesh->surface);
  return {"container", container};
}

std::string text_of(const Json& json) {
  std::istringstream lines(json.dump(2, ' ', false, Json::error_handler_t::replace));
  std::string text;
  for (std::string line; std::getline(lines, line);) text += with_escaped_controls(line) + '\n';
  return text;
}

Json layers_json(const LayerAmounts& amounts) {
  return {{"layers", amounts.layers}, {"materials", amounts.materials}};
}

Json measured_figures(const Measurements& measured) {
  Json json = contacts_json(measured, measured.contacts);
  json.update({{"held_from_gap", measured.held_from},
               {"core_contacts", measured.core_contacts},
               {"crystalline", measured.order},
               {"size_correlation", measured.size_correlation},
               {"chambers", measured.chambers},
               {"bed", measured.bed},
               {"walls", measured.walls},
               {"column", measured.column},
               {"local_packing", measured.local},
               {"structure_factor", measured.structure},
               {"pores", measured.pores},
               {"sizes", figures_of(measured.sizes)}});
  if (!measured.left_out.empty()) json["left_out"] = measured.left_out;
  return json;
}

std::string measurements_as_json(const Packing& packing, const Measurements& measured) {
  Json json = {{"n", packing.spheres.size()},
               {"dimension", packing.spheres.dimension()},
               {"unit", name_of(packing.scene.unit)},
               {"phi", measured.packing_fraction},
               domain_json(packing.domain)};
  json.update(layers_json(layer_amounts(packing)));
  json.update(contacts_json(measured, measured.contacts));
  json["fabric"] = measured.of_contacts.fabric;
  json["spheres_by_contacts"] = measured.of_contacts.spheres_by_contacts();
  json["held_from_gap"] = measured.held_from;
  json["by_gap"] = Json::array();
  for (const Contacts& contacts : measured.by_gap)
    json["by_gap"].push_back(contacts_json(measured, contacts));
  const auto with_gaps = [](const ContactsOfSome& some) {
    Json all = some;
    all["by_gap"] = some.by_gap;
    return all;
  };
  json["core_contacts"] = measured.core_contacts ? with_gaps(*measured.core_contacts) : Json();
  json["slab"] = Json();
  if (const auto& slab = measured.slab)
    json["slab"] = {{"direction", Vector<3>(-slab->part.direction)},
                    {"from", slab->part.from},
                    {"to", slab->part.height},
                    {"phi", slab->packing_fraction},
                    {"contacts", with_gaps(slab->contacts)}};
  json["g_r"] = measured.radial;
  json["size_correlation"] = measured.size_correlation;
  json["crystalline"] = measured.order;
  json["chambers"] = measured.chambers;
  json["bed"] = measured.bed;
  if (measured.bed) json["bed"]["layers"] = measured.bed->layers;
  json["walls"] = measured.walls;
  if (measured.walls) json["walls"]["layers"] = measured.walls->layers;
  json["column"] = measured.column;
  if (const auto& column = measured.column) {
    json["column"]["along"] = column->along;
    if (column->side) json["column"]["side"]["profile"]["layers"] = column->side->profile.layers;
  }
  json["local_packing"] = measured.local;
  json["structure_factor"] = measured.structure;
  if (const auto& factor = measured.structure)
    json["structure_factor"].update({{"bin_width", factor->bin_width},
                                     {"k", factor->k},
                                     {"s", factor->s},
                                     {"error", factor->error},
                                     {"vectors", factor->vectors}});
  if (!measured.left_out.empty()) json["left_out"] = measured.left_out;
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

}  // namespace bernal
