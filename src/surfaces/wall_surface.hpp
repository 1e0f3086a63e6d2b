#pragma once
#include <optional>
#include <vector>

#include "surfaces/sphere_surfaces.hpp"

namespace bernal {

/// The walls of a domain in single precision, seen from outside, and where periods end.
///
/// Curved walls are circumscribed, so that whatever lies in the domain lies inside them: the sides of a
/// prism touch the cylinder, the triangles of a geodesic polyhedron touch the sphere or stay outside it.
struct WallSurface {
  /// An end of the period: an outline in a plane across an axis, counter-clockwise from outside, and on
  /// the opposite end the same corners in the opposite order.
  struct End {
    int face;  ///< as Cut::face
    std::vector<FloatPoint> outline;
    int axis() const { return face / 2; }
    bool is_upper() const { return face % 2 == 1; }
  };
  FloatSurface walls;
  std::vector<End> ends;

  /// The walls and the whole ends as one closed surface.
  FloatSurface closed() const;
  /// The same with the ends moved out by a period, exactly as floats say: where the walls repeat themselves
  /// so do these for as far as balls of one period reach.
  Mesh extended(const Boundary<3>& boundary) const;
};

/// `deflection`: the largest distance of a circumscribed surface from the wall, in the domain's unit.
/// Precondition: three dimensions. Throws Error{bad_argument} where that takes absurdly many triangles.
WallSurface wall_surface(const Domain& domain, double deflection);

/// The part of an end that no sphere covers: triangles seen from outside. `covered` are triangles of spheres
/// that lie in it; `on_outline` are points that divide its outline as well. Nothing if the triangles
/// overlap.
std::optional<FloatSurface> end_between(const WallSurface::End& end,
                                        const std::vector<std::array<FloatPoint, 3>>& covered,
                                        const std::vector<FloatPoint>& on_outline);

/// The same surface at the opposite end.
FloatSurface moved_to(const WallSurface::End& opposite, FloatSurface surface);

}  // namespace bernal
