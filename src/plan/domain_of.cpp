#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/sizes/size_distribution.hpp"
#include "cad/diagnose/diagnose_mesh.hpp"
#include "cad/read/files_of_part.hpp"
#include "cad/read/known_formats.hpp"
#include "cad/read/triangulate.hpp"
#include "cad/repair/obstacles.hpp"
#include "core/lower_case.hpp"
#include "domain/flattened.hpp"
#include "domain/rounded.hpp"
#include "domain/without_rod.hpp"
#include "files/sha256.hpp"
#include "scene/given_files.hpp"
#include "scene/scene_entries.hpp"

namespace bernal {
namespace {

/// The rarest size that a true surface is tessellated for.
constexpr double rare = 1e-2;

/// What the import found, for people.
std::string in_words(const MeshReport& report, const MeshFile& mesh, Unit unit) {
  std::string of_file(name_of(mesh.unit.value_or(unit)));
  if (!report.unit.empty() && !mesh.ignore_unit_of_file) of_file = report.unit + ", as the file says";
  std::string text = fmt::format("{} faces; {}; coordinates are {}", report.faces, report.reader, of_file);
  if (report.up != 0 && report.up != 'z' && mesh.up == Up::as_in_file)
    text += fmt::format("; the file says that {0} is up, which up = \"{0}\" turns to z", report.up);
  for (const auto* list : {&report.notes, &report.repairs})
    if (!list->empty()) text += fmt::format("; {}", fmt::join(*list, ", "));
  if (report.is_repaired) text += "; the walls are those of the repaired surface, not the file's";
  return text;
}

std::vector<std::filesystem::path> files_of(const MeshFile& mesh) {
  std::vector<std::filesystem::path> files{mesh.file};
  files.insert(files.end(), mesh.obstacles.begin(), mesh.obstacles.end());
  return files;
}

/// What a change of a file changes.
using Stamp = std::pair<std::uintmax_t, std::filesystem::file_time_type>;
std::vector<Stamp> stamps_of(const std::vector<std::filesystem::path>& files) {
  std::vector<Stamp> stamps;
  std::error_code unknown;
  for (const std::filesystem::path& file : files)
    stamps.emplace_back(std::filesystem::file_size(file, unknown),
                        std::filesystem::last_write_time(file, unknown));
  return stamps;
}

/// Those beside the parts included.
std::vector<std::filesystem::path> all_files_of(const MeshFile& mesh) {
  std::vector<std::filesystem::path> all;
  for (const std::filesystem::path& part : files_of(mesh)) {
    if (mesh.surface_called(part)) continue;
    for (std::filesystem::path& file : files_of_part(part)) all.push_back(std::move(file));
  }
  return all;
}

std::string digest_of_part(const Scene& scene, const std::filesystem::path& part) {
  const std::optional<std::string> given = content_given(scene, part);
  return given ? sha256_of_bytes(*given) : sha256_of_part(part);
}

/// Notes the digests, or holds the files to those that stand there.
void pin_files(const Scene& scene, MeshFile& mesh) {
  std::vector<std::string> digests;
  for (const std::filesystem::path& file : files_of(mesh)) {
    const std::string digest = digest_of_part(scene, file);
    const std::size_t k = digests.size();
    if (k < mesh.sha256.size() && in_lower_case(mesh.sha256[k]) != digest)
      throw OptionError("sha256", fmt::format("{} is not the file that is meant: its SHA-256 is {}; leave "
                                              "\"sha256\" out to take it as it is",
                                              file.string(), digest));
    digests.push_back(digest);
  }
  mesh.sha256 = std::move(digests);
}

/// The corners of a prism, each coordinate the sum of two doubles, exactly (Knuth's sum).
struct SummedCorners {
  ExactCorners exact;
  bool all_are_doubles = true;

