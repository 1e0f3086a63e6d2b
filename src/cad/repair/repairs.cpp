#include "cad/repair/repairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "cad/diagnose/counted.hpp"
#include "cad/diagnose/mesh_distance.hpp"
#include "cad/diagnose/self_intersections.hpp"
#include "cad/repair/caged_repair.hpp"
#include "cad/repair/repair_crossings.hpp"
#include "cad/repair/repair_holes.hpp"
#include "cad/repair/wrap.hpp"
#include "geometry/measures.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {

/// What a repair is: `name_of(repair)` is its word in a scene.
struct RepairEntry {
  Repair repair;
  bool closes_openings;
  bool (*is_needed)(const Mesh&);
  RepairedMesh (*repaired)(const Mesh&, const MeshFile&, const ImportFor&);
  std::string_view advice;  ///< follows the caution that a part was lost
};

namespace {

const RepairEntry repair_entries[] = {
    {Repair::holes, true, [](const Mesh&) { return true; },
     [](const Mesh& mesh, const MeshFile& options, const ImportFor&) {
       return close_holes(mesh, options.largest_hole.value_or(std::numeric_limits<double>::infinity()));
     },
     ""},
    {Repair::self_intersections, false, [](const Mesh&) { return true; },
     [](const Mesh& mesh, const MeshFile&, const ImportFor&) { return cut_out_crossings(mesh); }, ""},
    {Repair::wrap, true,
     [](const Mesh& mesh) { return !topology_of(mesh).closed() || intersects_itself(mesh); },
     [](const Mesh& mesh, const MeshFile&, const ImportFor& purpose) {
       return wrap_for_spheres(mesh, purpose.smallest_radius);
     },
     "; what is narrower than its alpha is lost, and smaller spheres make that smaller; "
     "\"self-intersections\" before it unites bodies"},
};
static_assert(std::size(repair_entries) == std::size(repair_names));

}  // namespace

void Repairs::before_planes() {
  for (const RepairEntry& entry : repair_entries)
    if (!(has_planes(options_) && entry.closes_openings)) apply(entry);
}

void Repairs::after_planes() {
  for (const RepairEntry& entry : repair_entries)
    if (has_planes(options_) && entry.closes_openings) apply(entry);
}

void Repairs::apply(const RepairEntry& entry) {
  const bool is_asked_for = std::ranges::find(options_.repair, entry.repair) != options_.repair.end();
  if (!is_asked_for || mesh_.triangles.empty() || !entry.is_needed(mesh_)) return;
  RepairedMesh repaired = repair_in_cage(mesh_, purpose_.repair_seconds,
                                         [&] { return entry.repaired(mesh_, options_, purpose_); });
  done_.push_back(repaired.done);
  if (options_.repeats() && repaired.done == no_holes)
    done_.back() += " beside the ends that \"periodic\" means";
  if (repaired.mesh.triangles == mesh_.triangles && repaired.mesh.vertices == mesh_.vertices) return;
  any = true;
  if (repaired.mesh.triangles.empty()) return;
  const Closeness closeness{1e-4 * bounds_of(mesh_).diagonal(), 0.02};
  const double added = farthest(repaired.mesh, mesh_, closeness).at_most;
  const double lost = farthest(mesh_, repaired.mesh, closeness).at_most;
  done_.push_back(
      fmt::format("the repaired surface is at most {:.3g} away from the original, and that at most "
                  "{:.3g} from it",
                  rounded_up(added), rounded_up(lost)));
  if (const std::string left = what_is_left(mesh_, repaired.mesh); !left.empty())
    cautions.push_back(
        fmt::format("repair = [\"{}\"] lost a part: {}{}", name_of(entry.repair), left, entry.advice));
  mesh_ = std::move(repaired.mesh);
}

}  // namespace bernal::cad
