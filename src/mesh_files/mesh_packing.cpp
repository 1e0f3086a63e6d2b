#include "bernal/mesh_files/mesh_packing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/version.hpp"
#include "mesh_files/mesh_file.hpp"
#include "mesh_files/named_walls.hpp"
#include "mesh_files/solids_to_mesh.hpp"
#include "meshes/boundary_layer.hpp"
#include "meshes/conforming_surface.hpp"
#include "meshes/fill_layers.hpp"
#include "meshes/flat_walls.hpp"
#include "meshes/mesh_quality.hpp"
#include "meshes/second_order.hpp"
#include "result/free_places.hpp"
#include "solids/solids.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

const std::vector<MeshWriter>& mesh_writers() {
  static const std::vector<MeshWriter> all = {gmsh_of_mesh(), abaqus_of_mesh(), openfoam_of_mesh(),
                                              snappy_of_mesh(), vtu_of_mesh()};
  return all;
}

/// The circle that a fillet turns about its axis has a radius of w²/(2 (1 - w)) for a waist of w.
constexpr double least_waist_of_fillets = 0.1;

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::bad_argument, why); }

const MeshWriter& mesh_writer_of(const std::string& name) {
  std::vector<std::string_view> names;
  for (const MeshWriter& writer : mesh_writers()) {
    if (writer.format.name == name) return writer;
    names.emplace_back(writer.format.name);
  }
  refuse(fmt::format("unknown format of meshes \"{}\"{}", plain_text(name), remedy(name, names)));
}

void take_surface(const ConformingSurface& surface, BedMeshReport& report) {
  const SurfaceStatement& stated = surface.statement;
  report.necks = surface.necks.size();
  report.triangles = surface.triangles.size();
  report.least_edge = stated.least_edge;
  report.least_triangle_angle = stated.least_angle;
  report.place_of_least_angle = stated.place_of_least_angle;
  report.shrunk_necks = stated.shrunk_necks;
  report.largest_neck_shrink = stated.largest_shrink;
  report.cut_fillets = stated.cut_fillets;
  report.widened_necks = stated.widened_necks;
  report.deepened_caps = stated.deepened_caps;
  report.porosity = stated.fluid_volume / report.domain_volume;
  report.contact_area = stated.contact_area;
  report.wall_deviation += stated.wall_deviation;
}

void take_mesh(const VolumeMesh& mesh, const MeshGroups& groups, BedMeshReport& report) {
  const MeshQuality quality = quality_of(mesh);
  report.tetrahedra = mesh.tetrahedra.size();
  report.nodes = mesh.node_count();
  report.least_sicn = quality.least_sicn;
  report.mean_sicn = quality.mean_sicn;
  report.least_angle = quality.least_angle;
  report.largest_angle = quality.largest_angle;
  report.histogram = quality.histogram;
  for (const MeshQuality::Place& place : quality.worst) report.worst.push_back({place.sicn, place.center});
  if (mesh.is_curved()) report.least_curved_sicn = least_curved_sicn(mesh);
  const std::vector<double> volumes =
      mesh.is_curved() ? curved_volumes_of_regions(mesh) : volumes_of_regions(mesh);
  report.meshed_porosity = volumes.front() / report.domain_volume;
  for (const std::string& name : groups.volumes) report.groups.push_back({.name = name, .stated_volume = 0});
  for (std::size_t r = 0; r < volumes.size(); ++r)
    report.groups[groups.volume_of_region[r]].volume += volumes[r];
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    std::optional<double>& stated = report.groups[groups.volume_of_region[r]].stated_volume;
    if (stated && mesh.regions[r].volume) {
      *stated += *mesh.regions[r].volume;
    } else {
      stated.reset();
    }
  }
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    ++report.groups[groups.volume_of(mesh, t)].tetrahedra;
}