  void add(const Vector<3>& a, const Vector<3>& b) {
    const Vector<3> high = a + b;
    Vector<3> low;
    for (int k = 0; k < 3; ++k) {
      const double of_b = high[k] - a[k];
      low[k] = (a[k] - (high[k] - of_b)) + (b[k] - of_b);
    }
    all_are_doubles = all_are_doubles && low.isZero(0);
    exact.high.push_back(high);
    exact.low.push_back(low);
  }
};

/// A prism has flat faces, so its triangles are the prism itself; where `base` makes corners that are no
/// doubles they are kept exactly for the certificate.
Mesh prism_of(const Extruded& extruded) {
  require_simple(extruded.polygon);
  Mesh prism;
  SummedCorners corners_of_prism;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& loop : extruded.polygon.loops) {
    std::vector<Vector<2>> corners;
    for (const Vector<2>& p : loop)
      if (corners.empty() || (p != corners.back() && (&p != &loop.back() || p != corners.front())))
        corners.push_back(p);
    const auto first = static_cast<std::uint32_t>(prism.vertices.size());
    const auto n = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t k = 0; k < n; ++k) {
      edges.emplace_back(first + k, first + (k + 1) % n);
      const Vector<3> corner(corners[k][0], corners[k][1], 0);
      prism.vertices.push_back(extruded.base + corner);
      corners_of_prism.add(extruded.base, corner);
    }
  }
  const auto below = static_cast<std::uint32_t>(prism.vertices.size());
  const auto floor = cad::triangulate_regions(prism.vertices, edges, -Vector<3>::UnitZ());
  if (!floor)
    throw Error(ErrorCode::bad_argument,
                "the corners of the polygon are so close that rounding makes its edges cross; move it nearer "
                "to the origin");
  for (std::uint32_t k = 0; k < below; ++k) {
    prism.vertices.push_back(prism.vertices[k] + extruded.height * Vector<3>::UnitZ());
    corners_of_prism.exact.high.push_back(prism.vertices.back());
    corners_of_prism.exact.low.push_back(corners_of_prism.exact.low[k]);
  }
  SummedCorners top;
  top.add(extruded.base, extruded.height * Vector<3>::UnitZ());
  for (std::size_t k = below; k < prism.vertices.size(); ++k)
    corners_of_prism.exact.low[k][2] = top.exact.low.front()[2];
  if (!corners_of_prism.all_are_doubles || !top.all_are_doubles)
    prism.exact = std::make_shared<ExactCorners>(std::move(corners_of_prism.exact));
  prism.triangles = *floor;
  std::set<std::pair<std::uint32_t, std::uint32_t>> of_floor;
  for (const auto& [a, b, c] : *floor) {
    prism.triangles.push_back({below + a, below + c, below + b});
    of_floor.insert({{a, b}, {b, c}, {c, a}});
  }
  for (auto [a, b] : edges) {  // a side runs against the edge of the floor
    if (of_floor.contains({a, b})) std::swap(a, b);
    prism.triangles.push_back({a, b, below + b});
    prism.triangles.push_back({a, below + b, below + a});
  }
  return prism;
}

/// Of a container or an obstacle of the scene.
struct MakeDomain {
  Scene& scene;
  const SceneContainer& container;
  std::string& notes;
  std::string& caution;

  Domain operator()(const Box& box) const {
    if (container.rounding == 0) return box;
    note_rounding(deviation_of_rounded_box);
    return rounded(box, container.rounding);
  }
  Domain operator()(const Cylinder& cylinder) const {
    if (container.rounding == 0) return cylinder;
    note_rounding(deviation_of_rounded_cylinder);
    return rounded(cylinder, container.rounding);
  }
  Domain operator()(const Sphere& sphere) const { return sphere; }
  Domain operator()(const Polygon& polygon) const { return polygon; }
  Domain operator()(const Cone& cone) const { return solid_of(cone); }
  Domain operator()(const Tube& tube) const { return solid_of(tube); }
  Domain operator()(const Lathed& lathed) const { return solid_of(lathed); }
  Domain operator()(const Extruded& extruded) const { return prism_of(extruded); }
  Domain operator()(MeshFile& mesh) const {
    const Unit unit = scene.unit;
    try {
      const double smallest = scene.draws() || scene.start.file ? radii_of(scene)->quantile(rare)
                                                                : 0;  // what is certified is there
      const std::vector<std::filesystem::path> files = all_files_of(mesh);
      const std::vector<Stamp> before = stamps_of(files);
      require_alone(mesh);
      ImportedMesh imported = read_container_mesh(mesh, {unit, smallest});
      if (imported.mesh.surface) require_known_edges(*imported.mesh.surface, smallest);
      pin_files(scene, mesh);
      if (stamps_of(files) != before)
        throw Error(ErrorCode::bad_mesh, "has changed while it was read", {mesh.file.string()});
      notes = in_words(imported.report, mesh, unit);
      caution = fmt::format("{}", fmt::join(imported.report.cautions, "; "));
      if (imported.report.deflection > 0) mesh.deflection = imported.report.deflection;
      if (imported.report.unit.empty() && !mesh.unit) mesh.unit = unit;
      return std::move(imported.mesh);
    } catch (const OptionError& error) {
      const Location at = container.locations.of(error.option);
      throw Error(error.code(), error.what(), at.file.empty() ? Location{mesh.file.string()} : at);
    }
  }
  /// The unit cube where the scene gives no size.
  Domain operator()(const PeriodicBox& box) const {
    Vector<dynamic> edges = Vector<dynamic>::Constant(box.dimension, box.edge.value_or(1.0));
    if (!box.size.empty()) edges = Eigen::Map<const Eigen::VectorXd>(box.size.data(), box.dimension);
    std::vector<bool> walls(static_cast<std::size_t>(box.dimension), false);
    for (const int axis : box.walls) walls.at(static_cast<std::size_t>(axis)) = true;
    Tilt tilt{};
    std::ranges::copy(box.tilt, tilt.begin());
    return periodic_box(edges, walls, tilt);
  }

