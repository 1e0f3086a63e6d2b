#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/scene/sphere_layers.hpp"
#include "scene/layers_of_scene.hpp"
#include "scene/output_table.hpp"
#include "scene/sphere_matter.hpp"
#include "scene/toml_text.hpp"

namespace bernal {

static void require_layer(const Output& output, const Scene& scene, const schema::Section& section) {
  if (output.surface != SurfaceChoice::spheres)
    section.fail("layer", "a \"layer\" is of the spheres: say surface = \"spheres\", or leave it out");
  std::vector<std::string> names;
  for (const std::vector<Layer>& of : layers_by_class(scene))
    for (const Layer& layer : of)
      if (std::ranges::find(names, layer.name) == names.end()) names.push_back(layer.name);
  if (names.empty())
    section.fail("layer", "a \"layer\" needs spheres with \"layers\", and this scene names none");
  if (std::ranges::find(names, output.layer) == names.end())
    section.fail("layer", fmt::format("no layer is called {}; there {} \"{}\"", toml_string(output.layer),
                                      names.size() == 1 ? "is" : "are", fmt::join(names, "\", \"")));
}

void require_layers_of_output(const Output& output, const Scene& scene) {
  const schema::Section section = section_of(output);
  const bool counts = output.values == VoxelValues::layers || output.values == VoxelValues::materials;
  if (output.values == VoxelValues::layers && !has_layers(scene))
    section.fail("values", "values = \"layers\" needs spheres with \"layers\", and this scene names none");
  if (!output.material.empty() && output.values != VoxelValues::fraction)
    section.fail("material",
                 "\"material\" is of an image with values = \"fraction\"; leave it out, or say that");
  if (!output.layer.empty()) require_layer(output, scene, section);
  if (!counts && output.material.empty()) return;
  const std::vector<std::string> materials = materials_of(scene);
  if (!output.material.empty() && std::ranges::find(materials, output.material) == materials.end())
    section.fail("material",
                 fmt::format("nothing is made of {}; there {} \"{}\"", toml_string(output.material),
                             materials.size() == 1 ? "is" : "are", fmt::join(materials, "\", \"")));
  constexpr std::size_t most = 254;
  std::size_t count = materials.size();
  if (output.values == VoxelValues::layers) {
    count = 0;
    for (const std::vector<SphereMatter>& of_class : matter_by_class(scene)) count += of_class.size();
  }
  if (counts && count > most)
    section.fail("values", fmt::format("there are {} {}, and a byte tells no more than {} apart", count,
                                       output.values == VoxelValues::layers ? "layers" : "materials", most));
}

}  // namespace bernal
