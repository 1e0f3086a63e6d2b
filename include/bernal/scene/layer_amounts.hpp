#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bernal/scene/packing.hpp"

namespace bernal {

/// What there is of a layer, in the scene's unit.
struct LayerAmount {
  std::string of_class;  ///< the class whose spheres have it
  std::string name, material;
  std::optional<double> material_density = {};  ///< in kg/m³
  std::uint64_t spheres = 0;                    ///< that have it
  double volume = 0;                            ///< of the balls or shells, whatever fills them
  double packing_fraction = 0;                  ///< the share of the whole domain
  /// In kg, where the densities are known: of what fills the layer, spheres of all levels and what is around
  /// them; without such of the layer's own material.
  std::optional<double> mass = {};
};

/// What there is of a material, in all layers and in spheres that have none, of all levels: where spheres
/// fill a layer its own material is around them.
struct MaterialAmount {
  std::string name;
  double volume = 0, packing_fraction = 0;
  std::optional<double> mass = {};  ///< in kg, where all densities are known
};

struct LayerAmounts {
  std::vector<LayerAmount> layers;        ///< class by class, from the centre out
  std::vector<MaterialAmount> materials;  ///< in the order in which the layers name them
};

/// Both empty where the scene names neither layers nor what lies inside of spheres. Throws as `layers_of`.
/// Cost: O(N) of all packings.
LayerAmounts layer_amounts(const Packing&);

/// What the spheres of each class weigh, in the order of `classes_of`, of one class where that is empty: the
/// sum over their layers, or of their own material, and what lies inside of them; in kg, where all of these
/// densities are known. Throws and costs as `layer_amounts`.
std::vector<std::optional<double>> masses_by_class(const Packing&);

}  // namespace bernal
