// Scenes, which Python hands over as TOML, and the table of what they may say.
#include <filesystem>
#include <string>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bernal/core/text.hpp"
#include "bernal/report/json.hpp"
#include "bernal/scene/read_scene.hpp"
#include "python/bindings.hpp"

namespace py = pybind11;

namespace bernal::python {
namespace {

/// A scene that stands in no file; relative names are taken from the folder of `name`.
Scene scene_of_text(const std::string& toml, const std::filesystem::path& name) {
  Scene scene = parse_scene(toml, name);
  scene.file.clear();
  return scene;
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
      .def_property_readonly("unit", [](const Scene& scene) { return name_of(scene.unit); })
      .def_property_readonly("dimension", &Scene::dimension);
  module.def("scene", &scene_of_text);
  module.def("read_scene", &read_scene);
  module.def("reference", &scene_reference_as_json);
  module.def("remedy", &remedy_of);
}

}  // namespace bernal::python
