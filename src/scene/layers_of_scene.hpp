#pragma once
#include <span>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// Where the layers of a sphere end, from the centre out; `thickness` has that of each layer that is drawn.
/// Returns what is wrong with them, for people: nothing where they fit. `outer` has as many places as layers.
std::string place_layers(const std::vector<Layer>& layers, double radius, std::span<const double> thickness,
                         std::span<double> outer);

/// Deviations from the mean beyond which no thickness is drawn: where it is cut if nothing else is said.
inline constexpr double deviations_of_thickness = 6;

/// The thickness that is drawn at u in (0, 1): the quantile of the cut normal distribution.
double thickness_at(const Normal& thickness, double u);

/// Throws Error{bad_scene} for layers that the spheres of a scene cannot have: by its dimension, by what else
/// it says, or by the sizes that it gives one by one.
void require_layers(const Scene&);

/// The same where the sizes are drawn: spheres of these radii have to hold the layers that all have, as thick
/// as they may be. Drawn thicknesses end at their `max`, or six standard deviations above the mean.
void require_layers_fit(const Scene&, double smallest, double largest);

/// The same where a stage changes all sizes: the layers of a sphere have to end at its surface all the same.
void require_layers_that_stretch(const Scene&);

/// Throws Error{bad_scene} where an output asks for layers or materials that a scene does not have.
void require_layers_of_output(const Output&, const Scene&);

}  // namespace bernal
