#include <nlohmann/json.hpp>

#include "bernal/core/text.hpp"
#include "bernal/report/json.hpp"

namespace bernal {
namespace {

using nlohmann::ordered_json;

ordered_json chambers_json(const std::optional<Chambers>& found) {
  if (!found) return nullptr;
  ordered_json list = ordered_json::array();
  for (const Chambers::Chamber& chamber : found->chambers)
    list.push_back({{"share", chamber.share},
                    {"share_error", chamber.share_error},
                    {"position", chamber.position},
                    {"clearance", chamber.clearance}});
  return {{"radius", found->radius},
          {"resolution", found->resolution},
          {"uncovered", {{"share", found->by_smallest.share}, {"error", found->by_smallest.error}}},
          {"list", list}};
}

}  // namespace

std::string inspection_as_json(const std::filesystem::path& file, std::string_view unit,
                               const MeshReport& report, const std::optional<Chambers>& chambers,
                               const std::vector<std::string>& lines) {
  const auto known = [](std::string_view text) {
    return text.empty() ? ordered_json(nullptr) : ordered_json(text);
  };
  ordered_json defects = ordered_json::array();
  for (const Defect& defect : report.defects)
    defects.push_back({{"what", defect.what}, {"at", defect.at}, {"across", defect.across}});
  const ordered_json json = {
      {"file", plain_text(file.string())},
      {"unit", known(unit)},
      {"unit_of_file", known(report.unit)},
      {"metres_per_unit", report.metres > 0 ? ordered_json(report.metres) : ordered_json(nullptr)},
      {"up_of_file", report.up == 0 ? ordered_json(nullptr) : ordered_json(std::string(1, report.up))},
      {"solids", report.solids},
      {"notes", report.notes},
      {"usable", report.usable()},
      {"reader", report.reader},
      {"faces", report.faces},
      {"vertices", report.vertices},
      {"components", report.components},
      {"closed", report.closed},
      {"genus", report.usable() ? ordered_json(report.genus) : ordered_json(nullptr)},
      {"orientation", report.orientation},
      {"volume", report.usable() ? ordered_json(report.volume) : ordered_json(nullptr)},
      {"area", report.area},
      {"bounds", {{"lower", report.bounds.lower}, {"upper", report.bounds.upper}}},
      {"open_edges", report.open_edges},
      {"non_manifold_edges", report.non_manifold_edges},
      {"non_manifold_vertices", report.non_manifold_vertices},
      {"misoriented_edges", report.misoriented_edges},
      {"degenerate_faces", report.degenerate_faces},
      {"duplicate_faces", report.duplicate_faces},
      {"self_intersections", report.self_intersections},
      {"chambers", chambers_json(chambers)},
      {"hollow_volume",
       report.hollow_volume > 0 ? ordered_json(report.hollow_volume) : ordered_json(nullptr)},
      {"repairs", report.repairs},
      {"cautions", report.cautions},
      {"problems", report.problems},
      {"defects", defects},
      {"container_lines", lines}};
  return json.dump(2) + '\n';
}

}  // namespace bernal
