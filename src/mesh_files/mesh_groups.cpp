#include <algorithm>
#include <array>

#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "mesh_files/mesh_file.hpp"

namespace bernal {
namespace {

std::string name_of_layer(const MeshRegion& region, const ClassesOfMesh& classes) {
  const std::uint32_t of_class = classes.of_sphere.empty() ? 0 : classes.of_sphere[*region.sphere];
  return "layer_" + classes.layers[of_class][*region.layer];
}

std::string name_of_face(const ConvexPart& part, std::uint32_t number) {
  const ConvexPart::Face& face = part.faces[number];
  if (face.axis < 0) return "face_" + std::to_string(number + 1);
  return name_of_end(2 * static_cast<std::uint32_t>(face.axis) + (face.keeps.normal[face.axis] > 0 ? 1 : 0));
}

std::string name_of_patch(const SurfacePatch& patch, const VolumeMesh& mesh, const Domain& domain,
                          const ClassesOfMesh& classes, const ConvexPart* part) {
  constexpr std::array<const char*, 3> of_cylinder = {"side", "floor", "lid"};
  switch (patch.kind) {
    case SurfacePatch::Kind::sphere:
      return "surface_of_" +
             (classes.names.empty() ? "spheres" : classes.names[classes.of_sphere[patch.index]]);
    case SurfacePatch::Kind::neck:
      return "necks";
    case SurfacePatch::Kind::cut_face:
      return "caps";
    case SurfacePatch::Kind::period_end:
      return name_of_end(patch.index);
    case SurfacePatch::Kind::layer:
      return "surface_of_" + name_of_layer(mesh.regions[static_cast<std::size_t>(patch.regions[0])], classes);
    case SurfacePatch::Kind::wall:
      break;
  }
  if (!patch.name.empty()) return patch.name;
  if (part != nullptr) return name_of_face(*part, patch.index);
  if (is_faceted(domain) || std::holds_alternative<Sphere>(domain)) return "walls";
  return std::holds_alternative<Cylinder>(domain) ? of_cylinder.at(patch.index) : name_of_end(patch.index);
}

std::uint32_t number_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  const auto number = static_cast<std::uint32_t>(found - names.begin());
  if (found == names.end()) names.push_back(name);
  return number;
}

std::string word_of(std::string name) {
  for (char& c : name)
    if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '-') c = '_';
  return name;
}

/// The name, numbered if others have it.
std::string not_among(const std::vector<std::string>& others, const std::string& word) {
  std::string name = word;
  for (int k = 2; std::ranges::find(others, name) != others.end(); ++k) name = word + "_" + std::to_string(k);
  return name;
}

}  // namespace

std::string name_of_end(std::uint32_t face) {
  std::string name = "x_lower";
  name[0] = static_cast<char>('x' + face / 2);
  return face % 2 == 0 ? name : name.substr(0, 2) + "upper";
}

std::uint32_t MeshGroups::surface_named(std::string_view name) const {
  return static_cast<std::uint32_t>(std::ranges::find(surfaces, name) - surfaces.begin());
}

ClassesOfMesh classes_of_mesh(const Packing& packing) {
  ClassesOfMesh made;
  if (!packing.classes.empty()) {
    made.of_sphere = packing.classes;
    for (const SphereClass& one : classes_of(packing.scene))
      made.names.push_back(not_among(made.names, word_of(one.name)));
  }
  const std::vector<std::vector<Layer>> layers = layers_by_class(packing.scene);
  std::vector<std::string> all;
  for (std::size_t c = 0; c < layers.size(); ++c) {
    auto& names = made.layers.emplace_back();
    for (const Layer& layer : layers[c]) {
      const auto has_it = [&](const std::vector<Layer>& of) {
        return std::ranges::find(of, layer.name, &Layer::name) != of.end();
      };
      std::string name = word_of(layer.name);
      if (std::ranges::count_if(layers, has_it) > 1 && c < made.names.size()) name += "_of_" + made.names[c];
      names.push_back(not_among(all, name));
      all.push_back(names.back());
    }
  }
  return made;
}

MeshGroups groups_of(const VolumeMesh& mesh, const Domain& domain, const ClassesOfMesh& classes,
                     const ConvexPart* part) {
  MeshGroups groups;
  for (const SurfacePatch& patch : mesh.patches) {
    const std::string name = name_of_patch(patch, mesh, domain, classes, part);
    groups.surface_of_patch.push_back(number_of(groups.surfaces, name));
    groups.is_opening.resize(groups.surfaces.size());
    if (!patch.name.empty() || name == "floor" || name == "lid")
      groups.is_opening[groups.surface_of_patch.back()] = true;
  }
  for (const MeshRegion& region : mesh.regions) {
    const bool is_told = region.sphere && !classes.names.empty();
    groups.volume_of_region.push_back(number_of(
        groups.volumes, region.layer ? name_of_layer(region, classes)
                        : is_told    ? region.group + "_" + classes.names[classes.of_sphere[*region.sphere]]
                                     : region.group));
  }
  return groups;
}

}  // namespace bernal
