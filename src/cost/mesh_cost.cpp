#include "bernal/cost/mesh_cost.hpp"

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/run/run.hpp"
#include "cost/cost_folder.hpp"

namespace bernal {
namespace {

std::string csv_of(const MeshCostReport& report) {
  std::string text =
      "sphere_edge,neck_edge,expected_tetrahedra,expected_seconds,expected_memory_bytes,tetrahedra,seconds,"
      "memory_bytes,least_sicn,porosity,meshed_porosity\n";
  for (const MeshCostRow& row : report.rows) {
    text += fmt::format("{},{},{:.0f},{:.3g},{:.0f},", row.sphere_edge, row.neck_edge,
                        row.expected.tetrahedra, row.expected.seconds, row.expected.bytes);
    if (const auto& mesh = row.measured)
      text += fmt::format("{},{:.3f},{:.0f},{},{},{}\n", mesh->tetrahedra, row.seconds(), row.bytes(),
                          mesh->least_sicn, mesh->porosity, mesh->meshed_porosity);
    else
      text += ",,,,,\n";
  }
  return text;
}

}  // namespace

double MeshCostRow::seconds() const {
  double sum = 0;
  for (const BedMeshReport::Part& part : measured->parts) sum += part.seconds;
  return sum;
}

double MeshCostRow::bytes() const {
  double most = 0;
  for (const BedMeshReport::Part& part : measured->parts) most = std::max(most, part.peak_bytes);
  return most;
}

double MeshCostRow::porosity_error() const { return measured->meshed_porosity - measured->porosity; }

MeshCostReport measure_mesh_cost(const Scene& scene, const std::filesystem::path& folder,
                                 const CostOptions& options) {
  const Stopwatch watch;
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(ErrorCode::cannot_write, "cannot be made: " + failed.message(), {folder.string()});
  cost::TrialRecord record(folder / "trials.csv", false);
  MeshCostReport report{.file = folder / "meshes.csv"};
  cost::write_beside(report.file, csv_of(report), record);
  const Packing packing = run(build(scene), {{}, options.threads, options.monitor});
  report.cancelled = packing.outcome == Outcome::cancelled;
  if (report.cancelled) return report;
  report.spheres = packing.spheres.size();
  for (const double edge : {0.6, 0.45, 0.3, 0.2, 0.15}) {
    MeshCostRow& row = report.rows.emplace_back();
    row.sphere_edge = edge;
    row.neck_edge = edge / 2;
    row.expected = price_of_mesh(static_cast<double>(report.spheres), edge);
    const bool has_time = watch.seconds() + row.expected.seconds <= options.seconds;
    try {
      if (has_time && !report.cancelled)
        row.measured = measure_mesh(packing, {.format = "vtu", .sphere_edge = edge, .neck_edge = edge / 2},
                                    options.monitor);
    } catch (const Cancelled&) {
      report.cancelled = true;
    }
    cost::write_beside(report.file, csv_of(report), record);
  }
  return report;
}

}  // namespace bernal