 private:
  /// What is cut out of a mesh or into parts is triangles.
  void require_alone(const MeshFile& mesh) const {
    if (!mesh.true_surface) return;
    if (&container != &scene.container)
      throw OptionError("true_surface", "is for a container, and obstacles are triangles; take the key out");
    const char* other = !scene.container.obstacles.empty() ? "obstacles"
                        : !scene.zones.empty()             ? "zones"
                                                           : nullptr;
    if (other)
      throw OptionError("true_surface",
                        fmt::format("is for the surface of the file as it stands, and {} make "
                                    "other walls; take one of the two out",
                                    other));
  }

  /// A sphere could slip through a gap that is as wide as itself.
  void require_known_edges(const TrueSurface& surface, double smallest) const {
    for (const TrueSurface::Face& face : surface.faces)
      if (smallest > 0 && face.tolerance >= smallest)
        throw OptionError(
            "true_surface",
            fmt::format("face {} ({}) of {} has an edge or a corner that is known to {:.3g} {} only, no "
                        "less than the smallest sphere's radius; export the part again with a finer "
                        "tolerance, or take the key out",
                        face.number, face.kind, std::get<MeshFile>(container).file.filename().string(),
                        face.tolerance, name_of(scene.unit)));
  }

  void note_rounding(double deviation) const {
    notes = fmt::format("rounded edges are straight pieces on their inner side, off by {:.2g} {} at most",
                        deviation * container.rounding, name_of(scene.unit));
  }
};

/// What a cylinder about the same axis, to rounding, leaves of a solid of revolution, from end to end or
/// ending within: another one. Nothing where it is otherwise, or what is left has several pieces.
std::optional<Domain> without_core(const Domain& whole, const SceneContainer& obstacle) {
  constexpr double rounding = 1e-12;
  const auto* core = std::get_if<Cylinder>(&obstacle);
  if (!core || core->periodic || obstacle.rounding > 0) return {};
  Revolved solid;
  if (const auto* cylinder = std::get_if<Cylinder>(&whole); cylinder && !cylinder->periodic)
    solid = {cylinder->base,
             cylinder->axis,
             {{0, 0}, {cylinder->radius, 0}, {cylinder->radius, cylinder->height}, {0, cylinder->height}}};
  else if (const auto* revolved = std::get_if<Revolved>(&whole))
    solid = *revolved;
  else
    return {};
  const Vector<3> axis = solid.axis.normalized(), along = core->axis.normalized();
  const Vector<3> base = core->base - solid.base;
  const double from = base.dot(axis), to = from + core->height * along.dot(axis);
  if (axis.cross(along).norm() > rounding || (base - from * axis).norm() > rounding * core->radius) return {};
  solid.profile = without_rod(solid.profile, core->radius, std::min(from, to), std::max(from, to));
  if (solid.profile.size() < 3) return {};
  try {
    require_profile(solid);
  } catch (const Error&) {
    return {};
  }
  return solid;
}

