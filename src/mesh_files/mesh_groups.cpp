#include <algorithm>
#include <array>

#include "bernal/scene/sphere_classes.hpp"
#include "mesh_files/mesh_file.hpp"

namespace bernal {
namespace {

std::string name_of_patch(const SurfacePatch& patch, const Domain& domain, const ClassesOfMesh& classes) {
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
    case SurfacePatch::Kind::wall:
      break;
  }
  if (is_faceted(domain)) return "walls";
  return std::holds_alternative<Cylinder>(domain) ? of_cylinder.at(patch.index) : name_of_end(patch.index);
}

std::uint32_t number_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  const auto number = static_cast<std::uint32_t>(found - names.begin());
  if (found == names.end()) names.push_back(name);
  return number;
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
  if (packing.classes.empty()) return made;
  made.of_sphere = packing.classes;
  for (const SphereClass& one : classes_of(packing.scene)) {
    std::string word = one.name;
    for (char& c : word)
      if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '-') c = '_';
    std::string name = word;
    for (int k = 2; std::ranges::find(made.names, name) != made.names.end(); ++k)
      name = word + "_" + std::to_string(k);
    made.names.push_back(name);
  }
  return made;
}

MeshGroups groups_of(const VolumeMesh& mesh, const Domain& domain, const ClassesOfMesh& classes) {
  MeshGroups groups;
  for (const SurfacePatch& patch : mesh.patches)
    groups.surface_of_patch.push_back(number_of(groups.surfaces, name_of_patch(patch, domain, classes)));
  for (const MeshRegion& region : mesh.regions) {
    const bool is_told = region.sphere && !classes.names.empty();
    groups.volume_of_region.push_back(number_of(
        groups.volumes,
        is_told ? region.group + "_" + classes.names[classes.of_sphere[*region.sphere]] : region.group));
  }
  return groups;
}

}  // namespace bernal
