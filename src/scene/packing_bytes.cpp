#include "bernal/scene/packing_bytes.hpp"

#include <utility>
#include <variant>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "geometry/archive_surface.hpp"
#include "scene/given_files.hpp"
#include "scene/run_archive.hpp"

namespace bernal {

static void archive(Archive& a, Box& box) { a(box.corner, box.size, box.periodic, box.tilt); }
static void archive(Archive& a, Cylinder& c) { a(c.base, c.axis, c.radius, c.height, c.periodic); }
static void archive(Archive& a, Sphere& sphere) { a(sphere.center, sphere.radius); }
static void archive(Archive& a, ExactCorners& exact) { a(exact.scale, exact.high, exact.low); }
static void archive(Archive& a, Polygon& polygon) { a(polygon.loops, polygon.inset); }
static void archive(Archive& a, Revolved& revolved) {
  a(revolved.base, revolved.axis, revolved.profile, revolved.inset);
}
static void archive(Archive& a, PolygonSurface& surface) { a(surface.vertices, surface.faces); }

/// What is shared and does not change, or nothing.
template <class T>
static void archive_shared(Archive& a, std::shared_ptr<const T>& shared) {
  std::optional<T> value;
  if (shared) value = *shared;
  a(value);
  if (a.reads()) shared = value ? std::make_shared<const T>(std::move(*value)) : nullptr;
}

static void archive(Archive& a, Mesh& mesh) {
  a(mesh.vertices, mesh.triangles, mesh.inset);
  archive_shared(a, mesh.exact);
  archive_shared(a, mesh.surface);
}

/// The domain of the kind that is the Kth.
template <std::size_t K = 0>
static void emplace_kind(Domain& domain, std::size_t kind) {
  if (K == kind) domain.emplace<K>();
  if constexpr (K + 1 < std::variant_size_v<Domain>) emplace_kind<K + 1>(domain, kind);
}

static void archive(Archive& a, Domain& domain) {
  std::uint64_t kind = domain.index();
  a(kind);
  if (a.reads()) emplace_kind(domain, kind);
  std::visit([&](auto& of) { a(of); }, domain);
}

static void archive(Archive& a, Packing& packing);

static void archive(Archive& a, PackingsInside& inside) {
  a(inside.of_class, inside.layer, inside.spheres, inside.which, inside.rotations);
  std::uint64_t count = inside.templates.size();
  a(count);
  inside.templates.resize(count);
  for (std::shared_ptr<const Packing>& packing : inside.templates) archive_shared(a, packing);
}

/// As TOML, and what does not stand in that: the names of files as they are, and what a program gave in place
/// of files. The scene of an imported packing has no sizes, no start and no stages; reading TOML needs the
/// first two and completes the last.
static void archive(Archive& a, Scene& scene) {
  std::string toml, file = scene.file.string();
  bool has_sizes = scene.draws() || scene.start.file || !scene.zones.empty();
  if (!a.reads()) {
    Scene said = scene;
    if (!has_sizes) said.sizes = Constant{1};
    toml = scene_as_toml(said);
  }
  std::vector<std::string> names;
  for (const std::filesystem::path* const name : files_named_in(scene)) names.push_back(name->string());
  for (const Inside& inside : scene.inside) names.push_back(inside.scene.string());
  std::map<std::filesystem::path, std::shared_ptr<const PolygonSurface>> surfaces;
  for (const MeshFile* mesh : scene.meshes()) surfaces.insert(mesh->surfaces.begin(), mesh->surfaces.end());
  std::uint64_t count = surfaces.size();
  std::shared_ptr<const Packing> start = scene.start.packing;
  bool are_default = scene.stages_are_default;
  std::uint64_t stages = scene.stages.size();
  std::optional<Draw> draw = scene.draw;
  a(toml, file, has_sizes, names, are_default, stages, draw, count);
  if (a.reads()) {
    scene = parse_scene(toml, "/packing");
    if (!has_sizes) scene.sizes = Constant{0};
    scene.file = file;
    scene.stages_are_default = are_default;
    while (scene.stages.size() > stages) scene.stages.pop_back();
    scene.draw = draw;
    for (std::filesystem::path* const name : files_named_in(scene)) {
      *name = names.front();
      names.erase(names.begin());
    }
    for (std::size_t k = 0; k < scene.inside.size(); ++k) scene.inside[k].scene = names[k];
    for (; count > 0; --count) {
      std::string name;
      std::shared_ptr<const PolygonSurface> surface;
      a(name);
      archive_shared(a, surface);
      for (MeshFile* mesh : scene.meshes())
        for (const std::filesystem::path* part : mesh->files())
          if (*part == name) mesh->surfaces.emplace(name, surface);
    }
  } else {
    for (auto& [path, surface] : surfaces) {
      std::string name = path.string();
      a(name);
      archive_shared(a, surface);
    }
  }
  archive_shared(a, start);
  scene.start.packing = std::move(start);
}

static void archive(Archive& a, Packing& p) {
  a(p.spheres, p.classes, p.inside, p.domain, p.volume, p.expected_packing_fraction, p.caution, p.hints,
    p.expected_of_sizes, p.bulk_density, p.size_scale, p.scene, p.seed, p.threads, p.program, p.outcome,
    p.reason, p.effects, p.history, p.seconds, p.resumed, p.weights, p.cells);
}

/// Which bernal wrote the bytes, and whether this one may read them, stands in front; of those before 0.2 it
/// is the version alone.
std::string bytes_of(const Packing& packing) {
  std::string bytes;
  ArchiveToBytes archive(bytes);
  std::string by = "bernal " + text_of(this_program());
  int packings = packings_number();
  Packing written = packing;
  archive(by, packings, written);
  archive.check_layout();
  return bytes;
}

Packing packing_of_bytes(std::string_view bytes) {
  ArchiveFromBytes archive(bytes);
  std::string by;
  int packings = 0;
  Packing packing;
  try {
    archive(by);
    if (by.starts_with("bernal ")) archive(packings);
    if (packings == packings_number()) {
      archive(packing);
      archive.check_layout();
      return packing;
    }
  } catch (const Error& error) {  // another version of the same packings, which keeps other things
    if (error.code() != ErrorCode::bad_packing) throw;
  }
  throw Error(ErrorCode::bad_packing,
              fmt::format("these bytes are a packing of {}, and this is bernal {}; write it to a folder with "
                          "that one, and read it from there",
                          plain_text(by, 100), text_of(this_program())));
}

}  // namespace bernal
