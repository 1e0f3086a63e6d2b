#include "scene/given_files.hpp"

#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/scene/packing.hpp"
#include "files/npy_file.hpp"

namespace bernal {
namespace {

const PolygonSurface* surface_given(const Scene& scene, const std::filesystem::path& name) {
  const auto* mesh = std::get_if<MeshFile>(&scene.container);
  return mesh ? mesh->surface_called(name) : nullptr;
}

const Spheres<dynamic>* spheres_given(const Scene& scene, const std::filesystem::path& name) {
  return scene.start.packing && scene.start.file == name ? &scene.start.packing->spheres : nullptr;
}

std::string as_off(const PolygonSurface& surface) {
  std::string text = fmt::format("OFF\n{} {} 0\n", surface.vertices.size(), surface.faces.size());
  const auto out = std::back_inserter(text);
  for (const Vector<3>& v : surface.vertices) fmt::format_to(out, "{} {} {}\n", v[0], v[1], v[2]);
  for (const auto& face : surface.faces) fmt::format_to(out, "{} {}\n", face.size(), fmt::join(face, " "));
  return text;
}

std::string as_npy(const Spheres<dynamic>& spheres) {
  std::string bytes = npy_header(spheres.size(), spheres.x.size() + 1);
  const auto append = [&](double number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  bytes.reserve(bytes.size() + spheres.size() * (spheres.x.size() + 1) * sizeof(double));
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    for (const auto& column : spheres.x) append(column[i]);
    append(spheres.r[i]);
  }
  return bytes;
}

}  // namespace

bool is_given(const Scene& scene, const std::filesystem::path& name) {
  return surface_given(scene, name) || spheres_given(scene, name);
}

std::optional<std::string> content_given(const Scene& scene, const std::filesystem::path& name) {
  if (const auto* surface = surface_given(scene, name)) return as_off(*surface);
  if (const auto* spheres = spheres_given(scene, name)) return as_npy(*spheres);
  return {};
}

std::vector<std::filesystem::path*> files_named_in(Scene& scene) {
  std::vector<std::filesystem::path*> files;
  if (auto* mesh = std::get_if<MeshFile>(&scene.container)) {
    files.push_back(&mesh->file);
    for (std::filesystem::path& file : mesh->obstacles) files.push_back(&file);
  }
  if (scene.start.file) files.push_back(&*scene.start.file);
  return files;
}

}  // namespace bernal