void add_note(std::string& text, const std::string& more) {
  if (!more.empty()) text.append(text.empty() ? "" : "; ").append(more);
}

std::string name_of_solid(const SceneContainer& solid, std::size_t number) {
  const auto* file = std::get_if<MeshFile>(&solid);
  return file ? file->file.filename().string()
              : fmt::format("obstacle {} ({})", number, schema::entry_of(solid).name);
}

/// What remains of the container. Where a note stands, what is done is added to it.
Domain without_obstacles(Domain whole, Scene& scene, std::string& notes, std::string& caution) {
  std::vector<std::pair<SceneContainer*, std::string>> others;
  std::size_t number = 0;
  for (SceneContainer& solid : scene.container.obstacles) {
    const std::string name = name_of_solid(solid, number += !std::holds_alternative<MeshFile>(solid));
    if (std::optional<Domain> rest = without_core(whole, solid)) {
      whole = std::move(*rest);
      add_note(notes, fmt::format("took out {} around the axis", name));
    } else {
      others.emplace_back(&solid, name);
    }
  }
  if (others.empty()) return whole;
  Flattened walls = flattened(whole, RoundAs::within);
  double deviation = walls.deviation;
  for (const auto& [solid, name] : others) {
    std::string notes_of_file, caution_of_file;
    const Flattened obstacle =
        flattened(std::visit(MakeDomain{scene, *solid, notes_of_file, caution_of_file}, *solid),
                  RoundAs::circumscribed);
    try {
      cad::take_out(walls.mesh, obstacle.mesh, name);
    } catch (const OptionError& error) {
      throw Error(error.code(), error.what(), scene.container.locations.of("obstacles"));
    }
    deviation = std::max(deviation, obstacle.deviation);
    add_note(notes, fmt::format("took out {} of {} faces", name, obstacle.mesh.triangles.size()));
    if (!caution_of_file.empty()) add_note(caution, fmt::format("{}: {}", name, caution_of_file));
  }
  cad::Triangles rest{.mesh = std::move(walls.mesh)};
  const MeshReport report = cad::diagnose_mesh(rest);
  if (!report.usable())
    throw Error(ErrorCode::bad_mesh,
                fmt::format("obstacles leave walls that spheres cannot be packed between: {}; move them a "
                            "little",
                            fmt::join(report.problems, ", ")),
                scene.container.locations.of("obstacles"));
  if (deviation > 0)
    add_note(notes, fmt::format("round walls are flat faces on their inner side, off by {:.2g} {} at most",
                                deviation, name_of(scene.unit)));
  return std::move(rest.mesh);
}

}  // namespace

Domain domain_of(Scene& scene, std::string& notes, std::string& caution) {
  SceneContainer& container = scene.container;
  Domain whole = std::visit(MakeDomain{scene, container, notes, caution}, container);
  if (container.obstacles.empty()) return whole;
  return without_obstacles(std::move(whole), scene, notes, caution);
}

Domain domain_of(const Scene& scene) {
  Scene copy = scene;
  std::string notes, caution;
  return domain_of(copy, notes, caution);
}

Domain packed_domain_of(const Scene& scene) {
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (box && box->size.empty() && !box->edge)
    throw Error(
        ErrorCode::bad_scene,
        "does not say how large the periodic box is; give its \"size\", as the scene.toml that bernal "
        "pack writes beside the spheres does",
        scene.container.locations.whole);
  Scene copy = scene;  // the spheres are certified in the walls as they are now
  for (MeshFile* mesh : copy.meshes()) mesh->sha256.clear();
  copy.start = {};  // which may have gone
  return domain_of(copy);
}

std::vector<std::filesystem::path> changed_files(const Scene& scene) {
  std::vector<std::filesystem::path> changed;
  for (const MeshFile* mesh : scene.meshes()) {
    const std::vector<std::filesystem::path> files = files_of(*mesh);
    for (std::size_t k = 0; k < std::min(files.size(), mesh->sha256.size()); ++k)
      if (digest_of_part(scene, files[k]) != in_lower_case(mesh->sha256[k])) changed.push_back(files[k]);
  }
  return changed;
}

}  // namespace bernal
