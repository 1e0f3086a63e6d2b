#pragma once
#include <optional>
#include <vector>

#include "surfaces/sphere_surfaces.hpp"

namespace bernal {

/// The walls of a domain in single precision, oriented outwards, and the ends of its periods.
///
/// Curved walls are circumscribed, so that the domain lies inside them: the sides of a prism touch the
/// cylinder, the triangles of a geodesic polyhedron touch the sphere or stay outside it.
struct WallSurface {
  /// An end of the period: an outline in a plane normal to an axis, counter-clockwise from outside; the
  /// opposite end has the same corners in reverse order.
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
  /// The same with the ends moved out by exactly a period: walls that are periodic as far as the balls of one
  /// period reach.
  Mesh extended(const Boundary<3>& boundary) const;
};

/// `deflection`: the largest distance of a circumscribed surface from the wall, in the domain's unit.
/// Precondition: three dimensions. Throws Error{bad_argument} if that takes too many triangles.
WallSurface wall_surface(const Domain& domain, double deflection);

/// The part of an end that no sphere covers, as triangles seen from outside. `covered` are triangles of
/// spheres in it; `on_outline` are further points that divide its outline. Absent if the triangles overlap.
std::optional<FloatSurface> end_between(const WallSurface::End& end,
                                        const std::vector<std::array<FloatPoint, 3>>& covered,
                                        const std::vector<FloatPoint>& on_outline);

/// The same surface at the opposite end.
FloatSurface moved_to(const WallSurface::End& opposite, FloatSurface surface);

}  // namespace bernal
