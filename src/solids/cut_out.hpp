#pragma once
#include <cstdint>
#include <vector>

#include "solids/solids.hpp"

namespace bernal {

/// A part cut out of a packing: its solids, whose domain is the part, and for each of their spheres, which
/// are spheres of the packing or images of these, the number in the packing.
struct CutOut {
  Solids solids;
  std::vector<std::uint32_t> of_packing;
};

/// Cuts what is within a part out of solids, with images where their domain repeats itself. Spheres and
/// layers that the part nearly touches are made smaller, see `NearFaces`.
///
/// Throws Error{bad_argument} for a part that is not within the container or lies within one sphere, and for
/// bridges and caps.
/// Precondition: the container is a box, a cylinder, both periodic or not, or a sphere. Cost: O(N) times the
/// faces.
CutOut cut_out(const Solids&, const ConvexPart&, double gap);

/// The volume of what spheres and their images fill of a part, in closed form, without regard to overlaps.
/// Cost: as `cut_out`.
double volume_in(const ConvexPart&, const Spheres<dynamic>&, const Domain&);

}  // namespace bernal
