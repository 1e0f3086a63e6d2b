#include "scene/given_files.hpp"

#include <functional>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/scene/packing.hpp"
#include "files/npy_file.hpp"

namespace bernal {
namespace {

const PolygonSurface* surface_given(const Scene& scene, const std::filesystem::path& name) {
  for (const MeshFile* mesh : scene.meshes())
    if (const PolygonSurface* surface = mesh->surface_called(name)) return surface;
  return nullptr;
}

/// Of a container that may be const.
template <class Mesh, class Container>
std::vector<Mesh*> meshes_in(Container& container) {
  std::vector<Mesh*> all;
  if (auto* own = std::get_if<MeshFile>(&container)) all.push_back(own);
  for (auto& obstacle : container.obstacles)
    if (auto* mesh = std::get_if<MeshFile>(&obstacle)) all.push_back(mesh);
  return all;
}

const Spheres<dynamic>* spheres_given(const Scene& scene, const std::filesystem::path& name) {
  return scene.start.packing && scene.start.file == name ? &scene.start.packing->spheres : nullptr;
}

/// Every list of the sizes, in their order.
void for_each_list(SceneSizes& sizes, const std::function<void(ListedSizes&)>& visit) {
  if (auto* list = std::get_if<ListedSizes>(&sizes)) visit(*list);
  if (auto* mixture = std::get_if<Mixture>(&sizes))
    for (SceneSizes& part : mixture->of) for_each_list(part, visit);
}

/// Those of zones after those of the scene.
void for_each_list(Scene& scene, const std::function<void(ListedSizes&)>& visit) {
  for_each_list(scene.sizes, visit);
  for (Zone& zone : scene.zones) for_each_list(zone.spheres.sizes, visit);
}

/// Of a list whose file has not been given its place in a folder.
const ListedSizes* list_given(const SceneSizes& sizes, const std::filesystem::path& name) {
  if (const auto* list = std::get_if<ListedSizes>(&sizes))
    return !name.empty() && !name.has_parent_path() && list->beside == name ? list : nullptr;
  if (const auto* mixture = std::get_if<Mixture>(&sizes))
    for (const SceneSizes& part : mixture->of)
      if (const ListedSizes* list = list_given(part, name)) return list;
  return nullptr;
}

const ListedSizes* list_given(const Scene& scene, const std::filesystem::path& name) {
  const ListedSizes* list = list_given(scene.sizes, name);
  for (auto zone = scene.zones.begin(); !list && zone != scene.zones.end(); ++zone)
    list = list_given(zone->spheres.sizes, name);
  return list;
}

std::string as_off(const PolygonSurface& surface) {
  std::string text = fmt::format("OFF\n{} {} 0\n", surface.vertices.size(), surface.faces.size());
  const auto out = std::back_inserter(text);
  for (const Vector<3>& v : surface.vertices) fmt::format_to(out, "{} {} {}\n", v[0], v[1], v[2]);
  for (const auto& face : surface.faces) fmt::format_to(out, "{} {}\n", face.size(), fmt::join(face, " "));
  return text;
}

void append_double(std::string& bytes, double number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string as_npy(const std::vector<double>& values) {
  std::string bytes = npy_header(values.size(), 0);
  for (const double value : values) append_double(bytes, value);
  return bytes;
}

std::string as_npy(const Spheres<dynamic>& spheres) {
  std::string bytes = npy_header(spheres.size(), spheres.x.size() + 1);
  const auto append = [&](double number) { append_double(bytes, number); };
  bytes.reserve(bytes.size() + spheres.size() * (spheres.x.size() + 1) * sizeof(double));
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    for (const auto& column : spheres.x) append(column[i]);
    append(spheres.r[i]);
  }
  return bytes;
}

}  // namespace

std::vector<MeshFile*> Scene::meshes() {
  std::vector<MeshFile*> all = container.meshes();
  for (Zone& zone : zones)
    if (zone.mesh) all.push_back(&*zone.mesh);
  return all;
}
std::vector<const MeshFile*> Scene::meshes() const {
  std::vector<const MeshFile*> all = container.meshes();
  for (const Zone& zone : zones)
    if (zone.mesh) all.push_back(&*zone.mesh);
  return all;
}
std::vector<MeshFile*> SceneContainer::meshes() { return meshes_in<MeshFile>(*this); }
std::vector<const MeshFile*> SceneContainer::meshes() const { return meshes_in<const MeshFile>(*this); }

bool is_given(const Scene& scene, const std::filesystem::path& name) {
  return surface_given(scene, name) || spheres_given(scene, name) || list_given(scene, name);
}

std::optional<std::string> content_given(const Scene& scene, const std::filesystem::path& name) {
  if (const auto* surface = surface_given(scene, name)) return as_off(*surface);
  if (const auto* spheres = spheres_given(scene, name)) return as_npy(*spheres);
  if (const auto* list = list_given(scene, name)) return as_npy(list->values);
  return {};
}

std::vector<std::filesystem::path*> files_named_in(Scene& scene) {
  std::vector<std::filesystem::path*> files;
  for (MeshFile* mesh : scene.meshes())
    for (std::filesystem::path* file : mesh->files()) files.push_back(file);
  if (scene.start.file) files.push_back(&*scene.start.file);
  for_each_list(scene, [&](ListedSizes& list) {
    if (!list.beside.empty()) files.push_back(&list.beside);
  });
  return files;
}

void put_long_lists_beside(Scene& scene) {
  constexpr std::size_t most_in_scene = 1000;
  int lists = 0;
  for_each_list(scene, [&](ListedSizes& list) {
    if (list.values.size() <= most_in_scene) return;
    list.beside = ++lists == 1 ? "sizes.npy" : fmt::format("sizes-{}.npy", lists);
  });
}

}  // namespace bernal
