#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"

namespace bernal {

struct Plan;

/// What a layer is expected to take up of the spheres of a scene, before any are packed.
struct LayerShare {
  std::string sphere_class;  ///< of the spheres that have it; empty where the scene tells none apart
  std::string name, material;
  double share = 0;  ///< of the volume of all spheres
};

/// The shares of all layers, class by class and from the centre out; of one class of sizes without layers
/// nothing stands here. They are means over the size distribution, each sphere counted by its volume:
///   ∫ v(r, t) dF(r) dG(t) / ∫ (4π/3) r³ dF(r),
/// with the volume v of the layer in a sphere of radius r and with drawn thicknesses t. Volumes of intervals
/// of sizes are exact, also in the tail; within them the mean size stands for all, to 1e-6 of a share.
/// Thicknesses are taken at 4,096 evenly spread points, to 1e-5 of a share. Empty where the scene names no
/// layers.
///
/// Throws Error{bad_scene} for layers that are thicker than the spheres, and where zones have sizes of their
/// own. Precondition: the scene is complete. Cost: up to 0.5 s.
std::vector<LayerShare> layer_shares(const Scene&);

/// The same by material, in the order in which they come first; `name` and `sphere_class` are empty.
std::vector<LayerShare> by_material(const std::vector<LayerShare>&);

/// What the spheres of a plan are expected to weigh, in kg, with what lies inside of them: a layer that is
/// filled by its spheres and by what of its material is left around them. Nothing where a density is not
/// known, where zones have sizes of their own or layers do not fit all sizes, and in other dimensions than
/// three. Cost: that of `layer_shares`, on each level.
std::optional<double> expected_mass(const Plan&);

}  // namespace bernal
