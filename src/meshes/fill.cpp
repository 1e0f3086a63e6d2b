#include "meshes/fill.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "meshes/sections.hpp"
#include "meshes/tetgen.hpp"
#include "meshes/triangle_sides.hpp"

namespace bernal {

void require_filled(const VolumeMesh& mesh, const ConformingSurface& surface, FillReport& report) {
  constexpr double most = 1e-10;
  sides_of_triangles(mesh);  // which throws unless the surface is kept
  const std::vector<double> found = volumes_of_regions(mesh), wanted = volumes_between(surface);
  for (std::size_t r = 0; r < found.size(); ++r) {
    const double off = std::abs(found[r] - wanted[r]) / std::abs(wanted[r]);
    if (!(off <= most && wanted[r] > 0))
      throw Error(ErrorCode::bad_mesh,
                  fmt::format("a region of the mesh has the volume {:.9g}, and between its triangles it is "
                              "{:.9g}: is the surface closed?",
                              found[r], wanted[r]));
    report.volume_error = std::max(report.volume_error, off);
  }
}

VolumeMesh fill(const ConformingSurface& surface, const TetrahedraOptions& options, FillReport& report,
                const Monitor& monitor) {
  const Stopwatch watch;
  VolumeMesh mesh;
  const TetgenOptions tetgen = {.radius_over_edge = options.radius_over_edge,
                                .least_angle = options.least_angle};
  for (const double share : {1.0, 0.8}) {  // what fails in one place may pass where others are cut
    const SectionCuts cuts =
        section_cuts(surface, static_cast<std::size_t>(share * static_cast<double>(options.most_triangles)));
    if (cuts.count() == 1) break;
    try {
      mesh = fill_in_sections(surface, cuts, tetgen, report.peak_bytes, monitor);
      sides_of_triangles(mesh);
      report.sections = cuts.count();
      break;
    } catch (const Error& error) {  // where a section ends its cone may cross walls that are not convex
      if (error.code() != ErrorCode::bad_mesh) throw;
      report.sections_failed = true;
    }
  }
  if (report.sections == 1) {
    mesh = run_tetgen(surface, tetgen, report.peak_bytes, monitor);
    take_regions_of_triangles(mesh);
  }
  report.seconds = watch.seconds();
  const Stopwatch improving;
  report.improvements =
      improve(mesh, {.goal = options.goal, .for_gradients = options.for_gradients}, monitor);
  report.seconds_improving = improving.seconds();
  require_filled(mesh, surface, report);
  return mesh;
}

}  // namespace bernal
