#include <nlohmann/json.hpp>

#include "report/report_summary.hpp"

namespace bernal {
namespace {

template <class T>
std::optional<T> number_in(const nlohmann::json& report, const char* key) {
  const auto found = report.find(key);
  if (found == report.end() || !found->is_number()) return {};
  return found->get<T>();
}

std::string text_in(const nlohmann::json& report, const char* key) {
  const auto found = report.find(key);
  return found != report.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

std::optional<ReportSummary> summary_of_report(const std::string& report) {
  const nlohmann::json json = nlohmann::json::parse(report, nullptr, false);
  if (!json.is_object() || !json.contains("certificate") || !json.contains("hash")) return {};
  const auto certified = json.find("certified");
  return ReportSummary{
      .program = {text_in(json, "version"), text_in(json, "commit"),
                  number_in<int>(json, "packings_number").value_or(0)},
      .outcome = text_in(json, "outcome"),
      .reason = text_in(json, "reason"),
      .hash = text_in(json, "hash"),
      .cell = text_in(json, "cell"),
      .n = number_in<std::size_t>(json, "n"),
      .rattlers = number_in<std::size_t>(json, "rattlers"),
      .phi = number_in<double>(json, "phi"),
      .coordination = number_in<double>(json, "coordination"),
      .max_overlap = number_in<double>(json, "max_overlap"),
      .min_wall_gap = number_in<double>(json, "min_wall_gap"),
      .seconds = number_in<double>(json, "seconds"),
      .peak_memory_bytes = number_in<double>(json, "peak_memory_bytes"),
      .certified = certified != json.end() && certified->is_boolean() && certified->get<bool>()};
}

}  // namespace bernal
