#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/unit.hpp"
#include "commands.hpp"

using namespace bernal;

namespace {

struct InspectCall {
  std::filesystem::path mesh;
  std::string unit;
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

void print(const InspectCall& call, const MeshReport& report) {
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
    rows.insert(rows.end() - 1, {"", text_of(metres_per(call.unit) * report.bounds.size()) + " m"});
  if (report.usable()) {
    rows.emplace_back("volume", fmt::format("{:.6g} {}", report.volume, power("³")));
    rows.emplace_back("genus", fmt::format("{}", report.genus));
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

nlohmann::ordered_json as_json(const InspectCall& call, const MeshReport& report) {
  using nlohmann::ordered_json;
  const auto point = [](const Vector<3>& p) { return ordered_json{p[0], p[1], p[2]}; };
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
          {"bounds", {{"lower", point(report.bounds.lower)}, {"upper", point(report.bounds.upper)}}},
          {"open_edges", report.open_edges},
          {"non_manifold_edges", report.non_manifold_edges},
          {"non_manifold_vertices", report.non_manifold_vertices},
          {"misoriented_edges", report.misoriented_edges},
          {"degenerate_faces", report.degenerate_faces},
          {"duplicate_faces", report.duplicate_faces},
          {"self_intersections", report.self_intersections},
          {"repairs", report.repairs},
          {"problems", report.problems}};
}

int inspect(const InspectCall& call) {
  if (!call.unit.empty()) metres_per(call.unit);  // refuses an unknown one before the file is read
  const MeshReport report = read_mesh(call.mesh).report;
  if (call.json)
    fmt::print("{}\n", as_json(call, report).dump(2));
  else
    print(call, report);
  return report.usable() ? exit_code::done : exit_code::no;
}

}  // namespace

void add_inspect(CLI::App& app, int& status) {
  auto call = std::make_shared<InspectCall>();
  CLI::App* command =
      app.add_subcommand("inspect", "Say what a CAD file is and whether it can be a container");
  command->add_option("MESH", call->mesh, "The file: STL, OBJ, OFF, PLY, 3MF, glTF, …")->required();
  command->add_option("--unit", call->unit, "Unit of the file's lengths: nm, um, mm, cm, m, in, ft");
  command->add_flag("--json", call->json, "One JSON object on standard output");
  command->callback([call, &status] { status = inspect(*call); });
}
