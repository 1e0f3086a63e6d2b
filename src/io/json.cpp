#include "io/json.hpp"

namespace bernal {
namespace {

Json json_of(const Vector<3>& v) { return Json::array({v[0], v[1], v[2]}); }

Json json_of(const BondOrder::Count& count) {
  return {{"spheres", count.spheres}, {"crystalline", count.crystalline}, {"fraction", count.fraction()}};
}
Json json_of(const std::optional<BondOrder::Count>& count) { return count ? json_of(*count) : Json(); }

}  // namespace

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json contacts_json(const Contacts& contacts) {
  return {{"contact_gap", contacts.contact_gap},
          {"coordination", contacts.coordination},
          {"contacts", contacts.pairs},
          {"wall_contacts", contacts.walls},
          {"rattlers", contacts.rattlers},
          {"backbone",
           {{"spheres", contacts.backbone},
            {"contacts", contacts.backbone_pairs},
            {"wall_contacts", contacts.backbone_walls},
            {"coordination", contacts.backbone_coordination},
            {"isostatic_contacts", or_null(contacts.isostatic)}}}};
}

Json crystalline_json(const std::optional<BondOrder>& order) {
  if (!order) return {};
  return {
      {"all", json_of(order->all)}, {"near_wall", json_of(order->near_wall)}, {"core", json_of(order->core)}};
}

Json chambers_json(const std::optional<Chambers>& found) {
  if (!found) return {};
  const auto uncovered = [](const Chambers::Uncovered& of) {
    return Json{{"radius", of.radius}, {"share", of.share}, {"error", of.error}};
  };
  Json list = Json::array();
  for (const Chambers::Chamber& chamber : found->chambers)
    list.push_back({{"n", chamber.spheres},
                    {"share", chamber.share},
                    {"share_error", chamber.share_error},
                    {"phi", chamber.packing_fraction},
                    {"position", json_of(chamber.position)},
                    {"clearance", chamber.clearance}});
  return {{"radius", found->radius},
          {"resolution", found->resolution},
          {"misplaced", found->misplaced},
          {"uncovered", {{"smallest", uncovered(found->by_smallest)}, {"mean", uncovered(found->by_mean)}}},
          {"list", list}};
}

Json walls_json(const WallProfile& profile) {
  const auto& least = profile.first_minimum;
  const auto& segregation = profile.segregation;
  return {{"mean_diameter", profile.mean_diameter},
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

Json drawn_json(const SizeComparison& sizes) {
  if (!sizes.drawn) return {};
  return {{"missing", sizes.drawn->missing},
          {"largest_deviation", sizes.drawn->largest_deviation},
          {"above_largest", sizes.drawn->above_largest}};
}

Json::object_t::value_type domain_json(const Domain& domain) {
  const Box* box = std::get_if<Box>(&domain);
  if (box && (box->repeats() || box->dimension() != 3)) {
    std::vector<int> walls;
    for (int k = 0; k < box->dimension(); ++k)
      if (box->has_wall(k)) walls.push_back(k);
    return {"box",
            {{"edges", std::vector<double>(box->size.begin(), box->size.end())},
             {"walls", walls},
             {"volume", volume_of(domain)}}};
  }
  const Bounds<3> bounds = bounds_of(domain);
  Json container = {{"kind", kind_of(domain)},
                    {"volume", volume_of(domain)},
                    {"bounds", {{"lower", json_of(bounds.lower)}, {"upper", json_of(bounds.upper)}}}};
  if (is_periodic(domain)) container["periods"] = json_of(boundary_of<3>(domain).edges);
  return {"container", container};
}

}  // namespace bernal
