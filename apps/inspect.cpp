#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/measure/chambers.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"

using namespace bernal;

namespace {

struct InspectCall {
  std::filesystem::path mesh;
  std::string unit;
  std::optional<double> radius;
  bool json = false;
};

using Row = std::pair<std::string, std::string>;

std::string text_of(const Vector<3>& v) { return fmt::format("{:g}, {:g}, {:g}", v[0], v[1], v[2]); }

/// The counts that are zero in a sound mesh: told only where they are not.
std::vector<Row> defects(const MeshReport& report) {
  const std::pair<const char*, std::uint64_t> all[] = {
      {"open edges", report.open_edges},
      {"edges with more than two faces", report.non_manifold_edges},
      {"vertices where walls only touch", report.non_manifold_vertices},
      {"edges with faces turned against each other", report.misoriented_edges},
      {"degenerate faces", report.degenerate_faces},
      {"repeated faces", report.duplicate_faces},
      {"self-intersecting face pairs", report.self_intersections},
  };
  std::vector<Row> rows;
  for (const auto& [name, count] : all)
    if (count > 0) rows.emplace_back(name, fmt::format("{}", count));
  return rows;
}

/// What spheres of the radius find there.
std::vector<Row> rows_of(const Chambers& found, const std::string& unit) {
  std::vector<Row> rows = {
      {"chambers",
       fmt::format("{} for spheres of radius {:g} {}", found.chambers.size(), found.radius, unit)},
      {"cannot be covered", fmt::format("{:.2f} ± {:.2f} % of the volume", 100 * found.by_smallest.share,
                                        100 * found.by_smallest.error)}};
  if (found.chambers.size() < 2) return rows;
  for (std::size_t k = 0; k < found.chambers.size(); ++k)
    rows.emplace_back(fmt::format("chamber {}", k + 1),
                      fmt::format("{:.2f} % of the volume, at {}", 100 * found.chambers[k].share,
                                  text_of(found.chambers[k].position)));
  return rows;
}

void print(const InspectCall& call, const MeshReport& report, const std::optional<Chambers>& chambers) {
  const std::string unit = call.unit.empty() ? "file units" : call.unit;
  const auto power = [&](const char* sign) { return call.unit.empty() ? unit + sign : call.unit + sign; };
  std::vector<Row> rows = {
      {"file", call.mesh.string()},
      {"coordinates from", report.reader},
      {"faces", fmt::format("{}", report.faces)},
      {"vertices", fmt::format("{}", report.vertices)},
      {"components", fmt::format("{}", report.components)},
      {"closed", report.closed ? "yes" : "no"},
      {"orientation", report.orientation},
      {"lower corner", fmt::format("{} {}", text_of(report.bounds.lower), unit)},
      {"upper corner", fmt::format("{} {}", text_of(report.bounds.upper), unit)},
      {"size", fmt::format("{} {}", text_of(report.bounds.size()), unit)},
      {"area", fmt::format("{:.6g} {}", report.area, power("²"))},
  };
  if (!call.unit.empty() && call.unit != "m")
    rows.insert(rows.end() - 1,
                {"", text_of(metres_per(unit_named(call.unit)) * report.bounds.size()) + " m"});
  if (report.usable()) {
    rows.emplace_back("volume", fmt::format("{:.6g} {}", report.volume, power("³")));
    rows.emplace_back("genus", fmt::format("{}", report.genus));
  }
  if (chambers) {
    const std::vector<Row> found = rows_of(*chambers, unit);
    rows.insert(rows.end(), found.begin(), found.end());
  }
  const std::vector<Row> found = defects(report);
  rows.insert(rows.end(), found.begin(), found.end());
  for (const std::string& repair : report.repairs) rows.emplace_back("repair", repair);
  for (const std::string& problem : report.problems) rows.emplace_back("problem", problem);
  rows.emplace_back("verdict", report.usable() ? "can be a container" : "cannot be a container");

  std::size_t width = 0;
  for (const Row& row : rows) width = std::max(width, row.first.size());
  for (const auto& [name, value] : rows) fmt::print("{:<{}}  {}\n", name, width, value);
}

nlohmann::ordered_json as_json(const std::optional<Chambers>& found) {
  using nlohmann::ordered_json;
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

nlohmann::ordered_json as_json(const InspectCall& call, const MeshReport& report,
                               const std::optional<Chambers>& chambers) {
  using nlohmann::ordered_json;
  return {{"file", call.mesh.string()},
          {"unit", call.unit.empty() ? ordered_json(nullptr) : ordered_json(call.unit)},
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
          {"chambers", as_json(chambers)},
          {"repairs", report.repairs},
          {"problems", report.problems}};
}

int inspect(const InspectCall& call) {
  if (!call.unit.empty()) unit_named(call.unit);  // refuses an unknown one before the file is read
  ProgressBar bar(call.json);
  bar.now("diagnose");
  const ImportedMesh imported = read_mesh(call.mesh);
  const MeshReport& report = imported.report;
  std::optional<Chambers> chambers;
  if (call.radius && report.usable()) chambers = chambers_for(imported.mesh, *call.radius);
  bar.clear();
  if (call.json)
    fmt::print("{}\n", as_json(call, report, chambers).dump(2));
  else
    print(call, report, chambers);
  return report.usable() ? exit_code::done : exit_code::no;
}

}  // namespace

Command inspect_command() {
  const auto call = std::make_shared<InspectCall>();
  return {"inspect",
          "Say what a CAD file is and whether it can be a container",
          {required({"MESH", &call->mesh, "The file: STL, OBJ, OFF, PLY, 3MF, glTF, …"}),
           {"--unit", &call->unit, "Unit of the file's lengths: nm, um, mm, cm, m, in, ft; unknown if absent",
            "UNIT"},
           checked({"--radius", &call->radius,
                    "Count the chambers that spheres of this radius, in the file's lengths, cannot leave",
                    "LENGTH"},
                   [](const std::string& text) {
                     char* end = nullptr;
                     const double radius = std::strtod(text.c_str(), &end);
                     const bool fine = *end == '\0' && radius > 0 && std::isfinite(radius);
                     return fine ? std::string() : text + " is no length above 0";
                   }),
           json_option(call->json)},
          "A container is closed, does not cross itself, and hangs together in more than edges and corners.\n"
          "\nExamples:\n"
          "  bernal inspect part.stl --unit mm                can this CAD file be a container?\n"
          "  bernal inspect part.stl --radius 0.5 --json      and into how many chambers does it fall?\n"
          "Exit codes: 0 usable; 1 not usable; 2 bad input.",
          [call] { return inspect(*call); }};
}
