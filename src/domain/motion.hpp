#pragma once
#include <array>

#include "bernal/domain/facet.hpp"

namespace bernal {

/// A ball of radius r about c that moves by t·direction, 0 <= t <= limit. The direction is taken as it
/// stands: it need not be of unit length.
struct Motion {
  Vector<3> c;
  double r;
  Vector<3> direction;
  double limit;
};

using Corners = std::array<Vector<3>, 3>;

/// A piece of wall of which the free side is convex, with the doubles that it is given by: the axis is taken
/// as it stands, of whatever length.
struct AnalyticWall {
  Facet::Kind kind;  ///< no triangle
  Vector<3> point;   ///< of the plane, of the axis, or the centre
  Vector<3> axis;    ///< of the cylinder; of a plane its normal towards the free side
  double radius;     ///< of a plane: how far behind `point` it stands
};

inline AnalyticWall wall_of(const Facet& f) {
  return {f.kind, f.a, f.b, f.kind == Facet::Kind::plane ? 0 : f.radius};
}

}  // namespace bernal
