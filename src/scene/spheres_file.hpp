#pragma once
#include <string_view>

namespace bernal {

/// The files that hold the spheres of a result, as text and as an array of NumPy's; a result has one of them.
inline constexpr std::string_view spheres_as_text = "spheres.csv", spheres_as_array = "spheres.npy";

/// Beside the latter, the class of each sphere, where the scene tells spheres apart.
inline constexpr std::string_view classes_as_array = "classes.npy";

/// The weight of each cell, where the scene asks for volumes of cells.
inline constexpr std::string_view weights_as_array = "weights.npy";

}  // namespace bernal
