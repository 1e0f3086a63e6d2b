#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "bernal/scene/packing.hpp"

namespace bernal {

/// The layers of the spheres of a packing, from the centre out. Lengths are in the scene's unit.
struct SphereLayers {
  /// Of each class, in the order of `classes_of`, what its layers are; empty of a class without.
  std::vector<std::vector<Layer>> of_class;
  std::vector<std::size_t> first;  ///< one entry a sphere, and one more: where its radii begin in `outer`
  std::vector<double> outer;       ///< where each layer ends: ascending, the last is the sphere's radius

  bool empty() const { return outer.empty(); }
  /// Of one sphere, from the centre out; empty where it has no layers.
  std::span<const double> of(std::size_t sphere) const {
    return {outer.data() + first[sphere], outer.data() + first[sphere + 1]};
  }
};

/// Nothing is made where the scene names no layers. Drawn thicknesses are keyed by the seed and the number of
/// the sphere, so that they are the same whenever they are asked for. Throws Error{bad_packing} for layers
/// that are thicker than a sphere, or end below its surface, and for spheres whose class nobody knows.
/// Cost: O(N).
SphereLayers layers_of(const Packing&);

/// Of each class, in the order of `classes_of`, what its layers are; empty where the scene names none.
/// Precondition: the scene is complete.
std::vector<std::vector<Layer>> layers_by_class(const Scene&);

/// Whether a scene names layers, of whichever spheres.
bool has_layers(const Scene&);

/// What spheres and their layers are made of, each once, class by class and from the centre out; "spheres"
/// where the scene tells no spheres apart.
std::vector<std::string> materials_of(const Scene&);

/// What a layer is made of, by name.
inline const std::string& material_of(const Layer& layer) {
  return layer.material.empty() ? layer.name : layer.material;
}

}  // namespace bernal
