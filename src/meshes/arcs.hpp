#pragma once
#include <array>
#include <optional>
#include <vector>

#include "meshes/surface_draft.hpp"

namespace bernal {

/// Directions in the plane of a circle.
struct CircleFrame {
  Vector<3> u, v;
};
CircleFrame frame_of(const Circle&);

/// A part of a circle, from angle to angle, with the circles that end it; whole if it ends nowhere.
struct Arc {
  double from, to;
  std::array<std::size_t, 2> ended_by;
};
/// The parts of a circle of a piece outside of its others.
std::vector<Arc> arcs_on(const DraftPiece&, std::size_t circle);

/// The points of an arc of one piece as they are on the arc of another about the same centre that ends at the
/// same faces: angles in the same proportions, without the ends of an arc that has some, and which chain of
/// the other circle they are from. Nothing where there is no such arc.
struct ArcLike {
  std::size_t chain;
  std::vector<double> angles;
};
std::optional<ArcLike> arc_like(const SurfaceDraft&, const DraftPiece&, const Arc&, const DraftPiece& other,
                                std::size_t circle_of_other);

}  // namespace bernal
