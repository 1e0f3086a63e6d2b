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
  double volume = 0;
  double packing_fraction = 0;      ///< the share of the whole domain
  std::optional<double> mass = {};  ///< in kg, where the density is known
};

/// What there is of a material, in all layers, and in spheres that have none.
struct MaterialAmount {
  std::string name;
  double volume = 0, packing_fraction = 0;
  std::optional<double> mass = {};  ///< in kg, where all densities are known
};

struct LayerAmounts {
  std::vector<LayerAmount> layers;        ///< class by class, from the centre out
  std::vector<MaterialAmount> materials;  ///< in the order in which the layers name them
};

/// Both empty where the scene names no layers. Throws as `layers_of`. Cost: O(N).
LayerAmounts layer_amounts(const Packing&);

}  // namespace bernal
