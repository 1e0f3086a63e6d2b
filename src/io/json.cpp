#include "io/json.hpp"

namespace bernal {
namespace {

Json json_of(const Vector<3>& v) { return Json::array({v[0], v[1], v[2]}); }

}  // namespace

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

Json::object_t::value_type domain_json(const Domain& domain) {
  if (const PeriodicBox* box = std::get_if<PeriodicBox>(&domain)) {
    return {"box",
            {{"edges", std::vector<double>(box->edges.begin(), box->edges.end())},
             {"volume", volume_of(domain)}}};
  }
  const Bounds<3> bounds = bounds_of(std::get<Shape>(domain));
  return {"container",
          {{"kind", kind_of(domain)},
           {"volume", volume_of(domain)},
           {"bounds", {{"lower", json_of(bounds.lower)}, {"upper", json_of(bounds.upper)}}}}};
}

}  // namespace bernal
