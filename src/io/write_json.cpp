#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "bernal/io/certificate_json.hpp"
#include "io/report.hpp"

namespace bernal {
namespace {

using Json = nlohmann::ordered_json;  // writes NaN and infinity as null

Json json_of(const Vector<3>& v) { return Json::array({v[0], v[1], v[2]}); }

Json box_json(const PeriodicBox& box) {
  return {{"edges", std::vector<double>(box.edges.begin(), box.edges.end())}, {"volume", box.edges.prod()}};
}

Json container_json(const Shape& shape) {
  const Bounds<3> bounds = bounds_of(shape);
  return {{"kind", kind_of(shape)},
          {"volume", volume_of(shape)},
          {"bounds", {{"lower", json_of(bounds.lower)}, {"upper", json_of(bounds.upper)}}}};
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * static_cast<std::uint64_t>(usage.ru_maxrss);
}

}  // namespace

std::string json_of(const Report& report) {
  const Packing& packing = report.packing;
  const Certificate& certificate = report.certificate;
  const Json of_certificate = Json::parse(certificate_as_json(certificate));
  const Contacts& contacts = report.contacts;

  const PeriodicBox* box = std::get_if<PeriodicBox>(&packing.domain);
  Json effects = Json::array();
  for (const Effect& e : packing.effects) {
    effects.push_back({{"name", e.name}, {"calls", e.calls}, {"seconds", e.seconds}});
  }
  Json history = Json::array();
  for (const Milestone& m : packing.history) {
    history.push_back({{"stage", m.stage},
                       {"spheres", m.spheres},
                       {"packing_fraction", m.packing_fraction},
                       {"potential", m.potential},
                       {"max_overlap", m.max_overlap},
                       {"seconds", m.seconds}});
  }
  const Json json = {
      {"version", packing.version},
      {"seed", packing.seed},
      {"threads", packing.threads},
      {"outcome", name_of(packing.outcome)},
      {"reason", packing.reason},
      {"n", packing.spheres.size()},
      {"dimension", packing.spheres.dimension()},
      {"unit", packing.scene.unit},
      {"phi", packing.packing_fraction()},
      {"coordination", contacts.coordination},
      {"contact_gap", contacts.contact_gap},
      {"contacts", contacts.pairs},
      {"wall_contacts", contacts.walls},
      {"rattlers", contacts.rattlers},
      {"max_overlap", certificate.max_overlap},
      {"min_wall_gap", of_certificate["min_wall_gap"]},
      {"certified", certificate.certified},
      {"certificate", of_certificate},
      box ? Json::object_t::value_type("box", box_json(*box))
          : Json::object_t::value_type("container", container_json(std::get<Shape>(packing.domain))),
      {"hash", report.hash},
      {"effects", effects},
      {"history", history},
      {"seconds", packing.seconds},
      {"peak_memory_bytes", peak_memory_bytes()}};
  // Names may hold any bytes; a report that is not valid UTF-8 would be worse than a replaced character.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bernal
