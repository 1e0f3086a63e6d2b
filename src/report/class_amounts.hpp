#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "bernal/scene/packing.hpp"
#include "bernal/scene/sphere_classes.hpp"

namespace bernal {

/// What there is of a class of spheres.
struct ClassAmount {
  SphereClass of;
  std::uint64_t spheres = 0;
  double packing_fraction = 0;      ///< of the whole domain
  std::optional<double> mass = {};  ///< in kg, where the material's density is known
};

/// Of each class that the packing's scene tells apart; none where it tells none. Cost: O(N).
std::vector<ClassAmount> class_amounts(const Packing&);

}  // namespace bernal