/// What the treatment of contacts made of the spheres.
void take_spheres(const Packing& packing, const Solids& solids, const std::vector<std::uint32_t>& of_packing,
                  BedMeshReport& report) {
  for (std::size_t i = 0; i < solids.spheres.size(); ++i) {
    const double packed = packing.spheres.r[of_packing.empty() ? i : of_packing[i]];
    if (!(solids.spheres.r[i] < packed)) continue;
    ++report.shrunk_spheres;
    report.largest_sphere_shrink = std::max(report.largest_sphere_shrink, 1 - solids.spheres.r[i] / packed);
  }
  if (of_packing.empty())
    report.packed_porosity = 1 - volume_of_balls(packing.spheres) / report.domain_volume;
}

/// Lets patches and regions name spheres by their numbers in the packing.
void name_spheres(ConformingSurface& surface, const std::vector<std::uint32_t>& of_packing) {
  if (of_packing.empty()) return;
  using Kind = SurfacePatch::Kind;
  for (SurfacePatch& patch : surface.patches)
    if (patch.kind == Kind::sphere || patch.kind == Kind::layer || patch.kind == Kind::cut_face)
      patch.index = of_packing[patch.index];
  for (MeshRegion& region : surface.regions)
    if (region.sphere) region.sphere = of_packing[*region.sphere];
}

/// By tetrahedra, and prisms where these are asked for.
VolumeMesh filled_mesh(const ConformingSurface& surface, const Solids& solids, const MeshFileOptions& options,
                       FillReport& filled, const Monitor& monitor, BedMeshReport& report) {
  const TetrahedraOptions tetrahedra{.for_gradients = mesh_writer_of(options.format).for_gradients};
  if (options.prisms == 0) return fill_with_layers(surface, tetrahedra, filled, monitor);
  PrismReport prisms;
  VolumeMesh mesh = fill_with_prisms(
      surface,
      {.layers = options.prisms,
       .height = options.prism_height,
       .growth = options.prism_growth,
       .per_gap = options.gap_edge,
       .sphere_edge = options.sphere_edge,
       .on_flat_walls = !solids.is_cut() && !std::holds_alternative<Cylinder>(solids.domain)},
      tetrahedra, filled, prisms, monitor);
  report.prisms = prisms.prisms;
  report.prism_ends = prisms.ends;
  report.prism_share = prisms.covered;
  report.mean_prism_height = prisms.mean_height;
  report.least_prism_height = prisms.least_height;
  report.least_scaled_jacobian = prisms.least_scaled_jacobian;
  return mesh;
}

/// The triangles of a surface as a mesh without tetrahedra.
VolumeMesh without_filling(ConformingSurface&& surface) {
  return {.vertices = std::move(surface.vertices),
          .tetrahedra = {},
          .region = {},
          .triangles = std::move(surface.triangles),
          .patch = std::move(surface.patch),
          .patches = std::move(surface.patches),
          .regions = std::move(surface.regions),
          .periodic = std::move(surface.periodic)};
}

/// Sizes of triangles: those that another program makes cells from are finer than these, but in narrow gaps
/// no shorter for that.
SurfaceMeshOptions sizes_of(const MeshFileOptions& options, bool is_surface) {
  constexpr double finer = 0.5, any_gap = 100;
  SurfaceMeshOptions sizes{.sphere_edge = options.sphere_edge,
                           .neck_edge = options.neck_edge,
                           .per_gap = options.gap_edge,
                           .solids = options.solids,
                           .hold_volumes = options.hold_volumes,
                           .per_layer = options.layer_edge};
  if (options.prisms > 0) sizes.wall_edge = 0.8 * sizes.sphere_edge;  // columns are as upright as on spheres
  if (!is_surface) return sizes;
  sizes.sphere_edge *= finer;
  sizes.neck_edge *= finer;
  sizes.per_gap = any_gap;
  return sizes;
}

MeshGroups named_groups(const VolumeMesh& mesh, const Solids& solids, const Packing& packing) {
  return groups_of(mesh, solids.domain, classes_of_mesh(packing), solids.part ? &*solids.part : nullptr);
}

