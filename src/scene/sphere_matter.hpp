#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// A ball or a shell of spheres of a class that is of one material: a layer, or the whole of a sphere without
/// layers. Of a layer that other spheres fill, what is around them.
struct SphereMatter {
  std::string name;      ///< of the layer; else of the class, "spheres" where the scene tells none apart
  std::string material;  ///< never empty
  std::optional<double> density = {};  ///< in kg/m³
  bool is_layer = false;
};

/// Of each class, in the order of `classes_of`, from the centre out; of one class where that is empty. No
/// class is without any. All that tells of the layers of classes begins with this. Precondition: the scene is
/// complete.
std::vector<std::vector<SphereMatter>> matter_by_class(const Scene&);

/// Whether spheres have layers, and all that these and spheres without any are of has a density: what spheres
/// weigh then follows from their layers, whatever is said of the whole.
bool layers_have_densities(const Scene&);

}  // namespace bernal
