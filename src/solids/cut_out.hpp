#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "solids/solids.hpp"

namespace bernal {

/// A box cut out of a packing: its solids, whose domain is the box, and for each of their spheres, which are
/// spheres of the packing or images of these, the number in the packing.
struct CutOut {
  Solids solids;
  std::vector<std::uint32_t> of_packing;
};

/// Cuts what is within a box out of solids, with images where their domain repeats itself. Spheres and layers
/// that the box nearly touches are made smaller, see `NearFaces`.
///
/// Throws Error{bad_argument} for a box that is empty or not within the container, and for bridges and caps.
/// Precondition: the container is a box, a cylinder, both periodic or not, or a sphere. Cost: O(N).
CutOut cut_out(const Solids&, const Bounds<3>& box, double gap);

/// The part of a ball in a box, cut at its faces; nothing if there is none.
std::optional<Piece> piece_in_box(const Vector<3>& center, double radius, const Bounds<3>& box);

/// The volume of the part of a ball in a box, in closed form. See `BallInCells`.
double volume_in_box(const Vector<3>& center, double radius, const Bounds<3>& box);

}  // namespace bernal
