#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "meshes/neck_shape.hpp"
#include "meshes/surface_draft.hpp"

namespace bernal {

/// What a neck joins, in whatever image; its radius is to be found.
struct NeckBond {
  std::array<std::uint32_t, 2> spheres = {};
  std::optional<std::uint32_t> wall = {};
  std::array<int, 3> step = {};  ///< from the image of the first sphere to that of the second
  Vector<3> axis = Vector<3>::UnitZ();
  NeckEnds ends = {};
  bool is_fillet = false;
  double asked = 0, radius = 0;
  double room = std::numeric_limits<double>::infinity();  ///< for the circle on the wall

  NeckShape shape(double of_radius) const {
    return is_fillet ? fillet_between(ends, of_radius) : cylinder_between(ends, of_radius);
  }
};

/// The contacts of a packing that are to be bridged: between spheres in the order of its bridges, then at
/// walls.
std::vector<NeckBond> neck_bonds_of(const SurfaceDraft&);

}  // namespace bernal