/// The mesh, its names, and what it is of.
struct NamedMesh {
  VolumeMesh mesh;
  MeshGroups groups;
  Solids solids;
};
NamedMesh mesh_of(const Packing& packing, const MeshFileOptions& options, const Monitor& monitor,
                  BedMeshReport& report) {
  if (packing.spheres.empty()) refuse("there are no spheres to mesh around");
  report.spheres = packing.spheres.size();
  report.domain_volume = volume_of(packing.domain);
  const Stopwatch watch;
  monitor.report({"surface", -1, "points on spheres, necks and walls"});
  auto [solids, of_packing] = solids_to_mesh(packing, options, monitor, report);
  take_spheres(packing, solids, of_packing, report);
  const MeshWriter& writer = mesh_writer_of(options.format);
  report.is_surface = writer.format.is_surface;
  ConformingSurface surface = conforming_surface(solids, sizes_of(options, report.is_surface), monitor);
  name_spheres(surface, of_packing);
  if (!options.patches.empty()) name_walls(surface, options.patches, packing.scene.unit);
  take_surface(surface, report);
  // The surface states what is between its own walls.
  report.porosity += 1 - volume_of(solids.domain) / report.domain_volume;
  report.parts.push_back({"surface", watch.seconds()});
  if (report.is_surface) {
    report.meshed_porosity = surface.statement.meshed_fluid_volume / report.domain_volume;
    report.groups.push_back({"fluid", surface.statement.meshed_fluid_volume, surface.statement.fluid_volume});
    VolumeMesh mesh = without_filling(std::move(surface));
    MeshGroups groups = named_groups(mesh, solids, packing);
    return {std::move(mesh), std::move(groups), std::move(solids)};
  }
  FillReport filled;
  VolumeMesh mesh = filled_mesh(surface, solids, options, filled, monitor, report);
  const std::string way = filled.sections > 1      ? fmt::format("fill in {} sections", filled.sections)
                          : filled.sections_failed ? "fill as a whole, since a section failed"
                                                   : "fill";
  report.parts.push_back({way, filled.seconds, filled.peak_bytes});
  report.parts.push_back({"improve", filled.seconds_improving});
  if (options.order == 2) {
    const Stopwatch curving;
    const CurvedEdges edges = make_second_order(mesh);
    report.curved_edges = edges.curved;
    report.straight_edges = edges.kept_straight;
    report.parts.push_back({"second order", curving.seconds()});
  }
  MeshGroups groups = named_groups(mesh, solids, packing);
  take_mesh(mesh, groups, report);
  return {std::move(mesh), std::move(groups), std::move(solids)};
}

/// A folder that is named for a case of OpenFOAM stands for the file in it that has its name.
fs::path file_named(const MeshFormat& format, const fs::path& named) {
  for (const MeshFormat& other : mesh_formats())
    if (named.extension() == other.ending && other.ending != format.ending)
      refuse(fmt::format("files of {} end in {}, those of {} in {}", other.name, other.ending, format.name,
                         format.ending));
  if (format.ending != ".foam" && named.extension() != format.ending)
    refuse(fmt::format("files of {} end in {}, unlike {}", format.name, format.ending,
                       plain_text(named.filename().string())));
  if (format.ending != ".foam" || (named.extension() == format.ending && !fs::is_directory(named)))
    return named;
  fs::path folder = fs::absolute(named).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  return named / (folder.filename().string() + format.ending);
}

/// Lengths in another unit.
void scale(VolumeMesh& mesh, double factor) {
  for (auto* points : {&mesh.vertices, &mesh.middles})
    for (Vector<3>& p : *points) p *= factor;
}

std::vector<std::string> names_of_files(const MeshWriter& writer, const fs::path& name) {
  std::vector<std::string> names{name.string()};
  names.insert(names.end(), writer.others.begin(), writer.others.end());
  if (!writer.beside.empty()) names.push_back(name.stem().string() + std::string(writer.beside));
  names.insert(names.end(), writer.outdated.begin(), writer.outdated.end());
  return names;
}

}  // namespace

