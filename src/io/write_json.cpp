#include <sys/resource.h>

#include "io/json.hpp"
#include "io/report.hpp"

namespace bernal {
namespace {

/// The figures; the tables are in the answer of `bernal measure`.
Json sizes_json(const Measurements& measured) {
  if (!measured.sizes) return {};
  return {{"ks_statistic", measured.sizes->ks_statistic},
          {"ks_p_value", or_null(measured.sizes->ks_p_value)},
          {"chi_squared_p_value", or_null(measured.sizes->chi_squared_p_value)},
          {"mean_volume_ratio", measured.sizes->volume_ratio},
          {"drawn", drawn_json(*measured.sizes)}};
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
  const Json of_certificate = certificate_json(certificate);

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
  Json json = {{"version", packing.version},
               {"seed", packing.seed},
               {"threads", packing.threads},
               {"outcome", name_of(packing.outcome)},
               {"reason", packing.reason},
               {"n", packing.spheres.size()},
               {"dimension", packing.spheres.dimension()},
               {"unit", name_of(packing.scene.unit)},
               {"phi", packing.packing_fraction()},
               {"expected_phi", packing.expected_packing_fraction}};
  json.update(contacts_json(report.measured.contacts));
  json.update({{"crystalline", crystalline_json(report.measured.order)},
               {"chambers", chambers_json(report.measured.chambers)},
               {"walls", report.measured.walls ? walls_json(*report.measured.walls) : Json()},
               {"sizes", sizes_json(report.measured)},
               {"max_overlap", certificate.max_overlap},
               {"min_wall_gap", of_certificate.at("min_wall_gap")},
               {"certified", certificate.certified},
               {"certificate", of_certificate},
               domain_json(packing.domain),
               {"hash", report.hash},
               {"effects", effects},
               {"history", history},
               {"seconds", packing.seconds},
               {"peak_memory_bytes", peak_memory_bytes()}});
  return text_of(json);
}

}  // namespace bernal
