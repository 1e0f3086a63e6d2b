#include "bernal/io/measurements_json.hpp"

#include "io/json.hpp"

namespace bernal {
namespace {

Json json_of(const RadialDistribution::Peak& peak, double mean_diameter) {
  return {{"r", peak.r}, {"r_over_diameter", peak.r / mean_diameter}, {"g", peak.g}, {"error", peak.error}};
}

Json json_of(const RadialDistribution& radial) {
  Json peaks = Json::array();
  for (const auto& peak : radial.peaks) peaks.push_back(json_of(peak, radial.mean_diameter));
  return {{"mean_diameter", radial.mean_diameter},
          {"radius_spread", radial.radius_spread},
          {"bin_width", radial.bin_width},
          {"references", radial.references},
          {"peaks", peaks},
          {"r", radial.r},
          {"g", radial.g},
          {"error", radial.error}};
}

Json json_of(const SizeComparison& sizes) {
  Json quantiles = Json::array(), classes = Json::array();
  for (const auto& q : sizes.quantiles)
    quantiles.push_back({{"share", q.share}, {"realised", q.realised}, {"asked", q.asked}});
  for (const auto& c : sizes.classes)
    classes.push_back({{"radius", c.radius}, {"asked_share", c.asked_share}, {"count", c.count}});
  return {{"ks_statistic", sizes.ks_statistic},
          {"ks_p_value", or_null(sizes.ks_p_value)},
          {"chi_squared", sizes.classes.empty() ? Json() : Json(sizes.chi_squared)},
          {"chi_squared_p_value", or_null(sizes.chi_squared_p_value)},
          {"mean_radius", {{"realised", sizes.mean_radius}, {"asked", sizes.asked_mean_radius}}},
          {"mean_volume_ratio", sizes.volume_ratio},
          {"mean_volume_ratio_error", sizes.volume_ratio_error},
          {"drawn", drawn_json(sizes)},
          {"quantiles", quantiles},
          {"classes", classes}};
}

/// The figures, as in report.json, and the layers.
Json json_of(const WallProfile& profile) {
  Json layers = Json::array();
  for (const auto& layer : profile.layers)
    layers.push_back({{"from", layer.from},
                      {"to", layer.to},
                      {"share", layer.share},
                      {"porosity", layer.porosity},
                      {"error", layer.error}});
  Json json = walls_json(profile);
  json["layers"] = layers;
  return json;
}

}  // namespace

std::string measurements_as_json(const Packing& packing, const Measurements& measured) {
  Json by_gap = Json::array();
  for (const Contacts& contacts : measured.by_gap) by_gap.push_back(contacts_json(contacts));
  Json json = {{"n", packing.spheres.size()},
               {"dimension", packing.spheres.dimension()},
               {"unit", name_of(packing.scene.unit)},
               {"phi", measured.packing_fraction},
               domain_json(packing.domain)};
  json.update(contacts_json(measured.contacts));
  json["by_gap"] = by_gap;
  json["g_r"] = measured.radial ? json_of(*measured.radial) : Json();
  json["crystalline"] = crystalline_json(measured.order);
  json["chambers"] = chambers_json(measured.chambers);
  json["walls"] = measured.walls ? json_of(*measured.walls) : Json();
  json["sizes"] = measured.sizes ? json_of(*measured.sizes) : Json();
  json["hash"] = hash_of(packing.spheres);
  return text_of(json);
}

}  // namespace bernal
