#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bernal/scene/packing.hpp"

namespace bernal {

/// Spheres that a scene tells from others: those of a zone, of a class of sizes that has a name, or all.
struct SphereClass {
  std::string name, material;  ///< as the columns class and material have them; material may be empty
  std::optional<double> material_density;  ///< in kg/m³
};

/// The classes of a scene, in the order in which `Packing::classes` counts them: its zones, then what lies in
/// none; or its classes of sizes, where they have names; or one, where the scene names a material. Empty
/// where the scene tells no spheres apart. Precondition: the scene is complete.
std::vector<SphereClass> classes_of(const Scene&);

/// What spheres of a class without layers are made of, by name.
inline const std::string& material_of(const SphereClass& of) {
  return of.material.empty() ? of.name : of.material;
}

/// Which class each sphere is of, where its size says that: of a scene without zones; else empty. Equal sizes
/// of two classes are the first one's. Cost: O(N) times the number of classes.
std::vector<std::uint32_t> classes_by_size(const Packing&);

}  // namespace bernal