std::vector<MeshFormat> mesh_formats() {
  std::vector<MeshFormat> all;
  for (const MeshWriter& writer : mesh_writers()) all.push_back(writer.format);
  return all;
}

void require_mesh_format(const MeshFileOptions& options, int dimension) {
  const MeshFormat& format = mesh_writer_of(options.format).format;
  if (dimension != 3) refuse("meshes are made of packings of three dimensions");
  for (const MeshKey& key : mesh_keys()) require_in_range(key, options);
  if (options.order > format.largest_order)
    refuse(fmt::format("the format {} has no elements of second order", format.name));
  if (options.contact == ContactTreatment::fillet && options.bridge_angle == 0 &&
      options.bridge_radius < least_waist_of_fillets)
    refuse(
        fmt::format("‹bridge_radius› of fillets is at least {}: thinner ones need triangles without number",
                    least_waist_of_fillets));
  if (!options.unit.empty()) {
    unit_named(options.unit);
    if (format.is_surface)
      refuse(fmt::format("the format {} has lengths in m; leave out ‹unit›", format.name));
  }
  if (format.is_surface && options.solids)
    refuse(
        fmt::format("the format {} is for a mesh of the fluid alone; leave out ‹regions=all›", format.name));
  if (options.hold_volumes && options.order > 1)
    refuse("‹facets=volume› is for elements of first order: those of second order follow the spheres");
  if (options.prisms == 0) return;
  if (!format.has_prisms) refuse(fmt::format("prisms are not written in the format {}", format.name));
  if (options.solids || options.order > 1)
    refuse("‹prisms› are made where the fluid alone is meshed, by elements of first order");
}

BedMeshReport measure_mesh(const Packing& packing, const MeshFileOptions& options, const Monitor& monitor) {
  require_mesh_format(options, packing.spheres.dimension());
  BedMeshReport report;
  mesh_of(packing, options, monitor, report);
  return report;
}

MeshedPacking mesh_packing(const Packing& packing, const MeshFileOptions& options, const fs::path& named,
                           const Monitor& monitor) {
  require_mesh_format(options, packing.spheres.dimension());
  require_upright(packing.domain, "a mesh");
  require_closed_walls(packing.domain, "a mesh of the voids");
  const MeshWriter& writer = mesh_writer_of(options.format);
  const fs::path file = file_named(writer.format, named), name = file.filename(), folder = folder_of(file);
  const std::vector<std::string> names = names_of_files(writer, name);
  require_free(folder, names);
  MeshedPacking meshed;
  BedMeshReport& report = meshed.report;
  auto [mesh, groups, solids] = mesh_of(packing, options, monitor, report);
  const Unit unit = options.unit.empty() ? packing.scene.unit : unit_named(options.unit);
  if (unit != packing.scene.unit) scale(mesh, conversion_factor(packing.scene.unit, unit));
  const Stopwatch writing;
  monitor.report({"write", -1, options.format});
  StagedFolder staged(folder);
  const std::string title = fmt::format("bernal {}: mesh of {} spheres in a {}", text_of(this_program()),
                                        packing.spheres.size(), name_of(packing.domain));
  meshed.note = writer.write({.mesh = mesh,
                              .groups = groups,
                              .folder = folder,
                              .name = name,
                              .title = title,
                              .unit = name_of(unit),
                              .metres = metres_per(packing.scene.unit),
                              .solids = solids,
                              .options = options},
                             staged);
  std::vector<std::string> replaced = staged.names();
  std::ranges::copy_if(names, std::back_inserter(replaced), [&](const std::string& one) {
    return std::ranges::find(staged.names(), one) == staged.names().end() && stands(folder / one);
  });
  meshed.files = staged.publish(replaced);
  for (fs::path& path : meshed.files) path = path.lexically_normal();
  report.parts.push_back({"write", writing.seconds()});
  return meshed;
}

}  // namespace bernal
