// Scenes, which Python passes as TOML and arrays, and the table of keys that they may have.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/text.hpp"
#include "bernal/report/json.hpp"
#include "bernal/scene/read_scene.hpp"
#include "python/bindings.hpp"

namespace py = pybind11;

namespace bernal::python {
namespace {

using Corners = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;
/// Vertices of shape (V, 3), the corners of all faces one after the other, and how many each face has.
using Surface = std::tuple<py::array_t<double, py::array::c_style | py::array::forcecast>, Corners, Corners>;
/// By what the scene's TOML calls them.
using Surfaces = std::map<std::string, Surface>;

std::shared_ptr<const PolygonSurface> surface_of(const Surface& arrays) {
  const auto& [vertices, corners, counts] = arrays;
  auto made = std::make_shared<PolygonSurface>();
  for (py::ssize_t i = 0; i < vertices.shape(0); ++i)
    made->vertices.emplace_back(vertices.at(i, 0), vertices.at(i, 1), vertices.at(i, 2));
  const std::uint32_t* next = corners.data();
  for (py::ssize_t i = 0; i < counts.size(); ++i) {
    made->faces.emplace_back(next, next + counts.at(i));
    next += counts.at(i);
  }
  return made;
}

Surface arrays_of(const PolygonSurface& surface) {
  const auto rows = static_cast<py::ssize_t>(surface.vertices.size());
  py::array_t<double> vertices({rows, py::ssize_t{3}});
  double* x = vertices.mutable_data();
  for (const Vector<3>& v : surface.vertices) x = std::copy(v.begin(), v.end(), x);
  std::vector<std::uint32_t> corners, counts;
  for (const auto& face : surface.faces) {
    corners.insert(corners.end(), face.begin(), face.end());
    counts.push_back(static_cast<std::uint32_t>(face.size()));
  }
  const auto array = [](const std::vector<std::uint32_t>& of) {
    return Corners(static_cast<py::ssize_t>(of.size()), of.data());
  };
  return {vertices, array(corners), array(counts)};
}

Surfaces surfaces_of(const Scene& scene) {
  Surfaces all;
  for (const MeshFile* mesh : scene.meshes())
    for (const auto& [name, surface] : mesh->surfaces) all.emplace(name.string(), arrays_of(*surface));
  return all;
}

/// A scene that stands in no file; relative names are taken from the folder of `name`, unless they are those
/// of surfaces, or of the packing that it starts from.
Scene scene_of_text(const std::string& toml, const std::filesystem::path& name, const Surfaces& surfaces,
                    const PackingPointer& start) {
  Scene scene = parse_scene(toml, name);
  scene.file.clear();
  for (MeshFile* mesh : scene.meshes())
    for (std::filesystem::path* file : mesh->files()) {
      const auto given = surfaces.find(file->filename().string());
      if (given == surfaces.end()) continue;
      *file = given->first;
      mesh->surfaces[*file] = surface_of(given->second);
    }
  if (start) {
    scene.start.file = scene.start.file->filename();
    scene.start.packing = start;
  }
  return scene;
}

/// The packing that it starts from, if that stands in no file.
PackingPointer start_of(const Scene& scene) {
  return std::const_pointer_cast<Packing>(scene.start.packing);  // which Python cannot change
}

std::string remedy_of(const std::string& name, const std::vector<std::string>& candidates) {
  const std::vector<std::string_view> views(candidates.begin(), candidates.end());
  return remedy(name, views);
}

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<Scene>(module, "Scene")
      .def("toml", [](const Scene& scene,
                      const std::filesystem::path& folder) { return scene_as_toml(scene, folder); })
      .def("surfaces", &surfaces_of)
      .def("start", &start_of)
      .def_property_readonly("unit", [](const Scene& scene) { return name_of(scene.unit); })
      .def_property_readonly("dimension", &Scene::dimension);
  module.def("scene", &scene_of_text);
  module.def("read_scene", &read_scene);
  module.def("write_scene", &write_scene);
  module.def("reference", &scene_reference_as_json);
  module.def("remedy", &remedy_of);
  module.def("is_mesh_file", &is_mesh_file_name);
  module.def("unit_of_mesh_file",
             [](const std::filesystem::path& file) { return name_of(unit_of_mesh_file(file)); });
}

}  // namespace bernal::python
