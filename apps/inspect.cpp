#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/measure/chambers.hpp"
#include "bernal/report/json.hpp"
#include "commands.hpp"
#include "measured.hpp"
#include "progress_bar.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct InspectCall {
  std::filesystem::path mesh;
  std::string unit, radius;
  std::filesystem::path places;
  bool json = false;
};

using Row = std::pair<std::string, std::string>;

std::string text_of(const Vector<3>& v) { return fmt::format("{:g}, {:g}, {:g}", v[0], v[1], v[2]); }

/// The counts that are zero in a sound mesh; only those are printed that are not zero.
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

/// The chambers that spheres of the radius cannot leave.
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

/// What the file says of itself.
std::vector<Row> rows_of_file(const InspectCall& call, const MeshReport& report) {
  std::vector<Row> rows = {{"file", plain_text(call.mesh.string())}, {"coordinates from", report.reader}};
  if (!report.unit.empty()) rows.emplace_back("unit", report.unit + ", as the file says");
  if (report.up != 0) rows.emplace_back("up", fmt::format("{}, as the file says", report.up));
  constexpr std::size_t most = 20;
  for (std::size_t i = 0; i < std::min(most, report.solids.size()); ++i)
    rows.emplace_back(fmt::format("solid {}", i + 1), report.solids[i].empty() ? "-" : report.solids[i]);
  if (report.solids.size() > most)
    rows.emplace_back("", fmt::format("and {} more solids", report.solids.size() - most));
  for (const std::string& note : report.notes) rows.emplace_back("note", note);
  return rows;
}

std::vector<Row> rows_of(const MeshReport& report, const std::vector<std::string>& lines,
                         const std::string& unit) {
  std::vector<Row> rows;
  for (const Defect& defect : report.defects)
    rows.emplace_back(defect.what,
                      fmt::format("at {}, {:.3g} {} across", text_of(defect.at), defect.across, unit));
  for (const std::string& repair : report.repairs) rows.emplace_back("repair", repair);
  for (const std::string& caution : report.cautions) rows.emplace_back("caution", caution);
  for (const std::string& problem : report.problems) rows.emplace_back("problem", problem);
  rows.emplace_back("verdict", report.usable() ? "can be a container"
                               : lines.empty() ? "cannot be a container"
                                               : "cannot be a container as it is");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string text = lines[i];
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;) text.replace(at, 1, "  and  ");
    rows.emplace_back(i == 0 ? "in [container]" : "or", text);
  }
  if (!lines.empty() && !report.usable()) {
    rows.emplace_back("", fmt::format("(lengths in {}; those of a scene are in its own unit)", unit));
  }
  return rows;
}

void print(const InspectCall& call, const MeshReport& report, const std::optional<Chambers>& chambers,
           const std::vector<std::string>& lines) {
  std::string known = call.unit.empty() ? report.unit : call.unit;
  if (const auto unit = unit_of_metres(report.metres); unit && call.unit.empty()) known = name_of(*unit);
  const std::string unit = known.empty() ? "file units" : known;
  const auto power = [&](const char* sign) { return unit + sign; };
  std::vector<Row> rows = rows_of_file(call, report);
  const std::vector<Row> measures = {
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
  rows.insert(rows.end(), measures.begin(), measures.end());
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
  const std::vector<Row> verdict = rows_of(report, lines, unit);
  rows.insert(rows.end(), verdict.begin(), verdict.end());

  std::size_t width = 0;
  for (const Row& row : rows) width = std::max(width, row.first.size());
  for (const auto& [name, value] : rows) say(stdout, "{:<{}}  {}\n", name, width, value);
}

/// Of the file's lengths, where it is known.
std::optional<Unit> unit_of(const InspectCall& call, const MeshReport& report) {
  return call.unit.empty() ? unit_of_metres(report.metres) : std::optional(unit_named(call.unit));
}

double radius_of(const InspectCall& call, const MeshReport& report) {
  const double radius = number_of("--radius", call.radius, Quantity::length, unit_of(call, report));
  if (!(radius > 0)) throw Error(ErrorCode::bad_argument, "--radius must be a length above 0");
  return radius;
}

int inspect(const InspectCall& call) {
  if (!call.unit.empty()) unit_named(call.unit);  // refuses an unknown one before the file is read
  ProgressBar bar(call.json);
  bar.now("diagnose");
  MeshFile file{.file = call.mesh};
  file.true_surface = has_true_surface(call.mesh);
  const ImportedMesh imported = read_mesh(file);
  const MeshReport& report = imported.report;
  const std::vector<std::string> lines = lines_that_help(file, {}, imported, Effort::thorough);
  if (!call.places.empty()) write_places(imported, call.places);
  std::optional<Chambers> chambers;
  if (!call.radius.empty()) {
    const double radius = radius_of(call, report);
    if (report.usable()) chambers = chambers_for(imported.mesh, radius);
  }
  bar.clear();
  if (call.json)
    say(stdout, "{}", inspection_as_json(call.mesh, call.unit, report, chambers, lines));
  else
    print(call, report, chambers, lines);
  return report.usable() ? exit_code::done : exit_code::no;
}

}  // namespace

Command inspect_command() {
  const auto call = std::make_shared<InspectCall>();
  return {"inspect",
          "Say what a CAD file is and whether it can be a container",
          {file(required({"MESH", &call->mesh,
                          "The file: STL, OBJ, OFF, PLY, 3MF, AMF, glTF, Collada, FBX, STEP, IGES, BREP"}),
                {mesh_file_endings().begin(), mesh_file_endings().end()}),
           with_units({"--unit", &call->unit,
                       "Unit of the file's lengths: nm, um, mm, cm, m, in, ft; unknown if absent", "UNIT"}),
           measured({"--radius", &call->radius,
                     "Count the chambers that spheres of this radius cannot leave: in the file's lengths, or "
                     "with its own unit, \"2 mm\", where the file or --unit says that of the file",
                     "LENGTH"}),
           {"--places", &call->places,
            "Write the faces at open edges (orange), at branching edges (blue) and of crossings (red), all "
            "others grey, as a PLY file to look at",
            "FILE.ply"},
           json_option(call->json)},
          {.text = "A container is closed, does not cross itself, and hangs together in more than edges and "
                   "corners.",
           .examples = {{"bernal inspect part.stl --unit mm", "can this CAD file be a container?"},
                        {"bernal inspect part.stl --places bad.ply",
                         "where does it fail? to look at in ParaView or MeshLab"},
                        {"bernal inspect part.stl --radius 0.5 --json",
                         "and into how many chambers does it fall?"}},
           .exit_codes = {{"0", "usable"}, {"1", "not usable"}, {"2", "bad input"}}},
          [call] { return inspect(*call); }};
}
